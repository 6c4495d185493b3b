// ANSYS archives (.cdb): NBLOCK, EBLOCK of SOLID285 (four nodes) or SOLID187 (ten), SURF154 for the faces that are in
// sets, and components (CMBLOCK) for sets; a material number for each combination of sets of elements. SURF154 adds no
// stiffness: it takes pressures. The unit is a comment and, where ANSYS has a name for it, its label (/UNITS).
#pragma once

#include "export/mesh_file.hpp"

#include <filesystem>

namespace scan2fea {

// Throws IoError; an existing file is then untouched. Coordinates round-trip. O(n).
Notes write_cdb(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options = {});

// Reads NBLOCK (of fields as its format line says), EBLOCK of solids in ANSYS's long form, and CMBLOCK; elements are
// told by their number of nodes and by repeated ones: degenerate hexahedra that are tetrahedra are read, too. Throws
// InvalidInput naming file and line: unreadable, truncated, solid elements of another shape, orders mixed.
MeshFile read_cdb(const std::filesystem::path& file);

}  // namespace scan2fea
