#include "preproc/surface/kernel/winding_number.hpp"

#include "preproc/surface/kernel/solid_angle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan2fea {

WindingNumber::WindingNumber(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  triangles_.reserve(triangles.size());
  for (const Triangle& t : triangles) triangles_.push_back({points[t[0]], points[t[1]], points[t[2]]});
  if (!triangles_.empty()) build(0, static_cast<std::uint32_t>(triangles_.size()));
}

std::uint32_t WindingNumber::build(std::uint32_t first, std::uint32_t last) {
  constexpr std::uint32_t leaf = 8;
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Node node;
  node.first = first;
  node.last = last;
  double area = 0;
  Vec3 low = triangles_[first].a, high = low;
  for (std::uint32_t i = first; i < last; ++i) {
    const Corners& t = triangles_[i];
    const Vec3 vector = 0.5 * (t.b - t.a).cross(t.c - t.a), centre = (t.a + t.b + t.c) / 3;
    const double size = vector.norm();
    node.area_vector += vector;
    node.centre += size * centre;
    area += size;
    low = low.cwiseMin(centre);
    high = high.cwiseMax(centre);
  }
  node.centre = area > 0 ? Vec3(node.centre / area) : Vec3(0.5 * (low + high));
  for (std::uint32_t i = first; i < last; ++i)
    for (const Vec3& corner : {triangles_[i].a, triangles_[i].b, triangles_[i].c})
      node.radius = std::max(node.radius, (corner - node.centre).norm());
  if (last - first > leaf) {
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    const std::uint32_t middle = first + (last - first) / 2;
    std::nth_element(triangles_.begin() + first, triangles_.begin() + middle, triangles_.begin() + last,
                     [&](const Corners& s, const Corners& t) {
                       return s.a[axis] + s.b[axis] + s.c[axis] < t.a[axis] + t.b[axis] + t.c[axis];
                     });
    node.left = build(first, middle);
    node.right = build(middle, last);
  }
  nodes_[index] = node;
  return index;
}

double WindingNumber::operator()(const Vec3& p) const {
  return nodes_.empty() ? 0 : of_node(0, p) / (4 * std::numbers::pi);
}

double WindingNumber::of_node(std::uint32_t index, const Vec3& p) const {
  constexpr double far = 2;  // radii: Barill et al. use as many
  const Node& node = nodes_[index];
  const Vec3 way = node.centre - p;
  const double distance = way.norm();
  if (distance > far * node.radius) return node.area_vector.dot(way) / (distance * distance * distance);
  if (node.left != 0) return of_node(node.left, p) + of_node(node.right, p);
  double sum = 0;
  for (std::uint32_t i = node.first; i < node.last; ++i) {
    const Corners& t = triangles_[i];
    sum += solid_angle(t.a - p, t.b - p, t.c - p);
  }
  return sum;
}

}  // namespace scan2fea
