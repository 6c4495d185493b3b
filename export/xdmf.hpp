// XDMF for DOLFINx, with its data as text in it: PART.xdmf holds the grid `Grid` of tetrahedra and PART_facets.xdmf the
// grid `facet_tags` of the boundary's triangles, two files since meshio reads no file of two grids.
//
//   text = XDMFFile.Encoding.ASCII
//   with XDMFFile(MPI.COMM_WORLD, "part.xdmf", "r", encoding=text) as file:
//       mesh = file.read_mesh(name="Grid")
//       cells = file.read_meshtags(mesh, name="Grid")
//   mesh.topology.create_connectivity(2, 3)
//   with XDMFFile(MPI.COMM_WORLD, "part_facets.xdmf", "r", encoding=text) as file:
//       facets = file.read_meshtags(mesh, name="facet_tags")
//
// A tag is a number for each combination of sets, 0 for none; the names are in the field data, as meshio has them, and
// A+B for what is in both. Sets of nodes are attributes `node_set NAME`, fields of the options attributes of their names,
// but those whose numbers stand for names. The unit is an XML comment.
#pragma once

#include "export/mesh_file.hpp"

#include <filesystem>

namespace scan2fea {

// Throws IoError; existing files are then untouched, unless they cannot be renamed. Coordinates round-trip. O(n).
Notes write_xdmf(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options = {});

// Reads such files; of others those with one uniform grid of tetrahedra or triangles and data as text. Throws
// InvalidInput naming the file and the item: unreadable, data elsewhere (HDF5), truncated, orders mixed.
MeshFile read_xdmf(const std::filesystem::path& file);

}  // namespace scan2fea
