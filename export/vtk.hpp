// VTK's formats: unstructured grids (.vtu) and surfaces (.vtp) in XML, and the legacy format (.vtk), which is only
// read.
//
// Sets are arrays: of points `node_set NAME`, of cells `element_set NAME`, 1 for members and 0 for others; sets of
// boundary faces are cell arrays `face_set NAME`, in a volume mesh the sum of 1, 2, 4 and 8 for the faces S1 to S4 of
// the cell (see tetrahedron_faces), so that ParaView's Threshold shows the cells behind the set. The boundary itself is
// what Extract Surface gives. The unit is an XML comment.
#pragma once

#include "export/mesh_file.hpp"

#include <filesystem>

namespace scan2fea {

// One piece of linear (type 10) or quadratic (type 24) tetrahedra, or of triangles; arrays are appended raw,
// little-endian, 64-bit, so coordinates round-trip exactly and ParaView maps them without parsing. Fields of the
// options become arrays of cells and points, the first of each what viewers colour by at first; those whose numbers
// stand for names, of whole numbers. Throws IoError; an existing file is then untouched. O(n).
Notes write_vtu(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options = {});
Notes write_vtu(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options = {});
Notes write_vtp(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options = {});

// Reads the tetrahedra, or else the triangles, of a file of one piece: ascii, binary (base64) or appended (raw or
// base64) arrays, also compressed by zlib or LZ4, any integer and floating-point type, both byte orders. Polygons and
// strips of surfaces are cut into triangles; lines and points are passed over; nodes that no element uses are left out.
// Other arrays than those of sets are named in MeshFile::other_arrays. Throws InvalidInput naming the file and the
// array or cell: unreadable, not of this format, truncated, no elements, solid cells of another shape, orders mixed, an
// index out of range.
MeshFile read_vtk_xml(const std::filesystem::path& file);

// Likewise for the legacy format: POLYDATA and UNSTRUCTURED_GRID, ASCII and binary, versions 2 to 5.1.
MeshFile read_vtk_legacy(const std::filesystem::path& file);

}  // namespace scan2fea
