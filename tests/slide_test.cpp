// Nodes of the surface that slide along the scan where that makes better tetrahedra.
#include "preproc/pipeline.hpp"
#include "preproc/surface/repair/solid_volume.hpp"
#include "quality/self_intersections.hpp"
#include "quality/tetrahedron_measures.hpp"
#include "quality/triangle_tree.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/error_from.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace scan2fea {
namespace {

constexpr double most = 0.02;

// A ball that is dented all over, so that a few of its elements are squeezed.
SurfaceMesh dented_ball() {
  SurfaceMesh ball = analytic::sphere(1, 5);
  for (Vec3& p : ball.vertices) p *= 1 + 0.06 * std::sin(5 * p.x()) * std::sin(4 * p.y() + 1) * std::cos(3 * p.z());
  return ball;
}

// A round rod with a flat end on both sides: two planes, two round creases, and what is round.
SurfaceMesh rod() {
  return analytic::cylinder(0.5, 1.5, 96, 40);
}

PipelineResult made_of(const SurfaceMesh& scan, std::size_t faces, bool slides) {
  PipelineOptions options;
  options.simplify->size = FaceCount{faces};
  if (slides) options.slide = SlideOptions{.distance = most};
  return run_pipeline(scan, options);
}

const StageRecord* stage_of(const PipelineResult& result, const std::string& name) {
  const auto found = std::ranges::find(result.stages, name, &StageRecord::name);
  return found == result.stages.end() ? nullptr : &*found;
}

double largest_move(const PipelineResult& from, const PipelineResult& to) {
  double largest = 0;
  for (std::size_t v = 0; v < from.surface.vertices.size(); ++v)
    largest = std::max(largest, (from.surface.vertices[v] - to.surface.vertices[v]).norm());
  return largest;
}

class Slide : public testing::TestWithParam<SurfaceMesh (*)()> {};

TEST_P(Slide, LiftsTheWorstElementsAndStaysOnTheScan) {
  const SurfaceMesh scan = GetParam()();
  const PipelineResult kept = made_of(scan, 1500, false), slid = made_of(scan, 1500, true);
  ASSERT_EQ(kept.surface.triangles, slid.surface.triangles);
  EXPECT_GT(largest_move(kept, slid), 0);
  EXPECT_LE(largest_move(kept, slid), most);

  const TetSummary before = measure_tetrahedra(*kept.volume_mesh), after = measure_tetrahedra(*slid.volume_mesh);
  EXPECT_EQ(after.inverted, 0U);
  EXPECT_GT(after.min_dihedral_deg, std::max(34.0, before.min_dihedral_deg));
  EXPECT_LT(after.max_dihedral_deg, std::min(129.0, before.max_dihedral_deg));

  EXPECT_TRUE(find_self_intersections(slid.surface).empty());
  EXPECT_NEAR(enclosed_volume(slid.surface), enclosed_volume(scan), 1e-9 * enclosed_volume(scan));
  EXPECT_NEAR(total_volume(*slid.volume_mesh), enclosed_volume(slid.surface), 1e-9);
  for (std::size_t v = 0; v < slid.surface.vertices.size(); ++v)
    ASSERT_EQ(slid.surface.vertices[v], slid.volume_mesh->nodes[v]) << v;

  const TriangleTree tree(scan);
  double squared_before = 0, squared_after = 0;
  for (std::size_t v = 0; v < slid.surface.vertices.size(); ++v) {
    squared_before += tree.closest(kept.surface.vertices[v]).squared_distance;
    squared_after += tree.closest(slid.surface.vertices[v]).squared_distance;
  }
  EXPECT_LT(squared_after, 1.1 * squared_before);
}

INSTANTIATE_TEST_SUITE_P(Of, Slide, testing::Values(&dented_ball, &rod));

// What is plane stays plane, and creases run where the scan has them.
TEST(SlideOfParts, StaysInPlanesAndOnCreases) {
  const SurfaceMesh scan = rod();
  const PipelineResult kept = made_of(scan, 1500, false), slid = made_of(scan, 1500, true);
  std::vector<bool> on_crease(slid.surface.vertices.size(), false);
  for (const FeatureEdge& edge : slid.line_edges)
    for (const std::uint32_t v : edge) on_crease[v] = true;
  std::size_t in_planes = 0, creases_moved = 0;
  for (std::size_t v = 0; v < slid.surface.vertices.size(); ++v) {
    const Vec3 &from = kept.surface.vertices[v], &to = slid.surface.vertices[v];
    for (const double z : {0.0, 1.5}) {
      if (std::abs(from.z() - z) > 1e-9) continue;
      EXPECT_NEAR(to.z(), z, 1e-9);
      ++in_planes;
      if (!on_crease[v]) continue;
      // Of the scan's polygon of 96 sides.
      EXPECT_LE(to.head<2>().norm(), 0.5 + 1e-3);
      EXPECT_GE(to.head<2>().norm(), 0.5 * std::cos(M_PI / 96) - 1e-3);
      creases_moved += (to - from).norm() > 1e-6 ? 1 : 0;
    }
  }
  EXPECT_GT(in_planes, 100U);
  EXPECT_GT(creases_moved, 0U);
}

// A cube's edges are straight and its corners are where they are, to the last bits.
TEST(SlideOfParts, LeavesTheCornersOfABox) {
  const SurfaceMesh scan = analytic::box({1, 1, 1}, 0.05);
  const PipelineResult slid = made_of(scan, 600, true);
  std::size_t corners = 0;
  for (const Vec3& p : slid.surface.vertices) {
    const Vec3 beside = p.cwiseMin(Vec3::Ones() - p).cwiseAbs();
    EXPECT_LT(beside.minCoeff(), 1e-12) << p.transpose();
    corners += beside.maxCoeff() < 1e-12 ? 1 : 0;
  }
  EXPECT_EQ(corners, 8U);
}

TEST(SlideStage, TellsWhatItDid) {
  const PipelineResult kept = made_of(dented_ball(), 1500, false), slid = made_of(dented_ball(), 1500, true);
  EXPECT_EQ(stage_of(kept, "slide"), nullptr);
  const StageRecord* stage = stage_of(slid, "slide");
  ASSERT_NE(stage, nullptr);
  const auto figure = [&](const std::string& name) {
    const auto found = std::ranges::find(stage->changes, name, [](const auto& change) { return change.first; });
    return found == stage->changes.end() ? -1 : found->second;
  };
  EXPECT_NEAR(figure("most"), most, 1e-12);
  EXPECT_NEAR(figure("largest_move"), largest_move(kept, slid), 1e-9);
  EXPECT_NEAR(figure("min_dihedral_before_deg"), measure_tetrahedra(*kept.volume_mesh).min_dihedral_deg, 1e-6);
  EXPECT_NEAR(figure("min_dihedral_after_deg"), measure_tetrahedra(*slid.volume_mesh).min_dihedral_deg, 1e-6);
}

TEST(SlideStage, IsTheSameForAnyNumberOfThreads) {
  const PipelineResult many = made_of(dented_ball(), 1500, true);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const PipelineResult alone = made_of(dented_ball(), 1500, true);
  EXPECT_EQ(many.volume_mesh->nodes, alone.volume_mesh->nodes);
  EXPECT_EQ(many.volume_mesh->tetrahedra, alone.volume_mesh->tetrahedra);
}

// A bound that was asked for comes first: what would lose it stays, and the rest slides.
TEST(SlideStage, KeepsADeviationThatWasAskedFor) {
  PipelineOptions options;
  const double bound = 0.01;
  options.simplify->size = LargestDeviation{.distance = bound};
  options.slide = SlideOptions{.distance = 0.1};
  const PipelineResult slid = run_pipeline(dented_ball(), options);
  const StageRecord* stage = stage_of(slid, "slide");
  ASSERT_NE(stage, nullptr);
  EXPECT_GT(stage->changes.front().second, 0) << "vertices moved";
  const TriangleTree of_scan(dented_ball()), of_surface(slid.surface);
  for (const Vec3& p : slid.surface.vertices) ASSERT_LE(of_scan.closest(p).squared_distance, bound * bound);
  for (const Vec3& p : slid.scan.vertices) ASSERT_LE(of_surface.closest(p).squared_distance, bound * bound);
}

TEST(SlideStage, IsOfWholePartsAndFirstOrder) {
  for (const bool is_half : {true, false}) {
    PipelineOptions options;
    options.slide = SlideOptions{.distance = most};
    if (is_half)
      options.symmetry = SymmetryOptions{};
    else
      options.order = 2;
    const WrongUsage error = error_from<WrongUsage>([&] { run_pipeline(rod(), options); });
    EXPECT_NE(std::string(error.what()).find(is_half ? "--symmetry" : "--order"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace scan2fea
