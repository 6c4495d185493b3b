// Who lies beside whom in an indexed triangle mesh, as flat arrays.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace scan2fea {

inline constexpr std::uint32_t no_face = std::numeric_limits<std::uint32_t>::max();

// An edge of a surface as its vertices, the smaller one first: a crease, or a piece of a border, that is to be kept.
using FeatureEdge = std::array<std::uint32_t, 2>;

inline FeatureEdge feature_edge(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

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

// Both, for stages that hand them on. Linear in the mesh.
struct MeshAdjacency {
  explicit MeshAdjacency(const SurfaceMesh& mesh) : stars(mesh), neighbours(face_neighbours(mesh, stars)) {}

  VertexStars stars;
  std::vector<Triangle> neighbours;
};

// Unit normals; zero for a triangle without area.
std::vector<Vec3> face_normals(const SurfaceMesh& mesh);

// Sums of the area vectors around each vertex, made unit; zero for a vertex without a triangle.
std::vector<Vec3> vertex_normals(const SurfaceMesh& mesh);

// Vertex sets in which no two vertices share a triangle, so that each set can be worked on in parallel with the same
// outcome for any number of threads. Greedy in index order: seven to nine colours on usual meshes.
std::vector<std::vector<std::uint32_t>> colour_vertices(const SurfaceMesh& mesh, const VertexStars& stars);

}  // namespace scan2fea
