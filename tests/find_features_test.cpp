#include "preproc/surface/features/find_features.hpp"

#include "preproc/mesh/read_surface.hpp"
#include "preproc/surface/features/scan_noise.hpp"
#include "quality/triangle_measures.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/scans.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

double total_length(const SurfaceMesh& mesh, const std::vector<FeatureEdge>& edges) {
  double sum = 0;
  for (const FeatureEdge& e : edges) sum += (mesh.vertices[e[0]] - mesh.vertices[e[1]]).norm();
  return sum;
}

// Two rectangles of 10 x 10 that meet along y at an angle, each normal turned by half of `angle_deg(y)`.
template <class Angle>
SurfaceMesh roof(double edge_length, Angle angle_deg) {
  SurfaceMesh mesh = analytic::sheet(20, 10, edge_length);
  for (Vec3& v : mesh.vertices) {
    const double half = angle_deg(v[1]) * std::numbers::pi / 360;
    v[0] -= 10;
    v[2] = -std::abs(v[0]) * std::tan(half);
  }
  return mesh;
}

// Of the edges of `clean`, those that are in `found`; and of `found`, those that are not in `clean`.
struct Agreement {
  double found;
  double wrong;
};
Agreement compare(const std::vector<FeatureEdge>& clean, const std::vector<FeatureEdge>& found) {
  std::vector<FeatureEdge> both;
  std::set_intersection(clean.begin(), clean.end(), found.begin(), found.end(), std::back_inserter(both));
  const auto n = static_cast<double>(both.size());
  return {n / static_cast<double>(clean.size()), 1 - n / static_cast<double>(found.size())};
}

TEST(FindFeatures, OfABoxAreItsTwelveEdges) {
  for (const double edge_length : {0.25, 100.0}) {
    const SurfaceMesh box = analytic::box({2, 3, 5}, edge_length);
    const Features features = find_features(box);
    EXPECT_NEAR(total_length(box, features.edges), 4 * (2 + 3 + 5), 1e-12);
    EXPECT_TRUE(std::is_sorted(features.edges.begin(), features.edges.end()));
    EXPECT_LT(features.noise, 1e-12);
  }
}

TEST(FindFeatures, OfACylinderAreItsRims) {
  const SurfaceMesh cylinder = analytic::cylinder(1, 3, 60, 20);
  const Features features = find_features(cylinder);
  EXPECT_EQ(features.edges.size(), 120U);
  for (const FeatureEdge& e : features.edges) EXPECT_EQ(cylinder.vertices[e[0]][2], cylinder.vertices[e[1]][2]);
}

TEST(FindFeatures, FacetsThatTouchAChainDoNotContinueIt) {
  // 30 degrees from facet to facet: above the limit of continuations.
  const SurfaceMesh prism = analytic::cylinder(1, 3, 12, 6);
  EXPECT_EQ(find_features(prism).edges.size(), 24U);
  EXPECT_GT(find_features(prism, {.angle_deg = 25}).edges.size(), 24U + 12 * 6 - 1);
}

TEST(FindFeatures, OfASphereAreNone) {
  EXPECT_TRUE(find_features(analytic::sphere(1, 4)).edges.empty());
}

TEST(FindFeatures, AreNoneWithoutAnAngle) {
  EXPECT_TRUE(find_features(analytic::box({1, 1, 1}, 0.1), {.angle_deg = std::nullopt}).edges.empty());
}

TEST(FindFeatures, TheAngleIsTheLimit) {
  const SurfaceMesh below = roof(0.5, [](double) { return 39; }), above = roof(0.5, [](double) { return 41; });
  EXPECT_TRUE(find_features(below).edges.empty());
  EXPECT_NEAR(total_length(above, find_features(above).edges), 10, 1e-9);
}

TEST(FindFeatures, WeakerEdgesContinueAChain) {
  // 60 degrees at y = 0 that fade to none at y = 10: 40 degrees are reached at 3.33, 20 at 6.67.
  const SurfaceMesh fading = roof(0.25, [](double y) { return 60 - 6 * y; });
  const Features features = find_features(fading);
  double end = 0;
  for (const FeatureEdge& e : features.edges) {
    EXPECT_NEAR(fading.vertices[e[0]][0], 0, 1e-12);
    end = std::max(end, fading.vertices[e[1]][1]);
  }
  EXPECT_NEAR(end, 20 / 3.0, 0.5);
}

TEST(FindFeatures, ChainsThatEndFreelyAndAreShortAreDropped) {
  // A dent of one vertex's height in a plane, and a ridge across most of it.
  SurfaceMesh ridge = analytic::sheet(20, 10, 0.5);
  for (Vec3& v : ridge.vertices) {
    if (std::abs(v[0] - 5) < 1e-9 && std::abs(v[1] - 5) < 0.3) v[2] = 0.01;
    if (v[1] > 2 && v[1] < 8) v[2] += std::max(0.0, 1 - std::abs(v[0] - 10));
  }
  for (const FeatureEdge& e : find_features(ridge).edges) EXPECT_GT(ridge.vertices[e[0]][0], 8.5);
}

TEST(FindFeatures, RimsOfSmallHolesStayOnACleanPart) {
  // A hole of 1 x 1 through a plate, in a part of 300: its rims are 1.3 % of the diagonal.
  SurfaceMesh part = analytic::join(analytic::slab_with_holes(1, 0.25), analytic::box({1, 1, 1}, 1));
  for (std::size_t v = part.vertices.size() - 8; v < part.vertices.size(); ++v) part.vertices[v] += Vec3(300, 0, 0);
  const double outer = 4 * (3 + 3 + 1), hole = 4 * (1 + 1 + 1), cube = 12;
  EXPECT_NEAR(total_length(part, find_features(part).edges), outer + hole + cube, 1e-9);
}

TEST(FindFeatures, ChainsMayEndOnTheBorder) {
  const SurfaceMesh folded = roof(0.5, [](double) { return 90; });
  EXPECT_NEAR(total_length(folded, find_features(folded, {.shortest_chain_of_diagonal = 0.9}).edges), 10, 1e-9);
}

TEST(FindFeatures, NoiseIsMeasured) {
  const SurfaceMesh smooth = analytic::torus(3, 1, 120, 60), box = analytic::box({3, 3, 3}, 0.15);
  for (const SurfaceMesh& mesh : {smooth, box})
    for (const double sigma : {0.002, 0.01}) {
      const double noise = find_features(analytic::noisy(mesh, sigma, 1)).noise;
      EXPECT_NEAR(noise, sigma, 0.2 * sigma);
    }
}

TEST(IndependentNoise, IsMeasuredOnWhatIsSmoothAndOnAPart) {
  for (const SurfaceMesh& mesh : {analytic::torus(3, 1, 120, 60), analytic::box({3, 3, 3}, 0.1)})
    for (const double sigma : {0.003, 0.01}) {
      const SurfaceMesh noisy = analytic::noisy(mesh, sigma, 1);
      EXPECT_NEAR(estimate_independent_noise(noisy, VertexStars(noisy)), sigma, 0.3 * sigma);
    }
}

// Waves of six edges, and facets: residuals from quadrics as large as those of noise.
TEST(IndependentNoise, IsNoneOfWavesAndFacets) {
  SurfaceMesh wavy = analytic::torus(3, 1, 180, 60);
  for (Vec3& p : wavy.vertices) {
    const Vec3 ring = 3 * Vec3(p.x(), p.y(), 0).normalized();
    p += 0.02 * std::sin(30 * std::atan2(p.y(), p.x())) * (p - ring);
  }
  EXPECT_GT(estimate_noise(wavy, MeshAdjacency(wavy)), 0.001);
  for (const SurfaceMesh& mesh :
       {wavy, analytic::sphere(1, 2), analytic::torus(3, 1, 20, 10), analytic::cylinder(1, 3, 24, 6)})
    EXPECT_LT(estimate_independent_noise(mesh, VertexStars(mesh)), 1e-4);
}

TEST(FindFeatures, CoarsePartsAreNotNoisy) {
  // Creases are everywhere, and no quadric fits anywhere.
  for (const SurfaceMesh& part : {analytic::cylinder(1, 3, 12, 1), analytic::cylinder(1, 0.1, 16, 1),
                                  analytic::slab_with_holes(2, 1), analytic::box({1, 2, 3}, 1)})
    EXPECT_LT(find_features(part).noise, 1e-12);
}

TEST(FindFeatures, NoiseIsNotTakenForFeatures) {
  // The mean edge is 0.12: faces are tilted by up to 25 degrees.
  const SurfaceMesh noisy = analytic::noisy(analytic::torus(3, 1, 180, 60), 0.01, 1);
  EXPECT_TRUE(find_features(noisy).edges.empty());
}

TEST(FindFeatures, OfABoxAreFoundUnderNoise) {
  const SurfaceMesh box = analytic::box({3, 4, 5}, 0.15);
  const std::vector<FeatureEdge> clean = find_features(box).edges;
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Features features = find_features(analytic::noisy(box, 0.01, seed));
    const Agreement agreement = compare(clean, features.edges);
    EXPECT_GT(agreement.found, 0.99);
    EXPECT_LT(agreement.wrong, 0.01);
  }
}

TEST(FindFeatures, OfFandiskAreFoundUnderNoise) {
  const SurfaceMesh fandisk = read_surface(scan("fandisk.off"));
  const double diagonal = bounding_box(fandisk.vertices).diagonal();
  const std::vector<FeatureEdge> clean = find_features(fandisk).edges;
  for (const double noise : {0.0005, 0.001})
    for (const unsigned seed : {1U, 2U, 3U}) {
      const Features features = find_features(analytic::noisy(fandisk, noise * diagonal, seed));
      const Agreement agreement = compare(clean, features.edges);
      EXPECT_GT(agreement.found, 0.95);
      EXPECT_LT(agreement.wrong, 0.005);
      EXPECT_NEAR(features.noise, noise * diagonal, 0.2 * noise * diagonal);
    }
}

}  // namespace
}  // namespace scan2fea
