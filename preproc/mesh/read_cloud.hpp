// Reads point clouds: text (XYZ, TXT, ASC, CSV, PTS, PWN), PTX, PCD, LAS, and the points of PLY, OBJ and OFF.
#pragma once

#include "preproc/mesh/named_sets.hpp"
#include "preproc/mesh/point_cloud.hpp"
#include "preproc/mesh/read_surface.hpp"
#include "preproc/mesh/surface_mesh.hpp"

#include <filesystem>
#include <variant>

namespace scan2fea {

// The points of any file of these formats and of those of read_surface.hpp; faces are passed over. The format is told
// as there. Throws InvalidInput naming the file and the line or byte: unreadable, empty, not of a known format,
// truncated, a count that the file cannot hold, words in place of coordinates, coordinates that are not finite, fewer
// than four points. O(n) for n bytes; memory is bounded by a small multiple of the file's size, whatever it promises.
PointCloud read_cloud(const std::filesystem::path& file);

// A surface where the file has faces, else the cloud of its points.
using Scan = std::variant<SurfaceMesh, PointCloud>;
Scan read_scan(const std::filesystem::path& file);

// The same, with what read_named_surface tells of a surface.
using NamedScan = std::variant<NamedSurface, PointCloud>;
NamedScan read_named_scan(const std::filesystem::path& file);

}  // namespace scan2fea
