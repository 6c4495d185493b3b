#include "preproc/surface/features/feature_curves.hpp"

#include "preproc/surface/features/find_features.hpp"
#include "preproc/surface/kernel/cut_surface.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace scan2fea {
namespace {

std::vector<double> uniform(const SurfaceMesh& mesh, double edge_length) {
  return std::vector<double>(mesh.vertices.size(), edge_length);
}

FeatureCurves trace(const SurfaceMesh& mesh, double edge_length) {
  return trace_feature_curves(mesh.vertices, find_features(mesh).edges, boundary_edges(mesh),
                              uniform(mesh, edge_length));
}

// How often each edge is part of a curve.
std::map<FeatureEdge, int> edges_of(const FeatureCurves& features) {
  std::map<FeatureEdge, int> count;
  for (const FeatureCurve& curve : features.curves) {
    const std::size_t n = curve.vertices.size();
    for (std::size_t i = 0; i + (curve.closed ? 0 : 1) < n; ++i) {
      const auto [low, high] = std::minmax(curve.vertices[i], curve.vertices[(i + 1) % n]);
      ++count[{low, high}];
    }
  }
  return count;
}

TEST(FeatureCurves, ABoxHasTwelveBetweenEightCorners) {
  const SurfaceMesh box = analytic::box({2, 3, 5}, 0.25);
  const FeatureCurves features = trace(box, 0.4);
  EXPECT_EQ(features.curves.size(), 12U);
  EXPECT_EQ(features.corners.size(), 8U);
  for (const FeatureCurve& curve : features.curves) {
    EXPECT_FALSE(curve.closed);
    EXPECT_FALSE(curve.border);
    for (const std::uint32_t end : {curve.vertices.front(), curve.vertices.back()})
      EXPECT_TRUE(std::binary_search(features.corners.begin(), features.corners.end(), end));
  }
}

TEST(FeatureCurves, HoldEachFeatureEdgeOnce) {
  const SurfaceMesh slab = analytic::slab_with_holes(2, 0.25);
  const std::vector<FeatureEdge> sharp = find_features(slab).edges;
  const std::map<FeatureEdge, int> traced =
      edges_of(trace_feature_curves(slab.vertices, sharp, boundary_edges(slab), uniform(slab, 0.3)));
  EXPECT_EQ(traced.size(), sharp.size());
  for (const FeatureEdge& e : sharp) EXPECT_EQ(traced.at(e), 1);
}

TEST(FeatureCurves, ACylinderHasTwoLoopsAndNoCorner) {
  const SurfaceMesh cylinder = analytic::cylinder(1, 3, 60, 20);
  for (const double edge_length : {0.05, 0.3, 1.5, 5.0}) {
    const FeatureCurves features = trace(cylinder, edge_length);
    EXPECT_TRUE(features.corners.empty()) << edge_length;
    ASSERT_EQ(features.curves.size(), 2U);
    for (const FeatureCurve& curve : features.curves) {
      EXPECT_TRUE(curve.closed);
      EXPECT_EQ(curve.vertices.size(), 60U);
    }
  }
}

TEST(FeatureCurves, ASheetHasItsBorderBetweenItsCorners) {
  const SurfaceMesh sheet = analytic::sheet(4, 3, 0.25);
  const FeatureCurves features = trace(sheet, 0.4);
  EXPECT_EQ(features.corners.size(), 4U);
  ASSERT_EQ(features.curves.size(), 4U);
  std::size_t edges = 0;
  for (const FeatureCurve& curve : features.curves) {
    EXPECT_TRUE(curve.border);
    edges += curve.vertices.size() - 1;
  }
  EXPECT_EQ(edges, 2U * (16 + 12));
}

TEST(FeatureCurves, AFoldMeetsTheBorderAtCorners) {
  SurfaceMesh folded = analytic::sheet(4, 3, 0.25);
  for (Vec3& v : folded.vertices) v[2] = -std::abs(v[0] - 2);
  const FeatureCurves features = trace(folded, 0.4);
  EXPECT_EQ(features.corners.size(), 6U);
  EXPECT_EQ(features.curves.size(), 7U);
  EXPECT_EQ(std::count_if(features.curves.begin(), features.curves.end(), [](const auto& c) { return !c.border; }), 1);
}

TEST(FeatureCurves, ACreaseMayEndInsideTheSurface) {
  const SurfaceMesh sheet = analytic::sheet(4, 3, 0.5);
  const std::uint32_t middle = 3 * 9 + 4;  // row 3, column 4
  const std::vector<FeatureEdge> dangling{{middle - 2, middle - 1}, {middle - 1, middle}};
  const FeatureCurves features =
      trace_feature_curves(sheet.vertices, dangling, boundary_edges(sheet), uniform(sheet, 0.5));
  EXPECT_EQ(features.corners.size(), 6U);
  const auto crease = std::find_if(features.curves.begin(), features.curves.end(), [](auto& c) { return !c.border; });
  ASSERT_NE(crease, features.curves.end());
  EXPECT_EQ(crease->vertices, (std::vector<std::uint32_t>{middle - 2, middle - 1, middle}));
}

TEST(FeatureCurves, ALoopWithOneCornerBeginsAndEndsThere) {
  // A disc whose rim is drawn out to a tip: only there does it turn sharply.
  const int n = 60;
  SurfaceMesh disc;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    disc.vertices.emplace_back(i == 0 ? 2 : std::cos(a), std::sin(a), 0);
  }
  for (int i = 1; i < 10; ++i)  // straight flanks from the tip to the circle
    for (const int k : {i, n - i}) {
      const double t = i / 10.0;
      const double a = 2 * std::numbers::pi * (k < n / 2 ? 10 : n - 10) / n;
      disc.vertices[static_cast<std::size_t>(k)] = (1 - t) * Vec3(2, 0, 0) + t * Vec3(std::cos(a), std::sin(a), 0);
    }
  disc.vertices.emplace_back(0, 0, 0);
  for (std::uint32_t i = 0; i < n; ++i) disc.triangles.push_back({n, i, (i + 1) % n});
  const FeatureCurves features = trace_feature_curves(disc.vertices, {}, boundary_edges(disc), uniform(disc, 0.2));
  EXPECT_EQ(features.corners, std::vector<std::uint32_t>{0});
  ASSERT_EQ(features.curves.size(), 1U);
  EXPECT_FALSE(features.curves[0].closed);
  EXPECT_EQ(features.curves[0].vertices.front(), 0U);
  EXPECT_EQ(features.curves[0].vertices.back(), 0U);
  EXPECT_EQ(features.curves[0].vertices.size(), static_cast<std::size_t>(n) + 1);
}

TEST(FeatureCurves, AJaggedBorderHasNoCornersWhereItIsStraight) {
  // The rim at y = 0 zigzags by 60 degrees from vertex to vertex; edges are six times as long. Also with the rim's
  // edges halved, which bends it at every other vertex only.
  for (const std::size_t period : {2U, 4U}) {
    SurfaceMesh sheet = analytic::sheet(8, 3, 0.2 / static_cast<double>(period));
    const std::size_t n = 40 * period;
    for (std::size_t i = 0; i <= n; ++i) {
      const std::size_t from_valley = std::min(i % period, period - i % period);
      sheet.vertices[i][1] = 0.058 * static_cast<double>(2 * from_valley) / static_cast<double>(period);
    }
    const FeatureCurves features = trace_feature_curves(sheet.vertices, {}, boundary_edges(sheet), uniform(sheet, 0.6));
    EXPECT_EQ(features.corners.size(), 4U) << period;
  }
}

TEST(FeatureCurves, CornersStandOutOfFinePolylines) {
  // A turn of 45 degrees amid edges a tenth of the wanted length.
  SurfaceMesh sheet = analytic::sheet(8, 3, 0.05);
  for (Vec3& v : sheet.vertices) v[1] += std::max(0.0, v[0] - 4);
  EXPECT_EQ(trace_feature_curves(sheet.vertices, {}, boundary_edges(sheet), uniform(sheet, 0.5)).corners.size(), 6U);
}

}  // namespace
}  // namespace scan2fea
