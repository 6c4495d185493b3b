#include "preproc/surface/mending/constraint_projection.hpp"

#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace scan2fea {

namespace {

constexpr double degree = std::numbers::pi / 180;

struct Gradient {
  std::uint32_t vertex;
  Vec3 of_angle;
};

}  // namespace

double Hinge::angle_deg(const SurfaceMesh& mesh) const {
  const Triangle& t = mesh.triangles[face];
  const Vec3 along = (mesh.vertices[t[(side + 2) % 3]] - mesh.vertices[t[(side + 1) % 3]]).normalized();
  return interior_angle(area_vector(mesh, t), beyond, along) / degree;
}

void pull_point(SurfaceMesh& mesh, const std::vector<bool>& held, const Location& at, const Vec3& to, double distance) {
  // Of the squares of the barycentric coordinates of what can move.
  constexpr double least_leverage = 0.05;
  const Triangle& t = mesh.triangles[at.face];
  const Vec3 way = to - point_at(mesh, at);
  const double length = way.norm();
  double leverage = 0;
  for (std::size_t k = 0; k < 3; ++k)
    if (!held[t[k]]) leverage += at.barycentric[k] * at.barycentric[k];
  if (length <= distance || leverage < least_leverage) return;
  for (std::size_t k = 0; k < 3; ++k)
    if (!held[t[k]]) mesh.vertices[t[k]] += at.barycentric[k] / leverage * (1 - distance / length) * way;
}

void open_hinge(SurfaceMesh& mesh, const std::vector<bool>& held, const Hinge& hinge, double wanted_deg,
                double longest_step) {
  constexpr double relaxation = 0.5;
  const Triangle& t = mesh.triangles[hinge.face];
  const std::uint32_t a = t[(hinge.side + 1) % 3], b = t[(hinge.side + 2) % 3], c = t[hinge.side];
  const double length = (mesh.vertices[b] - mesh.vertices[a]).norm();
  const Vec3 along = (mesh.vertices[b] - mesh.vertices[a]) / length;
  // Of an apex, by its height over the edge; what the edge's ends get from it is opposite, and shared by its foot.
  const auto by_apex = [&](const Vec3& area) -> Vec3 { return length / area.squaredNorm() * area; };
  const auto foot = [&](std::uint32_t apex) { return (mesh.vertices[apex] - mesh.vertices[a]).dot(along) / length; };
  const Vec3 by_c = by_apex(area_vector(mesh, t)), by_d = hinge.apex ? by_apex(hinge.beyond) : Vec3::Zero();
  const double at_c = foot(c), at_d = hinge.apex ? foot(*hinge.apex) : 0;
  const std::array<Gradient, 4> gradients{{{c, by_c},
                                           {hinge.apex.value_or(c), by_d},
                                           {a, -(1 - at_c) * by_c - (1 - at_d) * by_d},
                                           {b, -at_c * by_c - at_d * by_d}}};
  double sum = 0, largest = 0;
  for (const Gradient& g : gradients) {
    if (held[g.vertex]) continue;
    sum += g.of_angle.squaredNorm();
    largest = std::max(largest, g.of_angle.norm());
  }
  if (!(sum > 0)) return;
  double step = relaxation * (wanted_deg - hinge.angle_deg(mesh)) * degree / sum;
  step = std::clamp(step, -longest_step / largest, longest_step / largest);
  for (const Gradient& g : gradients)
    if (!held[g.vertex]) mesh.vertices[g.vertex] += step * g.of_angle;
}

}  // namespace scan2fea
