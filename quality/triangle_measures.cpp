#include "quality/triangle_measures.hpp"

#include "preproc/mesh/numbers.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace scan2fea {
namespace {

// Partly sorts the values; p rises from call to call, so each continues where the last one stopped.
double percentile(std::vector<double>& values, std::size_t& sorted_up_to, double p) {
  const std::size_t index =
      std::min(values.size() - 1, static_cast<std::size_t>(p * static_cast<double>(values.size())));
  const auto at = [&](std::size_t i) { return values.begin() + static_cast<std::ptrdiff_t>(i); };
  if (index >= sorted_up_to) std::nth_element(at(sorted_up_to), at(index), values.end());
  sorted_up_to = index;
  return values[index];
}

}  // namespace

double edge_ratio(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
  const double shortest = std::min({ab, bc, ca});
  return shortest > 0 ? std::sqrt(std::max({ab, bc, ca}) / shortest) : infinity;
}

double eta(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double doubled_area = (b - a).cross(c - a).norm();
  const double squares = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  // Rounding can push an equilateral triangle below 1, where M ln M would be negative.
  return doubled_area > 0 ? std::max(1.0, squares / (2 * std::numbers::sqrt3 * doubled_area)) : infinity;
}

std::optional<TriangleShape> measure_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  // Side k lies opposite corner k.
  std::array<Vec3, 3> side{c - b, a - c, b - a};
  const double scale =
      std::max({side[0].cwiseAbs().maxCoeff(), side[1].cwiseAbs().maxCoeff(), side[2].cwiseAbs().maxCoeff()});
  if (!(scale > 0)) return std::nullopt;
  for (Vec3& s : side) s /= scale;

  std::array<double, 3> length{side[0].norm(), side[1].norm(), side[2].norm()};
  const auto longest = static_cast<std::size_t>(std::max_element(length.begin(), length.end()) - length.begin());
  // The two shorter sides give the cross product with the smallest rounding error.
  const double twice_area = side[(longest + 1) % 3].cross(side[(longest + 2) % 3]).norm();
  const double shortest = *std::min_element(length.begin(), length.end());
  if (!(shortest > 0) || !(twice_area > 0)) return std::nullopt;

  TriangleShape shape;
  shape.edge_ratio = length[longest] / shortest;
  std::array<double, 3> angle;
  for (std::size_t k = 0; k < 3; ++k)
    angle[k] = degrees * std::atan2(twice_area, -side[(k + 1) % 3].dot(side[(k + 2) % 3]));
  const auto [smallest, largest] = std::minmax_element(angle.begin(), angle.end());
  shape.min_angle_deg = *smallest;
  shape.max_angle_deg = *largest;
  // r = area / semiperimeter, R = product of the sides / (4 area)
  const double perimeter = length[0] + length[1] + length[2];
  shape.radius_ratio = 4 * (twice_area / length[0] / perimeter) * (twice_area / (length[1] * length[2]));
  return shape;
}

double angle_between(const Vec3& u, const Vec3& v) {
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

double angle_deg(const Vec3& apex, const Vec3& a, const Vec3& b) {
  return angle_between(a - apex, b - apex) * 180 / std::numbers::pi;
}

double smallest_angle_deg(const Vec3& a, const Vec3& b, const Vec3& c) {
  return std::min({angle_deg(a, b, c), angle_deg(b, c, a), angle_deg(c, a, b)});
}

double interior_angle(const Vec3& first_normal, const Vec3& second_normal, const Vec3& along) {
  return std::numbers::pi - std::atan2(first_normal.cross(second_normal).dot(along), first_normal.dot(second_normal));
}

TriangleSummary measure_triangles(const SurfaceMesh& mesh) {
  std::vector<std::optional<TriangleShape>> shapes(mesh.triangles.size());
  tbb::parallel_for(std::size_t{0}, shapes.size(), [&](std::size_t i) {
    const Triangle& t = mesh.triangles[i];
    shapes[i] = measure_triangle(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  });

  TriangleSummary summary;
  std::vector<double> edge_ratios;
  edge_ratios.reserve(shapes.size());
  summary.min_angle_deg.min = 180;
  summary.radius_ratio.min = 1;
  for (const auto& shape : shapes) {
    if (!shape) continue;
    edge_ratios.push_back(shape->edge_ratio);
    summary.edge_ratio.mean += shape->edge_ratio;
    summary.edge_ratio.max = std::max(summary.edge_ratio.max, shape->edge_ratio);
    summary.min_angle_deg.mean += shape->min_angle_deg;
    summary.min_angle_deg.min = std::min(summary.min_angle_deg.min, shape->min_angle_deg);
    summary.max_angle_deg = std::max(summary.max_angle_deg, shape->max_angle_deg);
    summary.radius_ratio.mean += shape->radius_ratio;
    summary.radius_ratio.min = std::min(summary.radius_ratio.min, shape->radius_ratio);
  }
  if (edge_ratios.empty()) summary = {};
  summary.measured = edge_ratios.size();
  summary.degenerate = shapes.size() - summary.measured;
  if (edge_ratios.empty()) return summary;

  const auto count = static_cast<double>(summary.measured);
  summary.edge_ratio.mean /= count;
  summary.min_angle_deg.mean /= count;
  summary.radius_ratio.mean /= count;
  std::size_t sorted_up_to = 0;
  summary.edge_ratio.p50 = percentile(edge_ratios, sorted_up_to, 0.50);
  summary.edge_ratio.p95 = percentile(edge_ratios, sorted_up_to, 0.95);
  summary.edge_ratio.p99 = percentile(edge_ratios, sorted_up_to, 0.99);
  return summary;
}

}  // namespace scan2fea
