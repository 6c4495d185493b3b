#include "preproc/volume/surface_bound.hpp"

#include "quality/tetrahedron_measures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
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

// Of a triangle's side: the height over it, over the longer of the other two sides.
double slenderness(const SurfaceMesh& surface, const Side& side) {
  const Vec3 &a = surface.vertices[side.tail], &b = surface.vertices[side.head], &c = surface.vertices[side.apex];
  const double height = (b - a).cross(c - a).norm() / (b - a).norm();
  return height / std::max((c - a).norm(), (c - b).norm());
}

struct EdgeBound {
  double min_dihedral_deg, scaled_jacobian;
};

std::optional<EdgeBound> convex_edge_bound(const SurfaceMesh& surface, const Side& first, const Side& second) {
  const auto& p = surface.vertices;
  const Vec3 n = area_vector(surface, surface.triangles[first.triangle]);
  const Vec3 m = area_vector(surface, surface.triangles[second.triangle]);
  const Vec3 along = (p[first.head] - p[first.tail]).normalized();
  const double turn = std::atan2(n.cross(m).dot(along), n.dot(m));  // positive where convex
  if (!(turn > 0)) return std::nullopt;
  const double half = (std::numbers::pi - turn) / 2;
  const double jacobian =
      std::numbers::sqrt2 * std::sin(half) * std::max(slenderness(surface, first), slenderness(surface, second));
  const TetShape filled = measure_tetrahedron(p[first.tail], p[first.apex], p[first.head], p[second.apex]);
  return EdgeBound{std::max(half * 180 / std::numbers::pi, filled.min_dihedral_deg),
                   std::max(jacobian, filled.scaled_jacobian)};
}

}  // namespace

SurfaceBound surface_bound(const SurfaceMesh& surface) {
  SurfaceBound bound;
  const auto& p = surface.vertices;
  const auto limit_jacobian = [&](double jacobian, const Vec3& place) {
    if (jacobian >= bound.scaled_jacobian) return;
    bound.scaled_jacobian = jacobian;
    bound.scaled_jacobian_at = place;
  };
  const std::vector<Side> all = sides(surface);
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    if (all[i].tail != all[i + 1].head || all[i].head != all[i + 1].tail) continue;
    const auto edge = convex_edge_bound(surface, all[i], all[i + 1]);
    if (!edge) continue;
    const Vec3 middle = (p[all[i].tail] + p[all[i].head]) / 2;
    limit_jacobian(edge->scaled_jacobian, middle);
    if (edge->min_dihedral_deg >= bound.min_dihedral_deg) continue;
    bound.min_dihedral_deg = edge->min_dihedral_deg;
    bound.min_dihedral_at = middle;
  }
  for (const Triangle& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 u = p[t[(k + 1) % 3]] - p[t[k]], v = p[t[(k + 2) % 3]] - p[t[k]];
      limit_jacobian(std::numbers::sqrt2 * u.cross(v).norm() / (u.norm() * v.norm()),
                     (p[t[0]] + p[t[1]] + p[t[2]]) / 3);
    }
  return bound;
}

}  // namespace scan2fea
