#include "quality/triangle_tree.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/numbers.hpp"

#include <algorithm>
#include <numeric>

namespace scan2fea {
namespace {

Vec3 closest_point_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 direction = b - a;
  const double along = (p - a).dot(direction);
  const double length2 = direction.squaredNorm();
  if (along <= 0 || length2 <= 0) return a;
  if (along >= length2) return b;
  return a + (along / length2) * direction;
}

// Splits at the median of the longest axis; ties fall by index, so that equal centres split the same way everywhere.
template <class Centres>
auto split(Centres centres) {
  Vec3 low = centres[0].position, high = low;
  for (const auto& centre : centres) {
    low = low.cwiseMin(centre.position);
    high = high.cwiseMax(centre.position);
  }
  Eigen::Index axis;
  (high - low).maxCoeff(&axis);
  const auto middle = static_cast<std::ptrdiff_t>(centres.size() / 2);
  std::nth_element(centres.begin(), centres.begin() + middle, centres.end(), [axis](const auto& a, const auto& b) {
    return a.position[axis] != b.position[axis] ? a.position[axis] < b.position[axis] : a.triangle < b.triangle;
  });
  return std::array{centres.first(static_cast<std::size_t>(middle)), centres.subspan(static_cast<std::size_t>(middle))};
}

}  // namespace

Vec3 closest_point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, bc = c - b, ca = a - c;
  const Vec3 normal = ab.cross(-ca);
  const double normal2 = normal.squaredNorm();
  // Below this the normal's direction is rounding error; the edges alone then hold every point to 1e-12 of the longest.
  const bool flat = normal2 <= 1e-24 * ab.squaredNorm() * ca.squaredNorm();
  // On which side of each edge's wall (the plane through the edge, along the normal) the point lies.
  const bool beyond_ab = flat || ab.cross(p - a).dot(normal) <= 0;
  const bool beyond_bc = flat || bc.cross(p - b).dot(normal) <= 0;
  const bool beyond_ca = flat || ca.cross(p - c).dot(normal) <= 0;
  if (!beyond_ab && !beyond_bc && !beyond_ca) return p - ((p - a).dot(normal) / normal2) * normal;

  // The nearest point of a convex set lies on an edge that the point sees.
  Vec3 nearest = a;
  double nearest2 = infinity;
  const auto try_edge = [&](const Vec3& from, const Vec3& to) {
    const Vec3 candidate = closest_point_on_segment(p, from, to);
    const double distance2 = (p - candidate).squaredNorm();
    if (distance2 < nearest2) {
      nearest2 = distance2;
      nearest = candidate;
    }
  };
  if (beyond_ab) try_edge(a, b);
  if (beyond_bc) try_edge(b, c);
  if (beyond_ca) try_edge(c, a);
  return nearest;
}

TriangleTree::TriangleTree(const SurfaceMesh& mesh) {
  std::vector<std::uint32_t> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0U);
  build(mesh, all);
}

TriangleTree::TriangleTree(const SurfaceMesh& mesh, std::span<const std::uint32_t> triangles) {
  build(mesh, triangles);
}

void TriangleTree::build(const SurfaceMesh& mesh, std::span<const std::uint32_t> triangles) {
  if (triangles.empty())
    throw InvalidInput({.what = "no triangles to search", .where = {}, .value = {}, .limit = {}, .advice = {}});

  std::vector<Centre> centres;
  centres.reserve(triangles.size());
  for (const std::uint32_t t : triangles) {
    const auto& [i, j, k] = mesh.triangles[t];
    const Vec3 &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
    centres.push_back({0.5 * (a.cwiseMin(b).cwiseMin(c) + a.cwiseMax(b).cwiseMax(c)), t});
  }
  leaves_.reserve(triangles.size());
  nodes_.reserve(2 * triangles.size() / 3 + 1);
  triangle_of_leaf_.reserve(triangles.size());
  leaf_of_triangle_.resize(mesh.triangles.size());

  // Nodes first, since they decide the order of the leaves; their boxes from the bottom up afterwards.
  build_node(centres);
  for (const std::uint32_t t : triangle_of_leaf_) {
    leaf_of_triangle_[t] = static_cast<std::uint32_t>(leaves_.size());
    const auto& [i, j, k] = mesh.triangles[t];
    leaves_.push_back({mesh.vertices[i], mesh.vertices[j], mesh.vertices[k]});
  }
  for (std::size_t n = nodes_.size(); n-- > 0;) {  // children stand behind their parents
    Node& node = nodes_[n];
    for (Eigen::Index k = 0; k < 4; ++k) {
      const std::uint32_t child = node.child[static_cast<std::size_t>(k)];
      if (child == empty_child) continue;
      const BoundingBox box = box_of_child(child);
      node.low.row(k) = box.low.transpose().array();
      node.high.row(k) = box.high.transpose().array();
    }
  }
}

std::uint32_t TriangleTree::build_node(std::span<Centre> centres) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({FourBoxes::Constant(infinity),
                    FourBoxes::Constant(-infinity),
                    {empty_child, empty_child, empty_child, empty_child}});

  std::array<std::span<Centre>, 4> parts{centres, {}, {}, {}};
  if (centres.size() > 1) {
    const auto halves = split(centres);
    parts[0] = halves[0];
    parts[2] = halves[1];
    for (const std::size_t half : {std::size_t{0}, std::size_t{2}}) {
      if (parts[half].size() < 2) continue;
      const auto quarters = split(parts[half]);
      parts[half] = quarters[0];
      parts[half + 1] = quarters[1];
    }
  }
  for (std::size_t k = 0; k < 4; ++k) {
    if (parts[k].empty()) continue;
    std::uint32_t child;
    if (parts[k].size() == 1) {
      child = static_cast<std::uint32_t>(triangle_of_leaf_.size()) | is_leaf_bit;
      triangle_of_leaf_.push_back(parts[k][0].triangle);
    } else {
      child = build_node(parts[k]);
    }
    nodes_[index].child[k] = child;
  }
  return index;
}

BoundingBox TriangleTree::box_of_child(std::uint32_t child) const {
  if (child & is_leaf_bit) {
    const auto& [a, b, c] = leaves_[child & ~is_leaf_bit];
    return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
  }
  const Node& node = nodes_[child];
  return {node.low.colwise().minCoeff().transpose().matrix(), node.high.colwise().maxCoeff().transpose().matrix()};
}

void TriangleTree::descend(const Vec3& p, ClosestPoint& best) const {
  struct Entry {
    double squared_distance;
    std::uint32_t child;
  };
  std::array<Entry, stack_size> stack;
  std::size_t size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.squared_distance >= best.squared_distance) continue;
    if (entry.child & is_leaf_bit) {
      const std::uint32_t l = entry.child & ~is_leaf_bit;
      const auto& [a, b, c] = leaves_[l];
      const Vec3 candidate = closest_point_on_triangle(p, a, b, c);
      const double distance2 = (p - candidate).squaredNorm();
      if (distance2 < best.squared_distance) best = {distance2, candidate, triangle_of_leaf_[l]};
      continue;
    }
    const Node& node = nodes_[entry.child];
    const auto gap = [&](Eigen::Index axis) {
      return (node.low.col(axis) - p[axis]).max(p[axis] - node.high.col(axis)).max(0.0).square();
    };
    const Eigen::Array4d distance2 = gap(0) + gap(1) + gap(2);
    // Insertion sort: the nearest child ends on top of the stack.
    const std::size_t base = size;
    for (std::size_t k = 0; k < 4; ++k) {
      const double d2 = distance2[static_cast<Eigen::Index>(k)];
      if (!(d2 < best.squared_distance)) continue;
      std::size_t place = size++;
      for (; place > base && stack[place - 1].squared_distance < d2; --place) stack[place] = stack[place - 1];
      stack[place] = {d2, node.child[k]};
    }
  }
}

ClosestPoint TriangleTree::closest(const Vec3& p) const {
  ClosestPoint best{infinity, leaves_[0][0], triangle_of_leaf_[0]};
  descend(p, best);
  return best;
}

ClosestPoint TriangleTree::closest(const Vec3& p, std::uint32_t hint) const {
  const auto& [a, b, c] = leaves_[leaf_of_triangle_[hint]];
  const Vec3 candidate = closest_point_on_triangle(p, a, b, c);
  ClosestPoint best{(p - candidate).squaredNorm(), candidate, hint};
  descend(p, best);
  return best;
}

std::optional<ClosestPoint> TriangleTree::closest_within(const Vec3& p, double distance) const {
  const double limit = distance * distance;
  ClosestPoint best{limit, leaves_[0][0], triangle_of_leaf_[0]};
  descend(p, best);
  if (best.squared_distance < limit) return best;
  return std::nullopt;
}

}  // namespace scan2fea
