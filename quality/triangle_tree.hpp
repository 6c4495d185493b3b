// Nearest points on, and box queries of, a set of triangles: a bounding volume hierarchy in double precision.
//
// Four children a node, their boxes side by side so that one pass of vector instructions measures the query's distance
// to all four (the layout of Dammertz, Hanika and Keller, "Shallow bounding volume hierarchies", 2008, with medians of
// the longest axis as splits: scans are near-uniform, and surface-area heuristics cost more than they save here).
// A leaf is one triangle; it is measured exactly only if its box is nearer than the best point so far.
//
// The tree copies what it needs: the mesh may change or go afterwards, and the tree then still describes the old one.
// All queries are const and may run from any number of threads. Coordinates must be finite, and below 1e150 in size.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace scan2fea {

// The point of triangle abc nearest to p. Exact regions, so that needles and zero-area triangles are measured as the
// segments or points that they are.
Vec3 closest_point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

struct ClosestPoint {
  double squared_distance;
  Vec3 point;
  std::uint32_t triangle;  // index in the mesh
};

class TriangleTree {
 public:
  // Of all triangles, or of those listed. Throws InvalidInput if there are none. O(n log n), 80 bytes a triangle plus
  // as much for its nodes.
  explicit TriangleTree(const SurfaceMesh& mesh);
  TriangleTree(const SurfaceMesh& mesh, std::span<const std::uint32_t> triangles);

  // The nearest point of the set, about O(log n). Where several triangles are equally near, as beside a shared edge,
  // which of them is named depends on the hint and on rounding, though never on threads.
  ClosestPoint closest(const Vec3& p) const;

  // The same, faster where `hint`, a triangle of the set, is near: neighbouring queries pass the previous answer.
  ClosestPoint closest(const Vec3& p, std::uint32_t hint) const;

  // Nothing if no point is nearer than `distance`.
  std::optional<ClosestPoint> closest_within(const Vec3& p, double distance) const;

  // Calls visit(triangle index) for each triangle whose bounding box meets `box` (touching counts), in a fixed order.
  template <class Visit>
  void for_each_overlap(const BoundingBox& box, Visit&& visit) const;

  // The triangles' indices in the order of the leaves: neighbours in this list are mostly neighbours in space, which
  // makes runs of queries along it cheap.
  const std::vector<std::uint32_t>& leaf_order() const { return triangle_of_leaf_; }
  // The place of a triangle of the set in that list, and the corners of the triangle at a place: beside one another in
  // memory where the triangles are neighbours.
  std::uint32_t leaf_of(std::uint32_t triangle) const { return leaf_of_triangle_[triangle]; }
  const std::array<Vec3, 3>& corners_of_leaf(std::uint32_t leaf) const { return leaves_[leaf]; }

 private:
  using FourBoxes = Eigen::Array<double, 4, 3>;  // row: child, column: axis
  struct Node {
    FourBoxes low, high;                 // an empty slot has low = +inf, high = -inf, and so meets nothing
    std::array<std::uint32_t, 4> child;  // a node, or a leaf where is_leaf_bit is set
  };
  struct Centre {
    Vec3 position;
    std::uint32_t triangle;
  };
  static constexpr std::uint32_t is_leaf_bit = 1U << 31;
  static constexpr std::uint32_t empty_child = ~0U;
  // A node leaves at most three siblings behind for each of log4(2^31) < 16 levels.
  static constexpr std::size_t stack_size = 64;

  void build(const SurfaceMesh& mesh, std::span<const std::uint32_t> triangles);
  std::uint32_t build_node(std::span<Centre> centres);
  BoundingBox box_of_child(std::uint32_t child) const;
  void descend(const Vec3& p, ClosestPoint& best) const;

  std::vector<Node> nodes_;
  std::vector<std::array<Vec3, 3>> leaves_;
  std::vector<std::uint32_t> triangle_of_leaf_;
  std::vector<std::uint32_t> leaf_of_triangle_;
};

template <class Visit>
void TriangleTree::for_each_overlap(const BoundingBox& box, Visit&& visit) const {
  std::array<std::uint32_t, stack_size> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[stack[--size]];
    // The largest of the gaps along the axes, for all four children; negative where they overlap. A difference of
    // doubles has the right sign even where it is rounded.
    const auto gap = [&](Eigen::Index axis) {
      return (node.low.col(axis) - box.high[axis]).max(box.low[axis] - node.high.col(axis));
    };
    const Eigen::Array4d gaps = gap(0).max(gap(1)).max(gap(2));
    for (Eigen::Index k = 0; k < 4; ++k) {
      if (!(gaps[k] <= 0)) continue;
      const std::uint32_t child = node.child[static_cast<std::size_t>(k)];
      if (child & is_leaf_bit)
        visit(triangle_of_leaf_[child & ~is_leaf_bit]);
      else
        stack[size++] = child;
    }
  }
}

}  // namespace scan2fea
