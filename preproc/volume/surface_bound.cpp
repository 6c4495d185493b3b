#include "preproc/volume/surface_bound.hpp"

#include "preproc/mesh/numbers.hpp"
#include "quality/tetrahedron_measures.hpp"
#include "quality/triangle_measures.hpp"
#include "quality/triangle_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>
#include <vector>

namespace scan2fea {
namespace {

// A side of a triangle: from `tail` to `head` as the triangle turns.
struct Side {
  std::uint32_t tail, head, apex, triangle, number;
  auto key() const { return std::tuple(std::min(tail, head), std::max(tail, head), triangle); }
};

std::vector<Side> sides(const SurfaceMesh& surface) {
  std::vector<Side> result;
  result.reserve(surface.triangles.size() * 3);
  for (std::uint32_t i = 0; i < surface.triangles.size(); ++i)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Triangle& t = surface.triangles[i];
      result.push_back({t[k], t[(k + 1) % 3], t[(k + 2) % 3], i, k});
    }
  std::sort(result.begin(), result.end(), [](const Side& a, const Side& b) { return a.key() < b.key(); });
  return result;
}

double angle_at_edge(const SurfaceMesh& surface, const Side& first, const Side& second) {
  const Vec3 n = area_vector(surface, surface.triangles[first.triangle]);
  const Vec3 m = area_vector(surface, surface.triangles[second.triangle]);
  const Vec3 along = (surface.vertices[first.head] - surface.vertices[first.tail]).normalized();
  return interior_angle(n, m, along);
}

// Of a tetrahedron a, b, c, d at its edge from a to b, radians.
double dihedral(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return angle_between((b - a).cross(c - a), (b - a).cross(d - a));
}

// Of a triangle's side: the height over it, over the longer of the other two sides.
double slenderness(const SurfaceMesh& surface, const Side& side) {
  const Vec3 &a = surface.vertices[side.tail], &b = surface.vertices[side.head], &c = surface.vertices[side.apex];
  const double height = (b - a).cross(c - a).norm() / (b - a).norm();
  return height / std::max((c - a).norm(), (c - b).norm());
}

// Of one element or of several that share the angle.
struct EdgeBound {
  double min_dihedral_deg, scaled_jacobian;
};

class ConvexEdges {
 public:
  explicit ConvexEdges(const SurfaceMesh& surface)
      : surface_(surface), sides_(sides(surface)), angle_(3 * surface.triangles.size(), 0) {
    for_each_edge([&](const Side& first, const Side& second) {
      angle_[3 * first.triangle + first.number] = angle_[3 * second.triangle + second.number] =
          angle_at_edge(surface, first, second);
    });
  }

  template <class Visit>
  void for_each_edge(Visit visit) const {
    for (std::size_t i = 0; i + 1 < sides_.size(); ++i)
      if (sides_[i].tail == sides_[i + 1].head && sides_[i].head == sides_[i + 1].tail) visit(sides_[i], sides_[i + 1]);
  }

  // Nothing where the edge is not convex.
  std::optional<EdgeBound> bound(const Side& first, const Side& second) const {
    const double angle = angle_[3 * first.triangle + first.number];
    if (!(angle < std::numbers::pi)) return std::nullopt;
    const double half = angle / 2;
    const double jacobian =
        std::numbers::sqrt2 * std::sin(half) * std::max(slenderness(surface_, first), slenderness(surface_, second));
    const EdgeBound filled = bound_of_one(first, second);
    return EdgeBound{std::max(half * degrees, filled.min_dihedral_deg), std::max(jacobian, filled.scaled_jacobian)};
  }

 private:
  // Of the element that fills the edge alone; zero where it does not fit.
  EdgeBound bound_of_one(const Side& first, const Side& second) const {
    const auto& p = surface_.vertices;
    const Vec3 &a = p[first.tail], &b = p[first.head], &c = p[first.apex], &d = p[second.apex];
    const TetShape filled = measure_tetrahedron(a, c, b, d);
    double least = filled.min_dihedral_deg;
    const auto leave = [&](const Side& side, std::uint32_t step, const Vec3& from, const Vec3& to, const Vec3& other,
                           const Vec3& opposite) {
      const double left =
          (angle_[3 * side.triangle + (side.number + step) % 3] - dihedral(from, to, other, opposite)) * degrees;
      // Nothing is left where the next triangle is a face of the element, too.
      if (std::abs(left) > 1e-6) least = std::min(least, left);
    };
    leave(first, 1, b, c, a, d);
    leave(first, 2, c, a, b, d);
    leave(second, 1, a, d, b, c);
    leave(second, 2, d, b, a, c);
    if (!(least > 0)) return {0, 0};
    return {least, filled.scaled_jacobian};
  }

  const SurfaceMesh& surface_;
  std::vector<Side> sides_;
  std::vector<double> angle_;  // by triangle and side
};

// Where along the way from `from` by `way` a triangle is met first, 0 to 1; nothing where it is not.
std::optional<double> meets(const Vec3& from, const Vec3& way, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a, across = way.cross(v);
  const double determinant = u.dot(across);
  if (determinant == 0) return std::nullopt;
  const Vec3 w = from - a;
  const double at_u = w.dot(across) / determinant, at_v = way.dot(w.cross(u)) / determinant;
  const double at = v.dot(w.cross(u)) / determinant;
  if (at_u < 0 || at_v < 0 || at_u + at_v > 1 || at < 0 || at > 1) return std::nullopt;
  return at;
}

// The walls of the body behind its triangles. Not by the ball of quality/wall_thickness.hpp, since what is reported as
// a bound must be one. An element that has an angle along all three sides of a triangle reaches straight in from each
// point of it by the tangent of that angle times the way to the nearest side: where this way leaves the body, whatever
// it meets there, no such element fits. A ball may be stopped beside that way, where an element still fits, and finds
// nothing where the other side does not face the triangle.
class Walls {
 public:
  explicit Walls(const SurfaceMesh& surface) : surface_(surface), tree_(surface) {}

  // What triangle f bounds the angle to, if that is less than `bound_deg`, below 90.
  double lowered_by(std::uint32_t f, double bound_deg) const {
    const auto& [ia, ib, ic] = surface_.triangles[f];
    const Vec3 &a = surface_.vertices[ia], &b = surface_.vertices[ib], &c = surface_.vertices[ic];
    const Vec3 area = (b - a).cross(c - a), inwards = -area.normalized();
    const Eigen::Array3d opposite((c - b).norm(), (a - c).norm(), (b - a).norm());
    const Eigen::Array3d incentre = opposite / opposite.sum();
    std::array<Look, 4> looks;
    BoundingBox box{a, a};
    for (std::size_t k = 0; k < looks.size(); ++k) {
      Eigen::Array3d weights = incentre;
      if (k < 3) {
        weights /= 2;
        weights[static_cast<Eigen::Index>(k)] += 0.5;
      }
      Look& look = looks[k];
      look.from = weights[0] * a + weights[1] * b + weights[2] * c;
      look.beside = (weights * area.norm() / opposite).minCoeff();
      look.way = look.beside * std::tan(bound_deg / degrees) * inwards;
      const Vec3 end = look.from + look.way;
      box.low = box.low.cwiseMin(look.from).cwiseMin(end);
      box.high = box.high.cwiseMax(look.from).cwiseMax(end);
    }
    tree_.for_each_overlap(box, [&](std::uint32_t g) {
      if (g == f || area_vector(surface_, surface_.triangles[g]).dot(inwards) <= 0) return;  // no way out of the body
      const auto& [u, v, w] = surface_.triangles[g];
      for (const Look& look : looks)
        if (const auto at =
                meets(look.from, look.way, surface_.vertices[u], surface_.vertices[v], surface_.vertices[w]))
          bound_deg = std::min(bound_deg, std::atan(*at * look.way.norm() / look.beside) * degrees);
    });
    return bound_deg;
  }

 private:
  struct Look {
    Vec3 from, way;
    double beside;  // to the nearest of the triangle's sides
  };

  const SurfaceMesh& surface_;
  TriangleTree tree_;
};

}  // namespace

SurfaceBound surface_bound(const SurfaceMesh& surface) {
  SurfaceBound bound;
  const auto& p = surface.vertices;
  const auto limit_jacobian = [&](double jacobian, const Vec3& place) {
    if (jacobian >= bound.scaled_jacobian) return;
    bound.scaled_jacobian = jacobian;
    bound.scaled_jacobian_at = place;
  };
  const ConvexEdges edges(surface);
  edges.for_each_edge([&](const Side& first, const Side& second) {
    const auto edge = edges.bound(first, second);
    if (!edge) return;
    const Vec3 middle = (p[first.tail] + p[first.head]) / 2;
    limit_jacobian(edge->scaled_jacobian, middle);
    if (edge->min_dihedral_deg >= bound.min_dihedral_deg) return;
    bound.min_dihedral_deg = edge->min_dihedral_deg;
    bound.min_dihedral_at = middle;
  });
  const Walls walls(surface);
  for (std::uint32_t f = 0; f < surface.triangles.size(); ++f) {
    const double angle = walls.lowered_by(f, bound.min_dihedral_deg);
    if (angle >= bound.min_dihedral_deg) continue;
    const Triangle& t = surface.triangles[f];
    bound.min_dihedral_deg = angle;
    bound.min_dihedral_at = (p[t[0]] + p[t[1]] + p[t[2]]) / 3;
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
