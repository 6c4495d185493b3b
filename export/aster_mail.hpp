// Code_Aster's own meshes (.mail): COOR_3D, TETRA4 or TETRA10, TRIA3 or TRIA6 for the faces that are in sets, and
// GROUP_MA and GROUP_NO for sets. Nodes are called N1, N2, .., elements M1, M2, .. The unit is a comment.
#pragma once

#include "export/mesh_file.hpp"
#include "export/set_names.hpp"

#include <filesystem>

namespace scan2fea {

// Throws IoError; an existing file is then untouched. Coordinates round-trip. O(n).
Notes write_mail(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options = {});

// What write_mail calls the sets of a mesh, which have the prefix; notes those that had to be changed.
WrittenNames names_in_mail(const TetMesh& mesh, const std::string& prefix, Notes& notes);

// Reads tetrahedra, or else triangles, with their groups, whatever nodes and elements are called. Throws InvalidInput
// naming file and line: unreadable, solid elements of another shape, orders mixed, truncated.
MeshFile read_mail(const std::filesystem::path& file);

}  // namespace scan2fea
