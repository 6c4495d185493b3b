// The faces of a mesh in small blocks of neighbours, to find all pairs of faces whose bounding boxes meet.
//
// Faces are sorted along a Morton curve and cut into blocks of eight; over the blocks' boxes stands a complete binary
// tree. Next to a tree down to single triangles (triangle_tree.hpp) that is a tenth of the memory and a third of the
// time to build, for the one question that it answers.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

BoundingBox box_of_face(const std::vector<Vec3>& points, const Triangle& face);
BoundingBox box_of_face(const SurfaceMesh& mesh, std::uint32_t face);

// Whether the boxes have a point in common; touching counts.
inline bool boxes_meet(const BoundingBox& a, const BoundingBox& b) {
  return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

class FaceBlocks {
 public:
  static constexpr std::size_t block_size = 8;

  // Keeps no reference to the mesh. O(n log n), parallel; about 30 bytes a face, 20 of them while it is made.
  explicit FaceBlocks(const SurfaceMesh& mesh);

  std::size_t count() const { return (order_.size() + block_size - 1) / block_size; }
  std::span<const std::uint32_t> faces(std::size_t block) const {
    const std::size_t first = block * block_size;
    return {order_.data() + first, std::min(block_size, order_.size() - first)};
  }
  // All of them, neighbours in space mostly near one another.
  const std::vector<std::uint32_t>& order() const { return order_; }
  const BoundingBox& box(std::size_t block) const { return nodes_[leaves_ + block]; }

  // Calls visit(other) for each block from `block` on, itself included, whose box meets its box: over all blocks, each
  // pair once.
  template <class Visit>
  void for_each_meeting(std::size_t block, const Visit& visit) const {
    descend(1, 0, leaves_, block, visit);
  }

 private:
  template <class Visit>
  void descend(std::size_t node, std::size_t first, std::size_t size, std::size_t block, const Visit& visit) const {
    if (first + size <= block || !boxes_meet(nodes_[node], box(block))) return;
    if (size == 1) {
      visit(first);
      return;
    }
    descend(2 * node, first, size / 2, block, visit);
    descend(2 * node + 1, first + size / 2, size / 2, block, visit);
  }

  std::vector<std::uint32_t> order_;
  std::size_t leaves_ = 1;          // a power of two; node 1 is the root, block b is node leaves_ + b
  std::vector<BoundingBox> nodes_;  // low = +inf, high = -inf where there is no block
};

}  // namespace scan2fea
