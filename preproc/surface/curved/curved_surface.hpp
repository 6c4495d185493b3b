// A surface of six-node triangles: straight corners, and a node near the middle of every edge.
#pragma once

#include "preproc/mesh/six_node_triangle.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace scan2fea {

struct CurvedSurface {
  SurfaceMesh corners;
  std::vector<FeatureEdge> edges;     // sorted
  std::vector<Vec3> mid;              // one per edge
  std::vector<Triangle> mid_of_face;  // per triangle the edges 12, 23, 31

  // Of straight edges. O(n log n).
  explicit CurvedSurface(SurfaceMesh surface);
  CurvedSurface() = default;

  SixNodeTriangle triangle(std::size_t face) const;
  // Corners first, then the nodes of the edges: the numbers that the fit works with.
  std::size_t nodes() const { return corners.vertices.size() + mid.size(); }
  std::array<std::size_t, 6> nodes_of(std::size_t face) const;
  Vec3& node(std::size_t i) {
    return i < corners.vertices.size() ? corners.vertices[i] : mid[i - corners.vertices.size()];
  }
  const Vec3& node(std::size_t i) const {
    return i < corners.vertices.size() ? corners.vertices[i] : mid[i - corners.vertices.size()];
  }
  // The number of an edge that there is.
  std::size_t edge(const FeatureEdge& ends) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(edges, ends) - edges.begin());
  }
  // Half-way between the ends of an edge.
  Vec3 middle(std::size_t edge) const;
};

// Enclosed by these faces of a closed surface, about `centre`; exact, by a rule of degree four.
double curved_volume(const CurvedSurface& surface, const std::vector<std::uint32_t>& faces, const Vec3& centre);

// Adds its derivative by the place of each node.
void add_volume_gradient(const CurvedSurface& surface, const std::vector<std::uint32_t>& faces,
                         std::vector<Vec3>& gradient);

// Each triangle as four plane ones: what stands for the surface where it is asked for neighbours and crossings.
// Vertices are numbered as the nodes are; triangles 4 f to 4 f + 3 are of face f, at its three corners and in its
// middle.
SurfaceMesh in_four(const CurvedSurface& surface);

// The place on a face of a place on one of its four.
std::array<double, 3> in_whole(std::size_t quarter, const std::array<double, 3>& barycentric);

}  // namespace scan2fea
