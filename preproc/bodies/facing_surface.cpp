#include "preproc/bodies/facing_surface.hpp"

#include "preproc/surface/kernel/adjacency.hpp"

#include <limits>

namespace scan2fea {
namespace {

// Over an edge between two triangles that both face the place, the nearest point lies on it, and the way there is
// inclined to either by half the angle between them.
constexpr double most_inclined = 0.3;

}  // namespace

FacingSurface::FacingSurface(const SurfaceMesh& mesh, std::span<const std::uint32_t> triangles, double fuzz)
    : mesh_(mesh), tree_(mesh, triangles), normals_(face_normals(mesh)), fuzz_(fuzz) {
  std::vector<Vec3> corners;
  for (const std::uint32_t f : triangles)
    for (const std::uint32_t v : mesh.triangles[f]) corners.push_back(mesh.vertices[v]);
  box_ = bounding_box(corners);
}

std::optional<Foot> FacingSurface::under(const Vec3& place, const Vec3& normal, double reach) const {
  const Vec3 around = Vec3::Constant(reach);
  std::optional<Foot> foot;
  double nearest = reach * reach;
  tree_.for_each_overlap({place - around, place + around}, [&](std::uint32_t f) {
    if (normals_[f].dot(normal) > -facing) return;
    const Triangle& t = mesh_.triangles[f];
    const Vec3 point =
        closest_point_on_triangle(place, mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
    const double squared = (place - point).squaredNorm();
    if (squared > nearest || (foot && squared == nearest)) return;
    nearest = squared;
    foot = Foot{point, (place - point).dot(normals_[f]), f};
  });
  if (!foot) return {};
  const Vec3 beside = place - foot->point - foot->height * normals_[foot->triangle];
  if (beside.norm() > most_inclined * std::abs(foot->height) + fuzz_) return {};
  return foot;
}

}  // namespace scan2fea
