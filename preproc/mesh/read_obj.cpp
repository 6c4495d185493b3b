#include "preproc/mesh/cloud_formats.hpp"
#include "preproc/mesh/polygon.hpp"
#include "preproc/mesh/surface_formats.hpp"
#include "preproc/mesh/text_scanner.hpp"

#include <limits>

namespace scan2fea {
namespace {

// Lines of `keyword`: `v` or `vn`.
void read_vectors(TextScanner line, std::string_view keyword, std::vector<Vec3>& vertices) {
  for (; line.skip_space(); line.skip_line()) {
    const char* start = line.position();
    if (line.word() != keyword) continue;
    if (vertices.size() == std::numeric_limits<std::uint32_t>::max())
      line.fail(start, "too many vertices", {}, std::to_string(vertices.size()));
    vertices.push_back(line.point());  // a weight or a colour may follow
  }
}

// The vertex of a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`, where v counts from 1, or back from the last vertex so far.
std::uint32_t read_corner(TextScanner& line, std::size_t vertices_so_far, std::size_t vertices) {
  const char* start = line.position();
  const std::int64_t index = line.integer('/');
  line.finish_word();
  const auto so_far = static_cast<std::int64_t>(vertices_so_far);
  const auto all = static_cast<std::int64_t>(vertices);
  if (index == 0) line.fail(start, "vertex index out of range", "0", "OBJ counts from 1");
  if (index > all || index < -so_far)
    line.fail(start, "vertex index out of range", std::to_string(index),
              index > 0 ? std::to_string(all) + " vertices" : std::to_string(so_far) + " vertices so far");
  return static_cast<std::uint32_t>(index > 0 ? index - 1 : so_far + index);
}

void read_faces(TextScanner line, SurfaceMesh& mesh) {
  std::size_t vertices_so_far = 0;
  std::vector<std::uint32_t> corners;
  for (; line.skip_space(); line.skip_line()) {
    const char* start = line.position();
    const std::string_view keyword = line.word();
    if (keyword == "v") ++vertices_so_far;
    if (keyword != "f") continue;
    corners.clear();
    while (line.skip_blanks()) corners.push_back(read_corner(line, vertices_so_far, mesh.vertices.size()));
    if (corners.size() < 3) line.fail(start, "a face has too few corners", std::to_string(corners.size()), "3");
    append_polygon(mesh, corners);
  }
}

}  // namespace

// Vertices first, then faces: a face may name vertices that stand behind it, and cutting a polygon needs their places.
SurfaceMesh read_obj(const InputFile& file) {
  SurfaceMesh mesh;
  read_vectors(TextScanner(file), "v", mesh.vertices);
  read_faces(TextScanner(file), mesh);
  return mesh;
}

PointCloud read_obj_points(const InputFile& file) {
  PointCloud cloud;
  read_vectors(TextScanner(file), "v", cloud.points);
  read_vectors(TextScanner(file), "vn", cloud.normals);
  if (cloud.normals.size() != cloud.points.size()) cloud.normals.clear();
  for (Vec3& n : cloud.normals) n = direction(n);
  return cloud;
}

}  // namespace scan2fea
