// Which faces of a triangle soup meet across which edges, and the mesh made to agree with it: oriented consistently and
// with one fan of faces per vertex. The ground of the repair; after it a mesh is manifold, with or without borders.
//
// A half-edge is 3 f + i: the edge of face f from its corner i to the next.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/repair/repair_result.hpp"

#include <cstdint>
#include <limits>
#include <vector>

namespace scan2fea {

inline constexpr std::uint32_t no_twin = std::numeric_limits<std::uint32_t>::max();

// Per half-edge the one on the other side of its edge, or no_twin on a border.
using Twins = std::vector<std::uint32_t>;

inline std::uint32_t next_halfedge(std::uint32_t h) {
  return h % 3 == 2 ? h - 2 : h + 1;
}
inline std::uint32_t previous_halfedge(std::uint32_t h) {
  return h % 3 == 0 ? h + 2 : h - 1;
}
inline std::uint32_t start_vertex(const SurfaceMesh& mesh, std::uint32_t h) {
  return mesh.triangles[h / 3][h % 3];
}
inline std::uint32_t end_vertex(const SurfaceMesh& mesh, std::uint32_t h) {
  return start_vertex(mesh, next_halfedge(h));
}

// Half-edges grouped by their undirected edge.
class EdgeGroups {
 public:
  explicit EdgeGroups(const SurfaceMesh& mesh);

  // Calls visit(first, last), pointers to the ascending half-edges of an edge, for each edge in a fixed order.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (std::size_t i = 0; i + 1 < start_.size(); ++i)
      visit(&halfedge_[start_[i]], &halfedge_[start_[i]] + (start_[i + 1] - start_[i]));
  }

 private:
  std::vector<std::uint32_t> halfedge_;
  std::vector<std::uint32_t> start_;  // of each edge's half-edges, and the end
};

// Makes the mesh manifold and returns its adjacency: pairs faces at every edge, turns them to agree with their
// neighbours (of each connected part the smaller area is turned), and splits vertices between fans. At an edge of more
// than two faces those are paired that enclose material, so that parts that share only an edge come apart; faces left
// over get a border there. Where a part cannot be oriented (a Moebius strip) it is cut along the edges that show it.
// Faces at an edge that remains non-manifold (a fan that meets an edge twice) are cut out.
// Precondition: no face names a vertex twice. O(n) but for a sort of each vertex's edges. A mesh that is manifold and
// oriented already is left as it is.
Twins make_manifold(SurfaceMesh& mesh, RepairResult& result);

// Gives each fan of faces about a vertex a vertex of its own; the fan of the lowest corner keeps the old one. Returns
// of each vertex appended the one that it copies.
std::vector<std::uint32_t> split_vertices(SurfaceMesh& mesh, const Twins& twins);

// Adjacency of a mesh that is manifold and consistently oriented already (assert).
Twins find_twins(const SurfaceMesh& mesh);

// Half-edges of the faces about a hole, each starting where the next one ends.
using BorderLoop = std::vector<std::uint32_t>;

// Of a manifold mesh, ordered by their lowest half-edge.
std::vector<BorderLoop> find_border_loops(const SurfaceMesh& mesh, const Twins& twins);

}  // namespace scan2fea
