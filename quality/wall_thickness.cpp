#include "quality/wall_thickness.hpp"

namespace scan2fea {

std::optional<Wall> find_wall(const SurfaceMesh& mesh, const TriangleTree& tree, const Vec3& place, const Vec3& outward,
                              const WallOptions& options) {
  constexpr int most_steps = 30;     // scans need fewer, however deep; in round bodies they become tiny
  constexpr double rounding = 1e-6;  // of the radius: so near to the ball a point is on it
  double radius = options.deepest / 2;
  std::optional<ClosestPoint> touched;
  for (int step = 0; step < most_steps; ++step) {
    const auto nearest = tree.closest_within(place - radius * outward, radius * (1 - rounding));
    if (!nearest) break;
    const Vec3 way = place - nearest->point;
    const double height = way.dot(outward);
    if (!(height > 0)) return std::nullopt;
    touched = nearest;
    radius = way.squaredNorm() / (2 * height);
  }
  if (!touched) return std::nullopt;
  const Vec3 other = area_vector(mesh, mesh.triangles[touched->triangle]);
  if (!(other.dot(outward) < options.opposing * other.norm())) return std::nullopt;
  return Wall{(place - touched->point).norm(), touched->point, touched->triangle};
}

}  // namespace scan2fea
