#include "preproc/surface/enrichment/importance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

// A flat fan of six triangles around vertex 0, whose vertices 1 and 2 are farther away than the others.
SurfaceMesh lopsided_fan(double far) {
  SurfaceMesh mesh;
  mesh.vertices.push_back(Vec3::Zero());
  for (std::uint32_t i = 0; i < 6; ++i) {
    const double angle = i * std::numbers::pi / 3, radius = i < 2 ? far : 1;
    mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % 6});
  }
  return mesh;
}

std::vector<Vec3> sectors_of_centre(const SurfaceMesh& surface, const ImportanceOptions& options) {
  const HalfedgeMesh mesh(surface);
  const SideNormals normals(mesh, CornerWeight::angle);
  return Importance(mesh, normals).empty_sectors(0, options);
}

TEST(Importance, AsksOnTheBisectorOfTheEmptySector) {
  const std::vector<Vec3> sectors = sectors_of_centre(lopsided_fan(3), {.sampling_radius = 1.5});
  ASSERT_EQ(sectors.size(), 1U);
  const double bisector = std::numbers::pi / 6;  // half-way from 300 over 360 to 120 degrees
  EXPECT_NEAR((sectors[0] - Vec3(std::cos(bisector), std::sin(bisector), 0)).norm(), 0, 1e-12);
}

TEST(Importance, IsContentWithNoSectorOf90DegreesOrManyNeighbours) {
  EXPECT_TRUE(sectors_of_centre(lopsided_fan(1), {.sampling_radius = 1.5}).empty());
  // Four neighbours are within the radius: more than three.
  EXPECT_TRUE(sectors_of_centre(lopsided_fan(3), {.sampling_radius = 1.5, .most_neighbours = 3}).empty());
}

TEST(Importance, ALonelyPointAsksAwayFromItsLongestEdge) {
  const SurfaceMesh fan = lopsided_fan(3);
  const std::vector<Vec3> sectors = sectors_of_centre(fan, {.sampling_radius = 0.5});
  ASSERT_EQ(sectors.size(), 1U);
  // Two edges are equally long, but for rounding.
  EXPECT_NEAR(std::min(sectors[0].dot(fan.vertices[1]), sectors[0].dot(fan.vertices[2])), -3, 1e-12);
}

TEST(Importance, NothingIsMissingBeyondABorder) {
  const SurfaceMesh surface = lopsided_fan(3);
  const HalfedgeMesh mesh(surface);
  const SideNormals normals(mesh, CornerWeight::angle);
  // Vertex 4, at (-1, 0), sees its three neighbours within 120 degrees, and the outside of the fan in the other 240.
  EXPECT_TRUE(Importance(mesh, normals).empty_sectors(4, {.sampling_radius = 1.5}).empty());
}

TEST(Importance, SpacingIsTheDistanceOfTheSixthNeighbour) {
  const SurfaceMesh surface = lopsided_fan(3);
  const HalfedgeMesh mesh(surface);
  const SideNormals normals(mesh, CornerWeight::angle);
  const std::array<HalfedgeMesh::Index, 1> centre{0};
  EXPECT_NEAR(Importance(mesh, normals).median_spacing(centre), 3, 1e-12);
}

}  // namespace
}  // namespace scan2fea
