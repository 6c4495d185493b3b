// Who lies beside whom in an indexed triangle mesh, as flat arrays.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace scan2fea {

inline constexpr std::uint32_t no_face = std::numeric_limits<std::uint32_t>::max();

// The corners at each vertex: corner 3 f + k is triangle f at its k-th vertex. Within a vertex they are ascending by
// triangle, not in turning order.
class VertexStars {
 public:
  // Linear in the mesh. Indices must be in range; vertices without a triangle have an empty star.
  explicit VertexStars(const SurfaceMesh& mesh);

  std::span<const std::uint32_t> corners(std::uint32_t vertex) const {
    return {corners_.data() + first_[vertex], first_[vertex + 1] - first_[vertex]};
  }
  std::size_t vertex_count() const { return first_.size() - 1; }

 private:
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> corners_;
};

// For each triangle the three across its edges, the k-th opposite to its k-th vertex; no_face across a boundary edge
// and across an edge that is not shared by exactly two triangles of opposite direction. Linear in the mesh.
std::vector<Triangle> face_neighbours(const SurfaceMesh& mesh, const VertexStars& stars);

}  // namespace scan2fea
