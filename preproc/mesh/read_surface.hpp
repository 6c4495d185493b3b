// Reads STL (ASCII, binary, several solids), OBJ, PLY (ASCII, both byte orders, polygons, triangle strips) and OFF.
#pragma once

#include "preproc/mesh/named_sets.hpp"
#include "preproc/mesh/surface_mesh.hpp"

#include <filesystem>
#include <functional>

namespace scan2fea {

// The format is told by the file's content where that is certain (PLY, OFF, binary STL), by its extension otherwise.
// Polygons are triangulated; STL's coincident corners are welded (bit-identical coordinates); vertices that no face
// uses are kept for the repair to count. Coordinates keep the file's full precision.
// Throws InvalidInput naming the file and the line or byte: unreadable, empty, not of a known format, truncated,
// a header that promises more than the file holds, an index out of range, coordinates that are not finite, no faces.
// O(n) for n bytes; memory is bounded by a small multiple of the file's size, whatever its header says.
SurfaceMesh read_surface(const std::filesystem::path& file);

// With the names in it, of faces (ASCII STL: solids; OBJ: groups, objects and materials; PLY: labels), and the unit of
// a comment that `write_surface` wrote.
NamedSurface read_named_surface(const std::filesystem::path& file);

// Some triangles of a file, those after the block before, with vertices among which theirs are.
using TakeBlock = std::function<void(const SurfaceMesh& block)>;

}  // namespace scan2fea
