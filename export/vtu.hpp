// VTK unstructured grids (.vtu, XML), for ParaView and whatever reads through VTK or meshio.
#pragma once

#include "preproc/mesh/tet_mesh.hpp"

#include <filesystem>
#include <string>

namespace scan2fea {

struct VtuOptions {
  std::string unit;        // of length, "mm"; written as an XML comment. Empty: not written.
  std::string provenance;  // where the mesh comes from, one line of text for an XML comment. Empty: not written.
};

// One piece of linear (type 10) or quadratic (type 24) tetrahedra; arrays are appended raw, little-endian, 64-bit, so
// coordinates round-trip exactly and ParaView maps them without parsing. VTK has no sets: all nodes and all elements
// are those of the file, and the boundary is what ParaView's Extract Surface gives.
// Throws IoError; an existing file is then untouched. O(n).
void write_vtu(const TetMesh& mesh, const std::filesystem::path& file, const VtuOptions& options = {});

// Reads the tetrahedra of an uncompressed file of one piece: ascii, binary (base64) or appended (raw or base64) arrays,
// any integer and floating-point type, both byte orders. Cells of lines and surfaces are passed over; nodes that no
// tetrahedron uses are left out. Throws InvalidInput naming the file and the array or cell: unreadable, not VTU,
// compressed, truncated, no tetrahedra, solid cells of another shape, orders mixed, an index out of range.
TetMesh read_vtu(const std::filesystem::path& file);

}  // namespace scan2fea
