// What the whole chain owes the part: its edges come out of it where they were, and thin walls get the elements that
// were asked for.
#include "preproc/pipeline.hpp"

#include "preproc/made_up.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "quality/self_intersections.hpp"
#include "quality/tetrahedron_measures.hpp"
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

// Four-sided spikes on the faces of a cube: a crease runs straight on along every ridge, over two sides of a face if
// that is let.
SurfaceMesh star() {
  SurfaceMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertices.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  for (std::uint32_t axis = 0; axis < 3; ++axis)
    for (const std::uint32_t side : {0U, 1U}) {
      const std::uint32_t x = 1U << axis, y = 1U << (axis + 1) % 3, z = 1U << (axis + 2) % 3;
      std::array<std::uint32_t, 4> around{side * x, side * x + y, side * x + y + z, side * x + z};
      if (side == 0) std::reverse(around.begin(), around.end());
      const auto tip = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back((side == 0 ? -4 : 4) * Vec3::Unit(axis));
      for (std::size_t k = 0; k < 4; ++k) mesh.triangles.push_back({around[k], around[(k + 1) % 4], tip});
    }
  return mesh;
}

TEST(Pipeline, MeshesASpikyPartWell) {
  PipelineOptions options;
  options.simplify->size = FaceRatio{0.5};
  const PipelineResult result = run_pipeline(star(), options);
  ASSERT_TRUE(result.volume_mesh.has_value());
  EXPECT_GT(measure_tetrahedra(*result.volume_mesh).min_dihedral_deg, 24);
}

// Two elements side by side at the rim have half its angle, 20 degrees: one must fill it wherever the lattice has set a
// vertex into the wedge.
// Wherever it lies, in whatever order its vertices and triangles are given and whichever way they face.
TEST(Pipeline, ThePartsMeshIsItsOwn) {
  const SurfaceMesh cube = analytic::box({20, 20, 20}, 5);
  const std::vector<SurfaceMesh> parts = {
      analytic::box({60, 40, 8}, 4), analytic::join(cube, analytic::moved(cube, {20, 0, 0})),
      analytic::cylinder(5, 20, 72, 10), analytic::noisy(analytic::torus(20, 6, 32, 16), 0.05, 3)};
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const PipelineResult first = run_pipeline(parts[part]);
    for (unsigned seed = 1; seed <= 2; ++seed) {
      const PipelineResult other = run_pipeline(analytic::elsewhere(parts[part], seed, 0.2));
      EXPECT_EQ(other.surface.triangles, first.surface.triangles) << "part " << part << ", placement " << seed;
      EXPECT_EQ(other.volume_mesh->tetrahedra, first.volume_mesh->tetrahedra) << "part " << part;
    }
  }
}

TEST(Pipeline, FillsAKnifeEdgeWithOneElementAcross) {
  PipelineOptions options;
  options.simplify->size = FaceRatio{0.3};
  const PipelineResult result = run_pipeline(analytic::lens(40, 96, 24), options);
  ASSERT_TRUE(result.volume_mesh.has_value());
  EXPECT_GT(measure_tetrahedra(*result.volume_mesh).min_dihedral_deg, 24);
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

// Whatever the moment at which there is no time for improvements any more.
TEST(Pipeline, WithoutTimeForImprovementsTheMeshIsValidAndItIsTold) {
  const SurfaceMesh scan = analytic::noisy(analytic::sphere(1, 5), 0.004, 1);
  PipelineOptions options;
  options.simplify->effort = Effort::high;  // which has more to leave out
  for (const int milliseconds : {0, 100, 300}) {
    const auto end = Progress::Clock::now() + std::chrono::milliseconds(milliseconds);
    const PipelineResult result =
        run_pipeline(scan, options, Progress().until(Progress::Clock::time_point::max(), end));
    ASSERT_TRUE(result.volume_mesh);
    EXPECT_EQ(measure_tetrahedra(*result.volume_mesh).inverted, 0u);
    EXPECT_EQ(result.volume_mesh->boundary.size(), result.surface.triangles.size());
    EXPECT_NEAR(total_volume(*result.volume_mesh), enclosed_volume(scan), 1e-9);
    EXPECT_TRUE(find_self_intersections(result.surface).empty());
    EXPECT_TRUE(milliseconds > 0 || !result.left_out.empty());
  }
}

TEST(Pipeline, WithoutTimeForAMeshThereIsNone) {
  const auto end = Progress::Clock::now();
  EXPECT_THROW(run_pipeline(analytic::sphere(1, 3), {}, Progress().until(end)), OutOfTime);
}

TEST(Pipeline, WhatNoScannerSawIsASetOfItsOwn) {
  // A box that was seen but for a square of 3 x 3 in the middle of its top.
  const Vec3 size(12, 9, 6);
  SurfaceMesh scan = analytic::box(size, 1);
  const auto is_missing = [&](const Vec3& p) {
    return p.z() > size.z() - 1e-9 && p.x() > 5 && p.x() < 8 && p.y() > 3 && p.y() < 6;
  };
  std::erase_if(scan.triangles, [&](const Triangle& t) { return is_missing(centroid(scan, t)); });
  PipelineOptions options;
  options.simplify->size = FaceCount{2000};
  const PipelineResult result = run_pipeline(scan, options);
  ASSERT_EQ(result.face_sets.size(), 1U);
  const NamedSet& filled = result.face_sets.front();
  EXPECT_EQ(filled.name, filled_set);
  double area = 0;
  for (const std::uint32_t f : filled.members) {
    const Triangle& t = result.surface.triangles[f];
    const Vec3 middle = centroid(result.surface, t);
    EXPECT_TRUE(is_missing(middle)) << middle.transpose();
    area += area_vector(result.surface, t).norm() / 2;
  }
  EXPECT_NEAR(area, 9, 3) << "up to half a triangle along the border";
  ASSERT_EQ(result.volume_mesh->face_sets.size(), 1U);
  EXPECT_EQ(result.volume_mesh->face_sets.front().members.size(), filled.members.size());
  EXPECT_TRUE(run_pipeline(analytic::box(size, 1), options).face_sets.empty());
}

TEST(Pipeline, SaysThatNothingIsOpenToBeThickened) {
  PipelineOptions options;
  options.simplify.reset();
  options.tetrahedralize.reset();
  options.repair = RepairOptions{.thickness = Thickness{0.1, ThickenTo::both}};
  const PipelineResult result = run_pipeline(analytic::box({1, 1, 1}, 0.5), options);
  ASSERT_EQ(result.stages.size(), 1U);
  EXPECT_EQ(result.stages[0].remarks, std::vector<std::string>{"nothing was thickened: no sheet is open"});
}

// Where few triangles cannot be well shaped, no more are made than where nobody asks for a number.
TEST(Pipeline, FewTrianglesOfASlenderPartAreNoMoreThanTheDefaultMakes) {
  for (const SurfaceMesh& part :
       {analytic::box({200, 1, 1}, 200), analytic::cylinder(0.5, 100, 24, 1), analytic::box({120, 6, 0.5}, 200)}) {
    PipelineOptions options;
    options.tetrahedralize.reset();
    const std::size_t by_default = run_pipeline(part, options).surface.triangles.size();
    options.simplify->size = FaceCount{100};
    const std::size_t few = run_pipeline(part, options).surface.triangles.size();
    EXPECT_LE(few, std::max<std::size_t>(by_default, 100));
  }
}

}  // namespace
}  // namespace scan2fea
