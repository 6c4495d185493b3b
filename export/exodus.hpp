// Exodus II (.exo, .e), of Sandia's codes, MOOSE, Cubit, ParaView: netCDF's classic format (netcdf.hpp). Bodies are
// element blocks of TETRA or TETRA10, sets of faces side sets, sets of nodes node sets; sets of elements that overlap
// with blocks, and EALL, are element sets. Of a surface there is one block of TRI3, and sets of faces are element sets.
// The unit is a line of the information records, since Exodus has no field for it. Elements stand in the order of their
// blocks; the element map tells their numbers.
//
// Larry A. Schoof, Victor R. Yarberry, "EXODUS II: A Finite Element Data Model", SAND92-2137; sides of tetrahedra are
// numbered 124, 234, 143, 132.
#pragma once

#include "export/mesh_file.hpp"

#include <filesystem>

namespace scan2fea {

// Throws IoError, also where an array is larger than the 4 GiB of the format; an existing file is then untouched. O(n).
Notes write_exodus(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options = {});
Notes write_exodus(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options = {});

// Reads tetrahedra, or else triangles, with blocks, side sets, node sets and element sets; those without a name are
// called by their number, "side_set_3". Numbers are those of the maps of nodes and elements, by which elements are
// ordered. Throws
// InvalidInput naming the file: unreadable, netCDF-4, no elements, other solids than tetrahedra, orders mixed.
MeshFile read_exodus(const std::filesystem::path& file);

}  // namespace scan2fea
