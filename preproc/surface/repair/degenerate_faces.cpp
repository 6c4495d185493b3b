#include "preproc/surface/repair/degenerate_faces.hpp"

#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

constexpr double degenerate_height_ratio = 1e-8;
constexpr double squared_ratio = degenerate_height_ratio * degenerate_height_ratio;

bool is_degenerate(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return (b - a).cross(c - a).squaredNorm() <= squared_ratio * longest * longest;
}

bool is_degenerate(const std::vector<Vec3>& points, const Triangle& t) {
  return is_degenerate(points[t[0]], points[t[1]], points[t[2]]);
}

bool mend(HalfedgeMesh& surface, std::uint32_t face, RepairResult& result) {
  const auto squared_length = [&](std::uint32_t h) {
    return (surface.points[surface.target(h)] - surface.points[surface.origin(h)]).squaredNorm();
  };
  std::array<std::uint32_t, 3> h{3 * face, 3 * face + 1, 3 * face + 2};
  std::sort(h.begin(), h.end(),
            [&](std::uint32_t a, std::uint32_t b) { return squared_length(a) < squared_length(b); });
  const double squared_longest = squared_length(h[2]);
  const RepairChange change{RepairKind::DegenerateFace, surface.points[surface.origin(h[2])],
                            std::sqrt(squared_longest)};

  if (squared_length(h[0]) <= squared_ratio * squared_longest) {
    std::uint32_t edge = h[0];
    if (surface.origin(edge) > surface.target(edge) && !surface.is_border(edge)) edge = surface.opposite(edge);
    if (!surface.can_collapse(edge)) return false;
    result.faces_removed += surface.is_border(edge) ? 1 : 2;
    surface.collapse(edge);
  } else {
    const std::uint32_t edge = h[2];
    if (!surface.can_flip(edge)) return false;
    // A flip is of no use if the faces after it are degenerate as well.
    const Vec3 &a = surface.points[surface.origin(edge)], &b = surface.points[surface.target(edge)];
    const Vec3& c = surface.points[surface.target(HalfedgeMesh::next(edge))];
    const Vec3& d = surface.points[surface.target(HalfedgeMesh::next(surface.opposite(edge)))];
    if (is_degenerate(c, a, d) || is_degenerate(d, b, c)) return false;
    surface.flip(edge);
  }
  result.changes.push_back(change);
  return true;
}

}  // namespace

void mend_degenerate_faces(SurfaceMesh& mesh, RepairResult& result) {
  const auto degenerate = [&](const Triangle& t) { return is_degenerate(mesh.vertices, t); };
  if (std::none_of(mesh.triangles.begin(), mesh.triangles.end(), degenerate)) return;
  HalfedgeMesh surface(mesh);
  for (bool progress = true; progress;) {
    progress = false;
    for (std::uint32_t f = 0; f < surface.face_slots(); ++f)
      if (surface.is_face_alive(f) && is_degenerate(surface.points, surface.triangle(f)))
        progress |= mend(surface, f, result);
  }
  mesh = surface.to_surface();
}

}  // namespace scan2fea
