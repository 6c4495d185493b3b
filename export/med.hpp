// MED files (.med), of Salome and Code_Aster, by EDF's library: cells TETRA4 or TETRA10 and TRIA3 or TRIA6 on the
// boundary; sets are groups, a family for each combination of them; EALL, SALL and NALL are groups, too. The unit is
// that of the axes. MED numbers the nodes of a tetrahedron the other way round; readers of MED know that.
//
// The library is loaded when it is needed (see med_module.hpp), since it brings MPI with it. It checks little of what
// it reads: files should come from a source that is trusted.
#pragma once

#include "export/mesh_file.hpp"
#include "export/set_names.hpp"

#include <filesystem>

namespace scan2fea {

// Throws IoError; an existing file is then untouched. Coordinates are kept to the bit. O(n).
Notes write_med(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options = {});
Notes write_med(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options = {});

// What write_med calls the sets of a mesh, which have the prefix; notes those that had to be changed.
WrittenNames names_in_med(const TetMesh& mesh, const std::string& prefix, Notes& notes);

// Reads the first mesh of the file. Throws InvalidInput naming the file: unreadable, not MED, no elements, other solids
// than tetrahedra, orders mixed.
MeshFile read_med(const std::filesystem::path& file);

}  // namespace scan2fea
