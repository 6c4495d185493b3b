#include "preproc/volume/max_min_relocation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace scan2fea {
namespace {

constexpr std::size_t most_active = 8;
constexpr double active_margin = 0.02;  // of the least quality, and absolutely

struct Gradients {
  std::array<Vec3, most_active> of;
  std::size_t size = 0;
};

Vec3 quality_gradient(const std::array<Vec3, 3>& f, const Vec3& x, double quality, double difference) {
  Vec3 gradient;
  for (int k = 0; k < 3; ++k) {
    Vec3 moved = x;
    moved[k] += difference;
    gradient[k] = (goal_quality(f[0], f[1], f[2], moved) - quality) / difference;
  }
  return gradient;
}

template <class Way>
Gradients active_gradients(const StarFaces& faces, const Vec3& x, double least, double difference, const Way& way) {
  Gradients active;
  const double limit = least + active_margin * (1 + std::abs(least));
  for (const auto& f : faces) {
    const double q = goal_quality(f[0], f[1], f[2], x);
    if (q > limit) continue;
    active.of[active.size++] = way.allowed(quality_gradient(f, x, q, difference));
    if (active.size == most_active) break;
  }
  return active;
}

// The point of the gradients' convex hull that is nearest to zero, by Gilbert's method: towards the gradient that
// points away the most, as far as it helps.
Vec3 shortest_in_hull(const Gradients& gradients) {
  Vec3 point = gradients.of[0];
  for (int round = 0; round < 16; ++round) {
    std::size_t lowest = 0;
    for (std::size_t k = 1; k < gradients.size; ++k)
      if (gradients.of[k].dot(point) < gradients.of[lowest].dot(point)) lowest = k;
    const Vec3 towards = gradients.of[lowest] - point;
    const double descent = -towards.dot(point);
    if (descent <= 1e-3 * point.squaredNorm()) break;
    point += std::min(1.0, descent / towards.squaredNorm()) * towards;
  }
  return point;
}

double nearest_corner(const StarFaces& faces, const Vec3& x) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& f : faces)
    for (const Vec3& p : f) least = std::min(least, (p - x).squaredNorm());
  return std::sqrt(least);
}

// Way: `allowed` is what of a direction may be gone, and `at` the place that is taken for one that is wanted.
template <class Way>
bool ascend(const StarFaces& faces, Way& way, Vec3& x, double& quality, int steps) {
  const double radius = nearest_corner(faces, x);
  double length = 0.2 * radius;
  bool moved = false;
  for (int step = 0; step < steps; ++step) {
    const Vec3 direction = shortest_in_hull(active_gradients(faces, x, quality, 1e-6 * radius, way));
    const double slope = direction.norm();
    if (!(slope * radius > 1e-3)) break;
    bool rose = false;
    for (int attempt = 0; attempt < 6 && !rose; ++attempt, length /= 3) {
      const std::optional<Vec3> candidate = way.at(x + direction * (length / slope));
      if (!candidate) continue;
      const double reached = star_quality(faces, *candidate, quality);
      if (!(reached > quality * (1 + 1e-4))) continue;
      x = *candidate;
      quality = reached;
      rose = moved = true;
      way.take();
      length *= 6;  // twice as far next time, after the division
    }
    if (!rose) break;
  }
  return moved;
}

struct Anywhere {
  const Vec3& allowed(const Vec3& direction) const { return direction; }
  std::optional<Vec3> at(const Vec3& wanted) const { return wanted; }
  void take() const {}
};

struct OnBoundary {
  const BoundaryWays& ways;
  std::uint32_t node;
  WayPoint here, next;

  Vec3 allowed(const Vec3& direction) const { return here.allowed(direction); }
  std::optional<Vec3> at(const Vec3& wanted) {
    const std::optional<WayPoint> point = ways(node, wanted);
    if (!point) return {};
    next = *point;
    return next.place;
  }
  void take() { here = next; }
};

}  // namespace

bool relocate_max_min(const StarFaces& faces, Vec3& x, double& quality, int steps) {
  Anywhere way;
  return ascend(faces, way, x, quality, steps);
}

bool slide_max_min(const StarFaces& faces, const BoundaryWays& ways, std::uint32_t node, Vec3& x, double& quality,
                   int steps) {
  const std::optional<WayPoint> here = ways(node, x);
  if (!here) return false;
  OnBoundary way{ways, node, *here, *here};
  return ascend(faces, way, x, quality, steps);
}

}  // namespace scan2fea
