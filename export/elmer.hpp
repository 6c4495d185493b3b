// Elmer's meshes: a folder of mesh.header, mesh.nodes, mesh.elements, mesh.boundary and mesh.names; the file that is
// named is the first. Bodies are sets of tetrahedra, boundaries sets of faces, each a number that mesh.names has a name
// for: 1 is EALL and SALL, of what is in no set; members of several sets have a number of their own. The unit is a
// comment in mesh.names.
#pragma once

#include "export/mesh_file.hpp"

#include <filesystem>

namespace scan2fea {

// `file` is FOLDER/mesh.header. Throws WrongUsage for another name, IoError; existing files are then untouched, unless
// they cannot be renamed. Coordinates round-trip. O(n).
Notes write_elmer(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options = {});

// Throws InvalidInput naming file and line: unreadable, of other elements than tetrahedra and triangles, truncated.
MeshFile read_elmer(const std::filesystem::path& file);

}  // namespace scan2fea
