#include "preproc/volume/surface_bound.hpp"

#include "preproc/volume/tet_quality.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <vector>

namespace scan2fea {
namespace {

// A side of a triangle: from `tail` to `head` as the triangle turns.
struct Side {
  std::uint32_t tail, head, apex, triangle;
  auto key() const { return std::tuple(std::min(tail, head), std::max(tail, head), triangle); }
};

std::vector<Side> sides(const SurfaceMesh& surface) {
  std::vector<Side> result;
  result.reserve(surface.triangles.size() * 3);
  for (std::uint32_t i = 0; i < surface.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const Triangle& t = surface.triangles[i];
      result.push_back({t[k], t[(k + 1) % 3], t[(k + 2) % 3], i});
    }
  std::sort(result.begin(), result.end(), [](const Side& a, const Side& b) { return a.key() < b.key(); });
  return result;
}

// Of the edge between two triangles; 180 where it is flat or concave.
double best_angle_deg(const SurfaceMesh& surface, const Side& first, const Side& second) {
  const auto& p = surface.vertices;
  const Vec3 n = area_vector(surface, surface.triangles[first.triangle]);
  const Vec3 m = area_vector(surface, surface.triangles[second.triangle]);
  const Vec3 along = (p[first.head] - p[first.tail]).normalized();
  const double turn = std::atan2(n.cross(m).dot(along), n.dot(m));  // positive where convex
  if (!(turn > 0)) return 180;
  const double shared = (180 - turn * 180 / std::numbers::pi) / 2;
  const double filled = tet_measures(p[first.tail], p[first.apex], p[first.head], p[second.apex]).min_dihedral_deg;
  return std::max(shared, filled);
}

}  // namespace

SurfaceBound surface_bound(const SurfaceMesh& surface) {
  SurfaceBound bound;
  const auto& p = surface.vertices;
  const std::vector<Side> all = sides(surface);
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    if (all[i].tail != all[i + 1].head || all[i].head != all[i + 1].tail) continue;
    const double angle = best_angle_deg(surface, all[i], all[i + 1]);
    if (angle >= bound.min_dihedral_deg) continue;
    bound.min_dihedral_deg = angle;
    bound.sharpest_edge = (p[all[i].tail] + p[all[i].head]) / 2;
    bound.sharpest_edge_triangle = all[i].triangle;
  }
  for (std::uint32_t i = 0; i < surface.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const Triangle& t = surface.triangles[i];
      const Vec3 u = p[t[(k + 1) % 3]] - p[t[k]], v = p[t[(k + 2) % 3]] - p[t[k]];
      const double jacobian = std::numbers::sqrt2 * u.cross(v).norm() / (u.norm() * v.norm());
      if (jacobian >= bound.scaled_jacobian) continue;
      bound.scaled_jacobian = jacobian;
      bound.worst_triangle = i;
      bound.worst_triangle_centre = (p[t[0]] + p[t[1]] + p[t[2]]) / 3;
    }
  return bound;
}

}  // namespace scan2fea
