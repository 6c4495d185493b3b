// How far a point is from a closed surface, and on which side.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "quality/triangle_tree.hpp"

#include <array>
#include <vector>

namespace scan2fea {

// Signs by angle-weighted pseudonormals: of the nearest point's face, edge or vertex. Source: Baerentzen and Aanaes,
// "Signed distance computation using the angle weighted pseudonormal", 2005. Exact in principle for a closed surface
// free of self-intersections, cavities and separate bodies included; rounding can turn the sign only of points that lie
// on the surface within rounding.
class InsideTest {
 public:
  // The surface must outlive the test. O(n log n).
  explicit InsideTest(const SurfaceMesh& surface);

  struct Answer {
    double distance;
    bool inside;
    std::uint32_t triangle;  // the nearest
  };
  // About O(log n); faster where `hint`, a triangle, is near.
  Answer operator()(const Vec3& p, std::uint32_t hint = 0) const;

  // Of all triangles of the surface.
  const TriangleTree& tree() const { return tree_; }

 private:
  const SurfaceMesh& surface_;
  TriangleTree tree_;
  std::vector<std::array<Vec3, 3>> edge_normals_;  // of the edge opposite each corner of a triangle; any length
  std::vector<Vec3> vertex_normals_;
};

}  // namespace scan2fea
