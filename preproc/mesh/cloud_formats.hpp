// The readers of the formats of point clouds, one source file each. `read_cloud` chooses among them.
// All throw InvalidInput as read_cloud.hpp says, give finite coordinates, and leave it to `read_cloud` to refuse too
// few.
#pragma once

#include "preproc/mesh/input_file.hpp"
#include "preproc/mesh/point_cloud.hpp"

namespace scan2fea {

// Rows of numbers, parted by blanks, tabs, commas or semicolons: x y z, then whatever else. Lines of `#`, `//`, `%` or
// `!` are comments; a first line of words names the columns; a line of one whole number promises so many points, as in
// PTS. Without names, columns are normals where they are of unit length all along; with names nx, ny, nz (normal_x, ...)
// are, and scanner_x, scanner_y, scanner_z (viewpoint_x, vp_x, ...) are the scanner of each point. A comment
// `# scanner x y z` is that of the points that follow. Decimal commas are refused.
PointCloud read_point_rows(const InputFile& file);

// Leica's PTX: scans one after the other, each a grid with the scanner's place and how to turn and move its points.
// 0 0 0 is no return.
PointCloud read_ptx(const InputFile& file);

// PCD 0.7 and before of the Point Cloud Library: ascii, binary and binary_compressed. Points that are not finite are no
// returns. The viewpoint, where it is given, is the scanner.
PointCloud read_pcd(const InputFile& file);

// LAS 1.0 to 1.4 of the ASPRS, point formats 0 to 10. Withheld points and those classed as noise (7, 18) are left out.
// LAZ, which is compressed, is refused.
PointCloud read_las(const InputFile& file);

// The vertices of a PLY with nx, ny, nz; and of an OBJ with `vn`, where there is one for each `v`.
PointCloud read_ply_points(const InputFile& file);
PointCloud read_obj_points(const InputFile& file);

// Whether the content, or else the extension, tells a format that holds points only.
bool is_cloud_format(const InputFile& file);

// What the content alone tells.
bool is_pcd(const InputFile& file);
bool is_las(const InputFile& file);

// A direction of unit length; zero where `v` tells none.
inline Vec3 direction(const Vec3& v) {
  const double length = v.norm();
  return length > 0 && length < 1e300 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

}  // namespace scan2fea
