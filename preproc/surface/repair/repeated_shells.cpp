#include "preproc/surface/repair/repeated_shells.hpp"

#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/unused_vertices.hpp"
#include "preproc/surface/repair/shells.hpp"
#include "preproc/surface/repair/soup_cleaning.hpp"
#include "quality/deviation_bound.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace scan2fea {
namespace {

// Of the diagonal.
constexpr double farthest = 1e-3;
// Of the vertices: beside sharp edges and in thin places what is nearest to some is another side of the body.
constexpr double most_opposed = 0.05;

bool boxes_agree(const BoundingBox& a, const BoundingBox& b, double distance) {
  return ((a.low - b.low).array().abs() <= distance).all() && ((a.high - b.high).array().abs() <= distance).all();
}

SurfaceMesh surface_of(const SurfaceMesh& mesh, const Shell& shell) {
  SurfaceMesh surface{mesh.vertices, {}};
  for (const std::uint32_t f : shell.faces) surface.triangles.push_back(mesh.triangles[f]);
  drop_unused_vertices(surface);
  return surface;
}

// Whether all of the one lies within the distance of the other, and nearly all of its vertices face as what is nearest
// to them does.
bool lies_along(const SurfaceMesh& one, const DeviationReference& other, double distance) {
  const std::vector<Vec3> normals = vertex_normals(one);
  std::size_t opposed = 0;
  std::uint32_t hint = other.tree().leaf_order().front();
  for (std::size_t v = 0; v < one.vertices.size(); ++v) {
    const ClosestPoint nearest = other.tree().closest(one.vertices[v], hint);
    hint = nearest.triangle;
    if (nearest.squared_distance > distance * distance) return false;
    opposed += !(area_vector(other.mesh(), other.mesh().triangles[hint]).dot(normals[v]) > 0);
  }
  if (static_cast<double>(opposed) > most_opposed * static_cast<double>(one.vertices.size())) return false;
  return bound_one_sided_deviation(one, other, {.limit = distance}).largest_upper <= distance;
}

bool repeats(const SurfaceMesh& mesh, const Shell& shell, const Shell& other) {
  const double distance = farthest * other.box.diagonal();
  if ((shell.volume > 0) != (other.volume > 0) || !boxes_agree(shell.box, other.box, distance)) return false;
  const SurfaceMesh one = surface_of(mesh, shell), two = surface_of(mesh, other);
  return lies_along(one, DeviationReference(two), distance) && lies_along(two, DeviationReference(one), distance);
}

}  // namespace

bool drop_repeated_shells(SurfaceMesh& mesh, std::span<const FacePair> pairs, RepairResult& result) {
  const std::vector<Shell> shells = find_shells(mesh);
  if (shells.size() < 2) return false;
  const std::vector<std::uint32_t> shell_of_face = shell_of_faces(shells, mesh.triangles.size());
  std::set<std::pair<std::uint32_t, std::uint32_t>> crossing;
  for (const FacePair& pair : pairs) {
    const auto [a, b] = std::minmax(shell_of_face[pair.face], shell_of_face[pair.other]);
    if (a != b) crossing.insert({a, b});
  }
  std::vector<std::optional<RepairKind>> reasons(shells.size());
  for (const auto& [a, b] : crossing)
    if (!reasons[a] && !reasons[b] && repeats(mesh, shells[b], shells[a])) reasons[b] = RepairKind::RepeatedShell;
  if (std::none_of(reasons.begin(), reasons.end(), [](const auto& reason) { return reason.has_value(); })) return false;
  drop_shells(mesh, shells, reasons, result);
  return true;
}

}  // namespace scan2fea
