#include "preproc/surface/kernel/delaunay_flips.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

// Cotangent of the angle opposite to h.
double opposite_cotangent(const HalfedgeMesh& mesh, Index h) {
  const Vec3& apex = mesh.points[mesh.origin(HalfedgeMesh::prev(h))];
  const Vec3 a = mesh.points[mesh.origin(h)] - apex, b = mesh.points[mesh.target(h)] - apex;
  return a.dot(b) / a.cross(b).norm();
}

bool within(const Vec3& w1, const Vec3& w2, double cosine) {
  return w1.dot(w2) > cosine * w1.norm() * w2.norm();
}

bool should_flip(const HalfedgeMesh& mesh, Index h, double crease_cosine) {
  if (mesh.is_border(h)) return false;
  const Index o = mesh.opposite(h);
  // The tolerance keeps cocircular pairs from flipping to and fro.
  if (!(opposite_cotangent(mesh, h) + opposite_cotangent(mesh, o) < -1e-6)) return false;
  const Vec3 w1 = mesh.area_vector(HalfedgeMesh::face(h)), w2 = mesh.area_vector(HalfedgeMesh::face(o));
  if (!within(w1, w2, crease_cosine)) return false;
  const Vec3& a = mesh.points[mesh.origin(h)];
  const Vec3& b = mesh.points[mesh.target(h)];
  const Vec3& c = mesh.points[mesh.origin(HalfedgeMesh::prev(h))];
  const Vec3& d = mesh.points[mesh.origin(HalfedgeMesh::prev(o))];
  const Vec3 w3 = (d - a).cross(c - a), w4 = (b - d).cross(c - d);
  const Vec3 before = w1 + w2;
  return within(w3, before, 0) && within(w4, before, 0) && within(w3, w4, crease_cosine) && mesh.can_flip(h);
}

}  // namespace

std::size_t restore_delaunay(HalfedgeMesh& mesh, Index v, const DelaunayFlipLimits& limits) {
  const double crease_cosine = std::cos(limits.crease_deg * std::numbers::pi / 180);
  std::vector<Index> waiting;
  mesh.for_each_outgoing(v, [&](Index h) { waiting.push_back(HalfedgeMesh::next(h)); });
  // On a surface the criterion need not lower any one energy, so that the number of flips is bounded as well.
  constexpr std::size_t most_flips = 500;
  std::size_t flips = 0;
  while (!waiting.empty() && flips < most_flips) {
    const Index h = waiting.back();
    waiting.pop_back();
    if (!should_flip(mesh, h, crease_cosine)) continue;
    if (std::binary_search(limits.kept.begin(), limits.kept.end(), feature_edge(mesh.origin(h), mesh.target(h))))
      continue;
    if (limits.may_flip && !limits.may_flip(h)) continue;
    const Index o = mesh.opposite(h);
    mesh.flip(h);
    ++flips;
    for (const Index side : {h, o}) {
      waiting.push_back(HalfedgeMesh::next(side));
      waiting.push_back(HalfedgeMesh::prev(side));
    }
  }
  return flips;
}

}  // namespace scan2fea
