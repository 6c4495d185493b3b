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
// DOLFINx divides the mesh by itself when several processes read it, also one that is in parts already. In that one the
// cells of a part stand together, and the attribute `part` tells each cell's. This keeps them, for as many processes as
// parts. DOLFINx 0.5 wants each cell on its own process and on those across its faces, whether it keeps ghosts or not;
// of text process 0 has all cells.
//
//   tree = xml.etree.ElementTree.parse("part.xdmf")
//   part = numpy.array(tree.find(".//Attribute[@Name='part']/DataItem").text.split(), dtype=numpy.int32)
//   def keep(comm, parts, dim, graph, ghosts):
//       own = part[: graph.num_nodes]
//       corners = graph.array.reshape(-1, 4)[:, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]].reshape(-1, 3)
//       face = numpy.unique(numpy.sort(corners), axis=0, return_inverse=True)[1]
//       both = numpy.bincount(face, own.repeat(4))[face] - own.repeat(4)  # the part across, where there is one
//       across = numpy.where(numpy.bincount(face)[face] == 2, both, own.repeat(4)).astype(numpy.int32).reshape(-1, 4)
//       rows = [[p, *(set(others) - {p})] for p, others in zip(own, across)]
//       ends = numpy.cumsum([0] + [len(row) for row in rows], dtype=numpy.int32)
//       return adjacencylist(numpy.array([p for row in rows for p in row], dtype=numpy.int32), ends)
//   with XDMFFile(MPI.COMM_WORLD, "part.xdmf", "r", encoding=text) as file:
//       cells, x = file.read_topology_data(name="Grid"), file.read_geometry_data(name="Grid")
//       domain = ufl.Mesh(ufl.VectorElement("Lagrange", ufl.Cell("tetrahedron", 3),
//       file.read_cell_type(name="Grid")[1]))
//   mesh = create_mesh(MPI.COMM_WORLD, cells, x, domain, GhostMode.none, keep)
//
// A tag is a number for each combination of sets, 0 for none; the names are in the field data, as meshio has them, and
// A+B for what is in both. Sets of nodes are attributes `node_set NAME`, fields of the options attributes of their
// names, but those whose numbers stand for names. The unit is an XML comment.
#pragma once

#include "export/mesh_file.hpp"

#include <filesystem>

namespace scan2fea {

// Throws IoError; existing files are then untouched, unless they cannot be renamed. Coordinates round-trip. O(n).
// The facets' file is the one of `facets_of_xdmf`.
Notes write_xdmf(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options = {});

std::filesystem::path facets_of_xdmf(std::filesystem::path file);

// Reads such files; of others those with one uniform grid of tetrahedra or triangles and data as text. Throws
// InvalidInput naming the file and the item: unreadable, data elsewhere (HDF5), truncated, orders mixed.
MeshFile read_xdmf(const std::filesystem::path& file);

}  // namespace scan2fea
