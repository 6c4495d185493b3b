// I-DEAS universal files (.unv), which Gmsh, Salome, Code_Aster and Elmer read: datasets 164 (units), 2411 (nodes),
// 2412 (elements: 111 and 118 tetrahedra, 91 and 92 triangles) and 2467 (groups of nodes and of elements). Sets of
// faces are groups of triangles, which are written as elements where a set has them.
//
// Dataset 164 says what the unit of length is in metres; readers that know the dataset convert by it.
#pragma once

#include "export/mesh_file.hpp"

#include <filesystem>

namespace scan2fea {

// Throws IoError; an existing file is then untouched. Coordinates round-trip. O(n).
Notes write_unv(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options = {});
Notes write_unv(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options = {});

// Reads nodes (2411, and 781 and 15 of old files), elements (2412, 780) and groups (2467, 2477, 2452, 2435 and 2429 to
// 2432); all other datasets are passed over. Throws InvalidInput naming file and line: unreadable, no elements, solid
// elements of another shape, orders mixed, a number that does not parse.
MeshFile read_unv(const std::filesystem::path& file);

}  // namespace scan2fea
