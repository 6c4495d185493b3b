#include "preproc/surface/kernel/micro_edges.hpp"

#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <algorithm>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

double length_of(const HalfedgeMesh& mesh, Index h) {
  return (mesh.points[mesh.target(h)] - mesh.points[mesh.origin(h)]).norm();
}

bool contract_short_edges(HalfedgeMesh& mesh, double shortest) {
  bool changed = false;
  for (Index h = 0; h < 3 * mesh.face_slots(); ++h) {
    if (!mesh.is_face_alive(HalfedgeMesh::face(h)) || length_of(mesh, h) >= shortest || !mesh.can_collapse(h)) continue;
    mesh.collapse(h);
    changed = true;
  }
  return changed;
}

// Gives the longest edges of flat triangles a vertex where the opposite one is, to be contracted with it.
bool split_beside_apices(HalfedgeMesh& mesh, double shortest) {
  bool changed = false;
  const auto faces = static_cast<Index>(mesh.face_slots());
  for (Index f = 0; f < faces; ++f) {
    if (!mesh.is_face_alive(f)) continue;
    Index longest = 3 * f;
    for (const Index h : {3 * f + 1, 3 * f + 2})
      if (length_of(mesh, h) > length_of(mesh, longest)) longest = h;
    const double length = length_of(mesh, longest);
    if (mesh.area_vector(f).norm() >= shortest * length) continue;
    const Vec3 &a = mesh.points[mesh.origin(longest)], &b = mesh.points[mesh.target(longest)];
    const Vec3 apex = mesh.points[mesh.target(HalfedgeMesh::next(longest))];
    const double along = (apex - a).dot(b - a) / length;
    if (along < shortest || along > length - shortest) continue;  // an edge of it is short
    mesh.split_edge(longest, apex);
    changed = true;
  }
  return changed;
}

}  // namespace

SurfaceMesh without_micro_edges(const SurfaceMesh& given, double shortest) {
  constexpr int most_rounds = 8;
  HalfedgeMesh mesh(given);
  bool changed = false;
  for (int round = 0; round < most_rounds; ++round) {
    const bool contracted = contract_short_edges(mesh, shortest);
    const bool split = split_beside_apices(mesh, shortest);
    changed = changed || contracted || split;
    if (!split) break;
  }
  return changed ? mesh.to_surface() : given;
}

}  // namespace scan2fea
