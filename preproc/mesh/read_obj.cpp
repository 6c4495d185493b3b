#include "preproc/mesh/cloud_formats.hpp"
#include "preproc/mesh/polygon.hpp"
#include "preproc/mesh/surface_formats.hpp"
#include "preproc/mesh/text_scanner.hpp"
#include "preproc/mesh/triangle_rows.hpp"

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

// What the faces from here on are in: groups, the object, the material.
class Names {
 public:
  explicit Names(std::vector<NamedSet>& sets) : sets_(sets) {}

  // Of a line that may name one of them.
  void take(std::string_view keyword, TextScanner& line) {
    if (keyword == "g") take_all(line, groups_);
    if (keyword == "o") take_all(line, object_);
    if (keyword == "usemtl") take_all(line, material_);
  }

  void add(std::size_t first_triangle, std::size_t end) {
    for (const auto* indices : {&groups_, &object_, &material_})
      for (const std::size_t i : *indices)
        for (std::size_t t = first_triangle; t < end; ++t) {
          std::vector<std::uint32_t>& members = sets_[i].members;
          if (members.empty() || members.back() != t) members.push_back(static_cast<std::uint32_t>(t));
        }
  }

 private:
  // "default" is what the format calls no group.
  void take_all(TextScanner& line, std::vector<std::size_t>& indices) {
    indices.clear();
    while (line.skip_blanks())
      if (const std::string_view word = line.word(); word != "default" && word != "off")
        indices.push_back(find_or_add_set(sets_, word));
  }

  std::vector<NamedSet>& sets_;
  std::vector<std::size_t> groups_, object_, material_;
};

void read_faces(TextScanner line, TriangleRows& rows, std::vector<NamedSet>& sets) {
  std::size_t vertices_so_far = 0;
  Names names(sets);
  std::vector<std::uint32_t> corners;
  for (; line.skip_space(); line.skip_line()) {
    const char* start = line.position();
    const std::string_view keyword = line.word();
    if (keyword == "v") ++vertices_so_far;
    names.take(keyword, line);
    if (keyword != "f") continue;
    corners.clear();
    while (line.skip_blanks()) corners.push_back(read_corner(line, vertices_so_far, rows.mesh.vertices.size()));
    if (corners.size() < 3) line.fail(start, "a face has too few corners", std::to_string(corners.size()), "3");
    const std::size_t before = rows.count();
    append_polygon(rows.mesh, corners);
    names.add(before, rows.count());
    rows.end_row();
  }
}

}  // namespace

// Vertices first, then faces: a face may name vertices that stand behind it, and cutting a polygon needs their places.
SurfaceMesh read_obj(const InputFile& file, std::vector<NamedSet>* sets, const TakeBlock& take) {
  TriangleRows rows(take);
  read_vectors(TextScanner(file), "v", rows.mesh.vertices);
  std::vector<NamedSet> named;
  read_faces(TextScanner(file), rows, named);
  std::erase_if(named, [](const NamedSet& set) { return set.members.empty(); });
  if (sets != nullptr) *sets = std::move(named);
  return rows.finish();
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
