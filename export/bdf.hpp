// Nastran bulk data (.bdf, .nas): the mesh and its sets, to be included by the deck that holds the analysis or used as
// its bulk data section.
//
//   GRID*          in large fields: sixteen characters hold twelve digits or more
//   CTETRA         of four or ten nodes; CTRIA3 of a surface
//   PSOLID, PSHELL 1 for elements in no set, then one for each combination of sets of elements, all of material 1
//   SET1, SPC1     the same number: the nodes of a set, and these clamped (123), inert unless case control names it;
//                  of NALL and SALL SET1 alone
//   PLOAD4         a pressure of 1 on each face of a set of faces, likewise; its nodes are SET1 and SPC1 of the same
//   number
// Names of sets, and the unit, are comments: "$ SET1 11 is FIXED".
#pragma once

#include "export/mesh_file.hpp"

#include <filesystem>

namespace scan2fea {

// Throws IoError; an existing file is then untouched. O(n).
Notes write_bdf(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options = {});
Notes write_bdf(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options = {});

// Reads GRID, CTETRA, CTRIA3, CTRIA6, CTRIAR, SET1 and PLOAD4 in free, small and large fields; sets of elements are
// those of one property, sets of faces those of one load set of PLOAD4. Names are those of the comments above, and
// otherwise "PROPERTY_2", "SET_11", "LOAD_21". Other cards are passed over. Throws InvalidInput naming file and line:
// unreadable, no elements, solid elements of another shape, orders mixed, a number that does not parse, points in
// another coordinate system than the basic one. INCLUDE is not followed.
MeshFile read_bdf(const std::filesystem::path& file);

}  // namespace scan2fea
