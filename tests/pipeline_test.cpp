// What the whole chain owes the part: its edges come out of it where they were, and thin walls get the elements that
// were asked for.
#include "preproc/pipeline.hpp"

#include "preproc/surface/adjacency.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace scan2fea {
namespace {

using Segment = std::array<Vec3, 2>;

std::vector<Segment> sharp_edges(const SurfaceMesh& mesh) {
  constexpr double cosine = 0.7;  // 45 degrees
  const std::vector<Vec3> normals = face_normals(mesh);
  const std::vector<Triangle> neighbours = face_neighbours(mesh, VertexStars(mesh));
  std::vector<Segment> edges;
  for (std::uint32_t f = 0; f < normals.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t g = neighbours[f][k];
      const Triangle& t = mesh.triangles[f];
      if (g > f && g != no_face && normals[f].dot(normals[g]) < cosine)
        edges.push_back({mesh.vertices[t[(k + 1) % 3]], mesh.vertices[t[(k + 2) % 3]]});
    }
  return edges;
}

double distance(const Vec3& p, const Segment& s) {
  const Vec3 d = s[1] - s[0];
  const double t = std::clamp(d.dot(p - s[0]) / d.squaredNorm(), 0.0, 1.0);
  return (p - s[0] - t * d).norm();
}

double farthest(const std::vector<Segment>& from, const std::vector<Segment>& to) {
  double farthest = 0;
  for (const Segment& s : from)
    for (int i = 0; i <= 4; ++i) {
      const Vec3 p = s[0] + i / 4.0 * (s[1] - s[0]);
      double nearest = 1e9;
      for (const Segment& other : to) nearest = std::min(nearest, distance(p, other));
      farthest = std::max(farthest, nearest);
    }
  return farthest;
}

void expect_edges_to_stay(const SurfaceMesh& part, double edge_length) {
  PipelineOptions options;
  options.simplify->size = MeanEdgeLength{edge_length};
  const PipelineResult result = run_pipeline(part, options);
  ASSERT_TRUE(result.volume_mesh.has_value());
  const std::vector<Segment> before = sharp_edges(part);
  const std::vector<Segment> after = sharp_edges(boundary_surface(*result.volume_mesh));
  ASSERT_FALSE(before.empty());
  const double rounding = 1e-9 * bounding_box(part.vertices).diagonal();
  EXPECT_LE(farthest(before, after), rounding);
  EXPECT_LE(farthest(after, before), rounding);  // and none is new
}

TEST(Pipeline, KeepsTheEdgesOfACantilever) {
  expect_edges_to_stay(analytic::box({100, 24, 20}, 5), 3);
}

TEST(Pipeline, KeepsTheEdgesOfAPlateWithAHole) {
  expect_edges_to_stay(analytic::slab_with_holes(1, 0.125), 0.2);
}

TEST(Pipeline, PutsTwoElementsAcrossAThinWall) {
  constexpr double thickness = 2;
  PipelineOptions options;
  options.simplify->size = MeanEdgeLength{4};
  options.simplify->limits.elements_across = 2;
  const PipelineResult result = run_pipeline(analytic::box({40, 30, thickness}, 2), options);
  ASSERT_TRUE(result.volume_mesh.has_value());
  const TetMesh& mesh = *result.volume_mesh;
  for (const Tetrahedron& t : mesh.tetrahedra) {
    double low = thickness, high = 0;
    for (const std::uint32_t n : t) {
      low = std::min(low, mesh.nodes[n].z());
      high = std::max(high, mesh.nodes[n].z());
    }
    ASSERT_LT(high - low, 0.99 * thickness);  // none reaches from side to side
  }
}

}  // namespace
}  // namespace scan2fea
