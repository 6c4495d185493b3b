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

// A .pvtu, of which parallel readers read a piece a process: an index of pieces in files beside it, PART_0.vtu,
// PART_1.vtu and so on, one for each of the options' parts. Pieces are as `write_vtu` writes them, without ghost cells:
// each tetrahedron is in one, nodes between parts are in several, faces of sets in that of their tetrahedron. Arrays
// `GlobalNodeIds` and `GlobalElementIds` are the numbers from 0 on in the whole mesh, `part` that of the piece. Pieces
// of an earlier, larger number of parts stay where they are; the index names its own. O(n log n).
Notes write_pvtu(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options = {});
std::vector<std::filesystem::path> pieces_of_pvtu(const std::filesystem::path& file, std::size_t parts);

// Puts the pieces together by their `GlobalNodeIds`, in the order of the index. Throws InvalidInput as `read_vtk_xml`,
// and where pieces are missing or without these numbers, have ghost cells, or put one node at two places.
MeshFile read_pvtu(const std::filesystem::path& file);

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
