#include "preproc/surface/reconstruction/hole_voids.hpp"

#include "quality/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace scan2fea {
namespace {

constexpr double inner = 0.8;  // of the radius: what is nearer to the axis is not of the wall or the rim

// Of the triangle and the axis: a chord between three points of a circle comes as near to its centre as half of the
// radius.
constexpr double across = 0.5;

double distance_from_axis(const HoleVoid& hole, const Vec3& p) {
  const Vec3 d = p - hole.shape.origin;
  return (d - d.dot(hole.shape.axis) * hole.shape.axis).norm();
}

bool is_hole(const Primitive& primitive) {
  constexpr double half_turn = 180;
  if (primitive.shape.kind == ShapeKind::cone) return primitive.shape.hollow && primitive.turn_deg > half_turn;
  return primitive.use == PrimitiveUse::hole;
}

// How many points of a plane lie about the axis of a hole, and how many of them before its mouth.
struct PlaneAtHole {
  std::size_t about = 0, before = 0;
};

std::vector<PlaneAtHole> planes_at(const HoleVoid& hole, const std::vector<Vec3>& points, const Primitives& found) {
  constexpr double beside = 3;  // spacings
  std::vector<PlaneAtHole> planes(found.list.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t label = found.labels[i];
    if (label == no_primitive || found.list[label].shape.kind != ShapeKind::plane) continue;
    const double away = distance_from_axis(hole, points[i]), radius = hole.radius_at(hole.height(points[i]));
    planes[label].about += away < radius + beside * found.spacing;
    planes[label].before += away < inner * radius;
  }
  return planes;
}

// Moves the ends to the faces there.
void find_ends(const std::vector<Vec3>& points, const Primitives& found, HoleVoid& hole) {
  constexpr double least_slope = 0.3, farthest = 3;  // cosine; spacings
  constexpr std::size_t fewest = 3;
  const std::vector<PlaneAtHole> planes = planes_at(hole, points, found);
  double low = -std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t k = 0; k < planes.size(); ++k) {
    if (planes[k].about < fewest) continue;
    const Shape& plane = found.list[k].shape;
    const double slope = plane.axis.dot(hole.shape.axis);
    if (std::abs(slope) < least_slope) continue;
    const double at = (plane.origin - hole.shape.origin).dot(plane.axis) / slope;
    const bool is_above = at > 0.5 * (hole.low + hole.high);
    const bool is_floor = is_above == (slope < 0);
    if (!is_floor && planes[k].before > 0) continue;
    if (is_above && at > hole.high - hole.margin) high = std::min(high, at);
    if (!is_above && at < hole.low + hole.margin) low = std::max(low, at);
  }
  if (high - hole.high < farthest * found.spacing) hole.high = std::max(hole.high, high);
  if (hole.low - low < farthest * found.spacing) hole.low = std::min(hole.low, low);
}

}  // namespace

double HoleVoid::radius_at(double height) const {
  return shape.kind == ShapeKind::cone ? std::max(0.0, shape.radius + height * std::tan(shape.half_angle))
                                       : shape.radius;
}

bool HoleVoid::contains(const Vec3& p) const {
  const double at = height(p);
  return at > low && at < high && shape.signed_distance(p) > margin;
}

std::vector<HoleVoid> find_hole_voids(const std::vector<Vec3>& points, const Primitives& found) {
  constexpr double of_sigma = 2;
  std::vector<HoleVoid> voids;
  std::vector<std::uint32_t> void_of(found.list.size(), no_primitive);
  for (std::uint32_t k = 0; k < found.list.size(); ++k) {
    if (!is_hole(found.list[k])) continue;
    void_of[k] = static_cast<std::uint32_t>(voids.size());
    const double far = std::numeric_limits<double>::infinity();
    voids.push_back({.primitive = k,
                     .shape = found.list[k].shape,
                     .low = far,
                     .high = -far,
                     .margin = of_sigma * found.sigma,
                     .points = 0});
  }
  if (voids.empty()) return voids;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t label = found.labels[i];
    if (label == no_primitive || void_of[label] == no_primitive) continue;
    HoleVoid& hole = voids[void_of[label]];
    hole.low = std::min(hole.low, hole.height(points[i]));
    hole.high = std::max(hole.high, hole.height(points[i]));
    ++hole.points;
  }
  std::erase_if(voids, [](const HoleVoid& hole) { return hole.points == 0; });
  for (HoleVoid& hole : voids) find_ends(points, found, hole);
  return voids;
}

std::vector<BridgedVoid> find_bridged_voids(const SurfaceMesh& surface, const std::vector<HoleVoid>& voids) {
  std::vector<BridgedVoid> bridged;
  if (surface.triangles.empty() || voids.empty()) return bridged;
  const TriangleTree tree(surface);
  for (std::uint32_t k = 0; k < voids.size(); ++k) {
    const HoleVoid& hole = voids[k];
    BridgedVoid bridge{k, Vec3::Zero(), {}};
    double nearest = std::numeric_limits<double>::infinity();
    // Four places a radius: what passes between two of them passes within half of it.
    const double step = 0.25 * std::max(hole.radius_at(hole.low), hole.radius_at(hole.high));
    const int steps = static_cast<int>(std::clamp(std::ceil((hole.high - hole.low) / step), 1.0, 1000.0));
    for (int s = 0; s <= steps; ++s) {
      const double at = std::lerp(hole.low, hole.high, static_cast<double>(s) / steps);
      const double radius = hole.radius_at(at);
      const auto found = tree.closest_within(hole.on_axis(at), across * radius);
      if (!found) continue;
      const Triangle& t = surface.triangles[found->triangle];
      if (std::ranges::any_of(t, [&](std::uint32_t v) {
            return distance_from_axis(hole, surface.vertices[v]) <
                   inner * hole.radius_at(hole.height(surface.vertices[v]));
          }))
        continue;
      bridge.triangles.push_back(found->triangle);
      if (found->squared_distance >= nearest) continue;
      nearest = found->squared_distance;
      bridge.place = found->point;
    }
    std::ranges::sort(bridge.triangles);
    bridge.triangles.erase(std::unique(bridge.triangles.begin(), bridge.triangles.end()), bridge.triangles.end());
    if (!bridge.triangles.empty()) bridged.push_back(std::move(bridge));
  }
  return bridged;
}

}  // namespace scan2fea
