#include "preproc/surface/enrichment/surface_walk.hpp"

#include <cmath>
#include <limits>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

// How fast the weights of a face's corners change along a vector of its plane; nothing for a face without area.
std::optional<Vec3> weight_rates(const HalfedgeMesh& mesh, Index f, const Vec3& vector) {
  const Triangle t = mesh.triangle(f);
  const Vec3 e1 = mesh.points[t[1]] - mesh.points[t[0]];
  const Vec3 e2 = mesh.points[t[2]] - mesh.points[t[0]];
  const double d11 = e1.squaredNorm(), d12 = e1.dot(e2), d22 = e2.squaredNorm();
  const double determinant = d11 * d22 - d12 * d12;
  if (!(determinant > 1e-14 * d11 * d22)) return std::nullopt;
  const double v1 = vector.dot(e1), v2 = vector.dot(e2);
  const double r1 = (d22 * v1 - d12 * v2) / determinant, r2 = (d11 * v2 - d12 * v1) / determinant;
  return Vec3(-r1 - r2, r1, r2);
}

// A place and a way on the surface.
struct Walker {
  SurfacePoint at;
  Vec3 heading;  // unit, in the face's plane
};

// In the face of v whose angle, seen in the tangent plane, holds the direction best.
std::optional<Walker> set_out(const HalfedgeMesh& mesh, Index v, const Vec3& normal, const Vec3& direction) {
  const Vec3 side = normal.cross(direction);
  std::optional<Walker> walker;
  double best = -std::numeric_limits<double>::infinity();
  mesh.for_each_outgoing(v, [&](Index h) {
    const Vec3 e1 = mesh.points[mesh.target(h)] - mesh.points[v];
    const Vec3 e2 = mesh.points[mesh.origin(HalfedgeMesh::prev(h))] - mesh.points[v];
    const double x1 = e1.dot(direction), y1 = e1.dot(side), x2 = e2.dot(direction), y2 = e2.dot(side);
    const double determinant = x1 * y2 - x2 * y1;
    if (!(determinant > 0)) return;
    const double a = y2 / determinant * e1.norm(), b = -y1 / determinant * e2.norm();
    const double inside = std::min(a, b);
    if (inside <= best) return;
    best = inside;
    const Vec3 way = std::max(a, 0.0) * e1.normalized() + std::max(b, 0.0) * e2.normalized();
    Vec3 weights = Vec3::Zero();
    weights[h % 3] = 1;
    walker = Walker{{HalfedgeMesh::face(h), weights}, way.normalized()};
  });
  // Beyond a border no face holds the direction.
  return best > -1e-9 ? walker : std::nullopt;
}

// Over the edge opposite to the corner, unfolding the next face into the plane of this one.
bool cross(const HalfedgeMesh& mesh, Walker& walker, Index corner) {
  const Index exit = 3 * walker.at.face + (corner + 1) % 3;
  const Index entry = mesh.opposite(exit);
  if (entry == HalfedgeMesh::none) return false;
  const Vec3 along = (mesh.points[mesh.target(entry)] - mesh.points[mesh.origin(entry)]).normalized();
  const Index f = HalfedgeMesh::face(entry);
  const Vec3 inwards = mesh.area_vector(f).normalized().cross(along);
  const double c = std::clamp(walker.heading.dot(along), -1.0, 1.0);
  Vec3 weights = Vec3::Zero();
  weights[entry % 3] = walker.at.weights[(corner + 2) % 3];
  weights[(entry + 1) % 3] = walker.at.weights[(corner + 1) % 3];
  walker = {{f, weights / weights.sum()}, c * along + std::sqrt(1 - c * c) * inwards};
  return true;
}

}  // namespace

Vec3 position(const HalfedgeMesh& mesh, const SurfacePoint& point) {
  const Triangle t = mesh.triangle(point.face);
  return point.weights[0] * mesh.points[t[0]] + point.weights[1] * mesh.points[t[1]] +
         point.weights[2] * mesh.points[t[2]];
}

std::optional<SurfacePoint> walk_straight(const HalfedgeMesh& mesh, Index v, const Vec3& normal, const Vec3& direction,
                                          double length) {
  std::optional<Walker> walker = set_out(mesh, v, normal, direction);
  // A bound against circling in rounding about a vertex.
  for (int faces = 0; walker && faces < 200; ++faces) {
    const std::optional<Vec3> rates = weight_rates(mesh, walker->at.face, walker->heading);
    if (!rates) return std::nullopt;
    double to_edge = std::numeric_limits<double>::infinity();
    Index corner = 0;
    for (Index i = 0; i < 3; ++i)
      if ((*rates)[i] < 0 && walker->at.weights[i] / -(*rates)[i] < to_edge) {
        to_edge = walker->at.weights[i] / -(*rates)[i];
        corner = i;
      }
    const double step = std::min(length, to_edge);
    walker->at.weights = (walker->at.weights + step * *rates).cwiseMax(0);
    walker->at.weights /= walker->at.weights.sum();
    length -= step;
    if (length <= 0) return walker->at;
    if (!cross(mesh, *walker, corner)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace scan2fea
