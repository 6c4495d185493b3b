#include "preproc/mesh/coordinate_step.hpp"

#include "preproc/mesh/face_neighbours.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <limits>

namespace scan2fea {
namespace {

// A step of this part of an edge tilts a face by about half a degree.
constexpr double of_edge = 0.01;

bool is_float(double x) {
  return static_cast<double>(static_cast<float>(x)) == x;
}

double float_step(double farthest) {
  const auto at = static_cast<float>(farthest);
  return static_cast<double>(std::nextafter(at, std::numeric_limits<float>::infinity())) - static_cast<double>(at);
}

// Of the shortest text that is read as this number, and no other.
template <class Number>
int significant_digits(Number x) {
  char text[32];
  char* end = std::to_chars(text, text + sizeof text, x, std::chars_format::scientific).ptr;
  char* mantissa_end = std::find(text, end, 'e');
  return static_cast<int>(std::count_if(text, mantissa_end, [](char c) { return c >= '0' && c <= '9'; }));
}

double decimal_step(double farthest, int digits) {
  return std::pow(10, std::floor(std::log10(farthest)) - digits + 1);
}

// Along one axis.
struct AxisStep {
  double length = 0;
  int digits = 0;  // 0: of 32-bit floats
};

// The tenth largest of the distinct magnitudes: fewer values may be meant, as on a box in whole numbers, and the
// largest alone may be in a decade that no other one reaches. 0 where there are fewer.
double tenth_farthest(const std::vector<Vec3>& points, Eigen::Index axis) {
  constexpr std::size_t fewest = 10;
  std::vector<double> values;
  for (const Vec3& p : points) values.push_back(std::abs(p[axis]));
  std::ranges::sort(values, std::greater{});
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values.size() < fewest ? 0 : values[fewest - 1];
}

AxisStep axis_step(const std::vector<Vec3>& points, Eigen::Index axis, bool floats, double least) {
  double farthest = 0;
  for (const Vec3& p : points) farthest = std::max(farthest, std::abs(p[axis]));
  if (farthest == 0) return {};
  AxisStep step{.length = floats ? float_step(farthest) : 0};
  int digits = 0;
  for (const Vec3& p : points) {
    const double x = std::abs(p[axis]);
    if (x == 0) continue;
    digits = std::max(digits, floats ? significant_digits(static_cast<float>(x)) : significant_digits(x));
    if (step.length <= least && decimal_step(farthest, digits) <= least) return {};  // more digits make it finer still
  }
  farthest = tenth_farthest(points, axis);
  if (farthest == 0) return {};
  if (const double length = decimal_step(farthest, digits); length > step.length) step = {length, digits};
  return step;
}

// What is between faces at an edge.
struct Bend {
  double height;  // of the corner of one face above the plane of the other
  double angle_deg;
  Vec3 normal;
  double edge;  // length
};

Bend bend_between(const SurfaceMesh& mesh, const Triangle& t, const Triangle& other, int k) {
  const auto& v = mesh.vertices;
  const Vec3 area = area_vector(mesh, t), other_area = area_vector(mesh, other);
  const std::uint32_t a = t[static_cast<std::size_t>((k + 1) % 3)], b = t[static_cast<std::size_t>((k + 2) % 3)];
  const std::uint32_t far = *std::ranges::find_if(other, [&](std::uint32_t c) { return c != a && c != b; });
  const Vec3 normal = area.normalized();
  return {.height = std::abs(normal.dot(v[far] - v[a])),
          .angle_deg = std::atan2(area.cross(other_area).norm(), area.dot(other_area)) * 180 / std::acos(-1.0),
          .normal = normal,
          .edge = (v[a] - v[b]).norm()};
}

}  // namespace

std::optional<CoordinateStep> coordinate_step(const std::vector<Vec3>& points, double least) {
  const bool floats = std::ranges::all_of(points, [](const Vec3& p) { return std::ranges::all_of(p, is_float); });
  CoordinateStep step;
  double largest = least;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const AxisStep along = axis_step(points, axis, floats, least);
    if (along.length <= least) continue;
    step.length[axis] = along.length;
    if (along.length <= largest) continue;
    largest = along.length;
    step.digits = along.digits > 0 ? std::optional(along.digits) : std::nullopt;
  }
  if (step.length.isZero()) return {};
  return step;
}

std::optional<CoordinateStep> visible_coordinate_step(const SurfaceMesh& scan) {
  constexpr double sharp_deg = 40;  // edges of the part itself, as where creases are found
  constexpr double rounding_of_sums = 1e-6;
  constexpr double shortest_edges = 0.1;  // of the mean; shorter ones are few
  const std::optional<CoordinateStep> step =
      coordinate_step(scan.vertices, of_edge * shortest_edges * mean_edge_length(scan));
  if (!step) return {};
  const std::vector<Triangle> neighbours = face_neighbours(scan, VertexStars(scan));
  std::size_t bends = 0, of_step = 0;
  for (std::size_t f = 0; f < neighbours.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t g = neighbours[f][static_cast<std::size_t>(k)];
      if (g == no_face) continue;
      const Bend bend = bend_between(scan, scan.triangles[f], scan.triangles[g], k);
      const double reach = bend.normal.cwiseProduct(step->length).norm();
      if (bend.angle_deg > sharp_deg || !(bend.height > rounding_of_sums * step->length.maxCoeff())) continue;
      ++bends;
      if (bend.height <= reach && reach > of_edge * bend.edge) ++of_step;
    }
  if (2 * of_step <= bends) return {};
  return step;
}

}  // namespace scan2fea
