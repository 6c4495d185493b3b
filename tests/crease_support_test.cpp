#include "preproc/surface/features/crease_support.hpp"

#include "preproc/mesh/read_surface.hpp"
#include "preproc/surface/features/find_features.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/scans.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

double total_length(const SurfaceMesh& mesh, const std::vector<FeatureEdge>& edges) {
  double sum = 0;
  for (const FeatureEdge& e : edges) sum += (mesh.vertices[e[0]] - mesh.vertices[e[1]]).norm();
  return sum;
}

std::size_t dropped_edges(const Features& features) {
  std::size_t edges = 0;
  for (const UnsupportedCreases& dropped : features.dropped) edges += dropped.edges;
  return edges;
}

struct ProfilePoint {
  double radius, height;
};

// A body of revolution about z: rings of `around` vertices, each turned by half a facet against the last, and a vertex
// at both ends of the profile, which goes from top to bottom.
SurfaceMesh revolved(const std::vector<ProfilePoint>& profile, std::uint32_t around) {
  SurfaceMesh mesh;
  for (std::size_t ring = 0; ring < profile.size(); ++ring)
    for (std::uint32_t i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * (i + static_cast<double>(ring % 2) / 2) / around;
      mesh.vertices.emplace_back(profile[ring].radius * std::cos(angle), profile[ring].radius * std::sin(angle),
                                 profile[ring].height);
    }
  const auto top = static_cast<std::uint32_t>(mesh.vertices.size()), bottom = top + 1;
  mesh.vertices.emplace_back(0, 0, profile.front().height);
  mesh.vertices.emplace_back(0, 0, profile.back().height);
  const auto last = static_cast<std::uint32_t>(profile.size() - 1) * around;
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t j = (i + 1) % around;
    mesh.triangles.push_back({top, i, j});
    mesh.triangles.push_back({bottom, last + j, last + i});
    for (std::uint32_t ring = 0; ring + 1 < profile.size(); ++ring) {
      const std::uint32_t a = ring * around, b = a + around;
      if (ring % 2 == 0)
        mesh.triangles.insert(mesh.triangles.end(), {{a + i, b + i, a + j}, {a + j, b + i, b + j}});
      else
        mesh.triangles.insert(mesh.triangles.end(), {{a + i, b + j, a + j}, {a + i, b + i, b + j}});
    }
  }
  return mesh;
}

// A ball whose radius waves as an organic scan's, with folds that no edges follow.
SurfaceMesh crumpled(double height, int levels) {
  SurfaceMesh mesh = analytic::sphere(1, levels);
  for (Vec3& v : mesh.vertices)
    v *= 1 + height * std::sin(9 * v[0] + 1) * std::sin(8 * v[1] + 2) * std::sin(7 * v[2] + 3);
  return mesh;
}

TEST(CreaseSupport, CoarseRoundBodiesHaveNone) {
  for (const double stretch : {1.0, 2.0, 4.0}) {
    SurfaceMesh ellipsoid = analytic::sphere(1, 2);
    for (Vec3& v : ellipsoid.vertices) v[2] *= stretch;
    EXPECT_TRUE(find_features(ellipsoid).edges.empty()) << stretch;
  }
  EXPECT_TRUE(find_features(analytic::sphere(1, 1)).edges.empty());
}

TEST(CreaseSupport, FoldsOfACrumpledBodyAreNone) {
  for (const int levels : {3, 4, 5}) {
    const Features features = find_features(crumpled(0.45, levels));
    EXPECT_GT(dropped_edges(features), 20U) << levels;
    EXPECT_LT(features.edges.size(), dropped_edges(features) / 20) << levels;
  }
}

TEST(CreaseSupport, TheRimOfACutBodyStays) {
  // A ball of radius 1 cut at a height of 0.4, and the disc.
  std::vector<ProfilePoint> profile;
  const double rim = std::sqrt(1 - 0.4 * 0.4), lowest = std::acos(0.4);
  for (int i = 1; i <= 6; ++i) profile.push_back({rim * i / 6, 0.4});
  for (int i = 1; i < 16; ++i) {
    const double angle = lowest + (std::numbers::pi - lowest) * i / 16;
    profile.push_back({std::sin(angle), std::cos(angle)});
  }
  const SurfaceMesh cut = revolved(profile, 40);
  for (const double noise : {0.0, 0.002, 0.004}) {  // 0.08 and 0.16 % of the diagonal
    const SurfaceMesh scan = analytic::noisy(cut, noise, 1);
    const Features features = find_features(scan);
    EXPECT_NEAR(total_length(scan, features.edges), 80 * rim * std::sin(std::numbers::pi / 40), 0.02) << noise;
  }
}

TEST(CreaseSupport, ACrumpledBodyKeepsTheRimOfItsCut) {
  std::vector<ProfilePoint> profile;
  for (int i = 1; i <= 12; ++i) profile.push_back({0.9 * i / 12, 0.4});
  for (int i = 1; i < 30; ++i) {
    const double angle = 1.15 + (std::numbers::pi - 1.15) * i / 30;
    profile.push_back({std::sin(angle), std::cos(angle)});
  }
  SurfaceMesh mesh = revolved(profile, 80);
  for (Vec3& v : mesh.vertices) {
    const double wave = std::sin(14 * v[0] + 1) * std::sin(13 * v[1] + 2) * std::sin(12 * v[2] + 3);
    v *= 1 + 0.35 * std::clamp(-0.2 - v[2], 0.0, 0.4) * wave;
  }
  const Features features = find_features(mesh);
  for (const FeatureEdge& e : features.edges) EXPECT_NEAR(mesh.vertices[e[0]][2], 0.4, 1e-9);
  EXPECT_EQ(features.edges.size(), 80U);
}

TEST(CreaseSupport, ACreaseBetweenCurvedFacesStays) {
  // The trailing edge of a wing: two arcs that meet at 30 degrees, 40 edges long.
  for (const double rim_angle_deg : {30.0, 90.0}) {
    const SurfaceMesh lens = analytic::lens(rim_angle_deg, 60, 12);
    EXPECT_EQ(find_features(lens).edges.size(), 60U) << rim_angle_deg;
  }
}

TEST(CreaseSupport, OfAConeIsTheRimOnly) {
  std::vector<ProfilePoint> profile;
  for (int i = 1; i <= 10; ++i) profile.push_back({0.1 * i, 3 - 0.3 * i});
  for (int i = 9; i >= 1; --i) profile.push_back({0.1 * i, 0});
  SurfaceMesh cone = revolved(profile, 32);
  cone.vertices[cone.vertices.size() - 2][2] = 3;
  const Features features = find_features(cone);
  EXPECT_EQ(features.edges.size(), 32U);
  for (const FeatureEdge& e : features.edges) EXPECT_NEAR(cone.vertices[e[0]][2], 0, 1e-12);
}

TEST(CreaseSupport, FacetsOfACoarseCylinderAreNone) {
  for (const double noise : {0.0, 0.002}) {
    const SurfaceMesh prism = analytic::noisy(analytic::cylinder(1, 3, 14, 7), noise, 1);
    EXPECT_EQ(find_features(prism).edges.size(), 28U) << noise;
  }
}

TEST(CreaseSupport, CreasesOfFandiskStayUnderNoise) {
  const SurfaceMesh fandisk = read_surface(scan("fandisk.off"));
  const double diagonal = bounding_box(fandisk.vertices).diagonal();
  EXPECT_TRUE(find_features(fandisk).dropped.empty());
  for (const unsigned seed : {1U, 2U, 3U}) {
    const SurfaceMesh noisy = analytic::noisy(fandisk, 0.002 * diagonal, seed);
    EXPECT_GT(find_features(noisy).edges.size(), 700U);  // of 738
  }
}

TEST(CreaseSupport, WhatIsDroppedIsToldWithItsPlace) {
  const SurfaceMesh mesh = analytic::moved(crumpled(0.45, 4), {100, 0, 0});
  const Features features = find_features(mesh);
  ASSERT_FALSE(features.dropped.empty());
  for (const UnsupportedCreases& dropped : features.dropped) {
    EXPECT_GE(dropped.edges, dropped.networks);
    EXPECT_NEAR((dropped.place - Vec3(100, 0, 0)).norm(), 1, 0.5);
    EXPECT_FALSE(describe(dropped.fault).empty());
  }
}

TEST(CreaseSupport, AFoldedTriangleIsNone) {
  // One face of a plane pulled over its neighbour.
  SurfaceMesh sheet = analytic::sheet(10, 10, 0.5);
  const std::uint32_t middle = sheet.triangles[sheet.triangles.size() / 2 + 20][0];
  sheet.vertices[middle] += Vec3(0.9, 0.2, 0.01);
  const Features features = find_features(sheet, {.shortest_chain_of_diagonal = 0});
  EXPECT_TRUE(features.edges.empty());
  ASSERT_EQ(features.dropped.size(), 1U);
  EXPECT_EQ(features.dropped[0].fault, CreaseFault::folded);
}

}  // namespace
}  // namespace scan2fea
