// SU2's meshes (.su2): tetrahedra of first order, and markers, by which its configuration names boundaries. Every
// boundary face is in one marker: those in no set are in SALL, those in two are in one that is called A+B. The unit is
// a comment.
#pragma once

#include "export/mesh_file.hpp"

#include <filesystem>

namespace scan2fea {

// Throws IoError; an existing file is then untouched. Coordinates round-trip. Precondition: the mesh is of first order.
Notes write_su2(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options = {});

// Reads a three-dimensional mesh of one zone and its markers. Throws InvalidInput naming file and line: unreadable, of
// other elements than tetrahedra and triangles, truncated, a number that does not parse.
MeshFile read_su2(const std::filesystem::path& file);

}  // namespace scan2fea
