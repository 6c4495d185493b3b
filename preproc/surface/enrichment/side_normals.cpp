#include "preproc/surface/enrichment/side_normals.hpp"

#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

// Between the normals of the faces at the edge; 0 at a border.
double dihedral_deg(const HalfedgeMesh& mesh, Index h) {
  if (mesh.is_border(h)) return 0;
  const Vec3 w1 = mesh.area_vector(HalfedgeMesh::face(h));
  const Vec3 w2 = mesh.area_vector(HalfedgeMesh::face(mesh.opposite(h)));
  return angle_between(w1, w2) * 180 / std::numbers::pi;
}

// At the origin of `h`.
Vec3 corner_normal(const HalfedgeMesh& mesh, Index h, CornerWeight weight) {
  const Vec3 across = mesh.area_vector(HalfedgeMesh::face(h));
  const double length = across.norm();
  if (weight == CornerWeight::area || !(length > 0)) return across;
  const Vec3& p = mesh.points[mesh.origin(h)];
  const Vec3 first = mesh.points[mesh.target(h)] - p;
  const Vec3 second = mesh.points[mesh.origin(HalfedgeMesh::prev(h))] - p;
  if (weight == CornerWeight::angle) return std::atan2(length, first.dot(second)) / length * across;
  return across / (first.squaredNorm() * second.squaredNorm());
}

}  // namespace

SideNormals::SideNormals(const HalfedgeMesh& mesh, CornerWeight weight) {
  means_.reserve(mesh.vertex_slots());
  first_.reserve(mesh.vertex_slots() + 1);
  std::vector<Index> fan;
  for (Index v = 0; v < mesh.vertex_slots(); ++v) {
    fan.clear();
    mesh.for_each_outgoing(v, [&](Index h) { fan.push_back(h); });
    // Around an inner vertex a side must not be cut where the fan happens to begin.
    const auto crease = std::find_if(fan.begin(), fan.end(), [&](Index h) { return is_crease(mesh, h); });
    if (crease != fan.end() && !mesh.is_border_vertex(v)) std::rotate(fan.begin(), crease, fan.end());
    Vec3 sum = Vec3::Zero(), side = Vec3::Zero();
    for (std::size_t i = 0; i < fan.size(); ++i) {
      if (i > 0 && is_crease(mesh, fan[i])) {
        sides_.push_back(side.normalized());
        side.setZero();
      }
      const Vec3 w = corner_normal(mesh, fan[i], weight);
      side += w;
      sum += w;
    }
    sides_.push_back(side.normalized());
    first_.push_back(sides_.size());
    means_.push_back(sum.normalized());
  }
}

const Vec3& SideNormals::facing(Index v, const Vec3& direction) const {
  std::size_t best = first_[v];
  for (std::size_t i = best + 1; i < first_[v + 1]; ++i)
    if (sides_[i].dot(direction) > sides_[best].dot(direction)) best = i;
  return sides_[best];
}

bool SideNormals::is_crease(const HalfedgeMesh& mesh, Index h) const {
  const double angle = dihedral_deg(mesh, h);
  constexpr double least = 60;  // degrees; between the angles of coarse or noisy scans and the edges of parts
  if (!(angle > least)) return false;
  // On a bent, coarse surface the faces' other edges bend as well: with angles alone its new points end a fifth farther
  // from the truth.
  for (const Index side : {h, mesh.opposite(h)})
    if (std::min(dihedral_deg(mesh, HalfedgeMesh::next(side)), dihedral_deg(mesh, HalfedgeMesh::prev(side))) >
        0.1 * angle)
      return false;
  return true;
}

void SideNormals::add(const Vec3& normal) {
  means_.push_back(normal);
  sides_.push_back(normal);
  first_.push_back(sides_.size());
}

void SideNormals::add(const Vec3& one_side, const Vec3& other_side) {
  means_.push_back((one_side + other_side).normalized());
  sides_.push_back(one_side);
  sides_.push_back(other_side);
  first_.push_back(sides_.size());
}

}  // namespace scan2fea
