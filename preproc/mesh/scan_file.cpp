#include "preproc/mesh/scan_file.hpp"

#include "preproc/mesh/cloud_formats.hpp"
#include "preproc/mesh/file_extension.hpp"
#include "preproc/mesh/surface_formats.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace scan2fea {
namespace {

constexpr std::array<std::string_view, 7> of_rows{".xyz", ".txt", ".asc", ".csv", ".pts", ".pwn", ".xyzn"};

bool is_of_rows(const std::string& extension) {
  return std::ranges::find(of_rows, extension) != of_rows.end();
}

PointCloud read_cloud_format(const InputFile& file) {
  if (is_las(file)) return read_las(file);
  if (is_pcd(file)) return read_pcd(file);
  const std::string extension = extension_of_content(file.path());
  if (extension == ".las" || extension == ".laz") return read_las(file);
  if (extension == ".pcd") return read_pcd(file);
  if (extension == ".ptx") return read_ptx(file);
  return read_point_rows(file);
}

// The points of a file whose faces, if any, are not wanted.
PointCloud points_of(const InputFile& file, SurfaceMesh mesh) {
  if (is_ply(file)) return read_ply_points(file);
  if (!is_off(file) && extension_of_content(file.path()) == ".obj") return read_obj_points(file);
  return {.points = std::move(mesh.vertices), .normals = {}, .scanners = {}};
}

PointCloud checked(const InputFile& file, PointCloud cloud) {
  constexpr std::size_t fewest = 4;  // the corners of the least solid
  if (cloud.points.size() < fewest)
    file.fail("the file holds too few points for a solid",
              std::to_string(cloud.points.size()) +
                  (cloud.left_out > 0 ? " and " + std::to_string(cloud.left_out) + " marked as none" : ""),
              std::to_string(fewest), "a scan of all sides of the part");
  return cloud;
}

}  // namespace

bool is_cloud_format(const InputFile& file) {
  if (is_ply(file) || is_off(file)) return false;
  if (is_las(file) || is_pcd(file)) return true;
  const std::string extension = extension_of_content(file.path());
  return is_of_rows(extension) || extension == ".las" || extension == ".laz" || extension == ".pcd" ||
         extension == ".ptx";
}

bool ScanFile::is_of_points() const {
  return is_cloud_format(file_);
}

PointCloud ScanFile::read_points() const {
  return checked(file_, is_of_points() ? read_cloud_format(file_) : points_of(file_, read_faces_and_vertices(file_)));
}

NamedScan ScanFile::read() const {
  if (is_of_points()) return checked(file_, read_cloud_format(file_));
  NamedSurface surface;
  surface.mesh = read_faces_and_vertices(file_, &surface.face_sets);
  if (!surface.mesh.triangles.empty()) {
    surface.unit = unit_in_head(file_);
    return surface;
  }
  if (surface.mesh.vertices.empty()) file_.fail("the file holds no faces and no points");
  return checked(file_, points_of(file_, std::move(surface.mesh)));
}

NamedSurface ScanFile::read_in_blocks(const TakeBlock& take) const {
  NamedSurface surface;
  read_faces_and_vertices(file_, &surface.face_sets, take);
  surface.unit = unit_in_head(file_);
  return surface;
}

}  // namespace scan2fea
