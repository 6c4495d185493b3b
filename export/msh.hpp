// Gmsh mesh files (.msh), versions 2.2 and 4.1: written by the Gmsh SDK, read by ourselves, since the SDK runs what a
// file or its neighbours say as a script and does not survive every damaged file.
//
// The volume is the physical group EALL, the boundary triangles (facing outwards) the physical group SALL. MSH has no
// node sets: NALL is every node of the file. A file has no field for a unit or a title either.
//
// The SDK keeps its state in the process. Calls of write_msh exclude one another; a program that uses the SDK itself
// must not call it between its own gmsh::initialize and gmsh::finalize.
#pragma once

#include "preproc/mesh/tet_mesh.hpp"

#include <filesystem>

namespace scan2fea {

enum class MshVersion { v2_2, v4_1 };

struct MshOptions {
  MshVersion version = MshVersion::v4_1;  // Gmsh's own default; older readers (Elmer, Code_Aster, SU2) want 2.2
};

// ASCII, since not every reader takes binary files; Gmsh prints 16 digits, so a coordinate may change in its last bit.
// Node and element numbers are the indices of `mesh` plus one; in elements, triangles come after tetrahedra.
// Precondition: mesh.boundary lists the boundary faces. Throws IoError; an existing file is then untouched.
void write_msh(const TetMesh& mesh, const std::filesystem::path& file, const MshOptions& options = {});

// Reads the tetrahedra of an MSH file of version 2.x or 4.1, ASCII or binary of both byte orders. Elements of lines and
// surfaces, and all sections but nodes and elements, are passed over. The nodes that tetrahedra use are kept, in the
// order of their numbers. Throws InvalidInput naming file and line (byte, if binary): unreadable, not MSH, another
// version, truncated, no tetrahedra, solid elements of another shape, orders mixed, a node missing or defined twice.
TetMesh read_msh(const std::filesystem::path& file);

}  // namespace scan2fea
