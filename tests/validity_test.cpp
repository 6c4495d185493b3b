#include "quality/validity.hpp"

#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

namespace scan2fea {
namespace {

// Two tetrahedra that share the vertices in `shared`, apart elsewhere.
SurfaceMesh two_tetrahedra_sharing(int shared) {
  SurfaceMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}};
  SurfaceMesh other = mesh;
  for (Vec3& v : other.vertices) v = Vec3(-v.x(), -v.y(), v.z());
  SurfaceMesh both = analytic::join(mesh, other);
  for (Triangle& t : both.triangles)
    for (std::uint32_t& v : t)
      if (v >= 4 && v < 4 + static_cast<std::uint32_t>(shared)) v -= 4;
  return both;
}

TEST(Validity, SphereIsAClosedManifoldOfGenusZero) {
  const SurfaceValidity validity = check_validity(analytic::sphere(1, 3));
  EXPECT_TRUE(validity.closed());
  EXPECT_TRUE(validity.manifold());
  EXPECT_TRUE(validity.encloses_volume());
  EXPECT_EQ(validity.components, 1U);
  EXPECT_EQ(validity.genus, 0);
  EXPECT_EQ(validity.unused_vertices, 0U);
}

TEST(Validity, GenusCountsHandles) {
  EXPECT_EQ(check_validity(analytic::torus(3, 1, 20, 10)).genus, 1);
  EXPECT_EQ(check_validity(analytic::slab_with_holes(5, 0.5)).genus, 5);
}

TEST(Validity, GenusIsTheSumOverComponents) {
  const SurfaceMesh mesh = analytic::join(analytic::torus(3, 1, 20, 10), analytic::slab_with_holes(2, 1));
  const SurfaceValidity validity = check_validity(analytic::join(mesh, analytic::sphere(1, 1)));
  EXPECT_EQ(validity.components, 3U);
  EXPECT_EQ(validity.genus, 3);
}

TEST(Validity, AMissingFaceOpensThreeEdges) {
  SurfaceMesh mesh = analytic::sphere(1, 2);
  mesh.triangles.pop_back();
  const SurfaceValidity validity = check_validity(mesh);
  EXPECT_EQ(validity.boundary_edges, 3U);
  EXPECT_FALSE(validity.closed());
  EXPECT_TRUE(validity.manifold());
  EXPECT_FALSE(validity.genus.has_value());
}

TEST(Validity, ATurnedFaceIsSeenAtItsThreeEdges) {
  SurfaceMesh mesh = analytic::sphere(1, 2);
  std::swap(mesh.triangles[7][0], mesh.triangles[7][1]);
  const SurfaceValidity validity = check_validity(mesh);
  EXPECT_EQ(validity.misoriented_edges, 3U);
  EXPECT_TRUE(validity.closed());
  EXPECT_FALSE(validity.manifold());
  EXPECT_FALSE(validity.encloses_volume());
  EXPECT_FALSE(validity.genus.has_value());
}

TEST(Validity, InsideOutIsOrientedAllTheSame) {
  EXPECT_TRUE(check_validity(analytic::reversed(analytic::sphere(1, 2))).oriented());
}

TEST(Validity, SolidsThatShareAnEdgeAreNonManifoldButEncloseAVolume) {
  const SurfaceValidity validity = check_validity(two_tetrahedra_sharing(2));
  EXPECT_EQ(validity.non_manifold_edges, 1U);
  EXPECT_FALSE(validity.manifold());
  EXPECT_TRUE(validity.encloses_volume());
  EXPECT_EQ(validity.components, 1U);
}

TEST(Validity, SolidsThatShareAVertexMakeTwoFansThere) {
  const SurfaceValidity validity = check_validity(two_tetrahedra_sharing(1));
  EXPECT_EQ(validity.non_manifold_edges, 0U);
  EXPECT_EQ(validity.non_manifold_vertices, 1U);
  EXPECT_FALSE(validity.manifold());
  EXPECT_EQ(validity.components, 2U);
  EXPECT_FALSE(validity.genus.has_value());
}

TEST(Validity, AFinOnAClosedSurfaceIsABoundaryAndANonManifoldEdge) {
  SurfaceMesh mesh = analytic::sphere(1, 1);
  const Triangle t = mesh.triangles[0];
  mesh.vertices.push_back({2, 2, 2});
  mesh.triangles.push_back({t[0], t[1], static_cast<std::uint32_t>(mesh.vertices.size() - 1)});
  const SurfaceValidity validity = check_validity(mesh);
  EXPECT_EQ(validity.non_manifold_edges, 1U);
  EXPECT_EQ(validity.boundary_edges, 2U);
}

TEST(Validity, UnusedVerticesAndRepeatedCornersAreCountedAndLeftOut) {
  SurfaceMesh mesh = analytic::sphere(1, 1);
  mesh.vertices.push_back({9, 9, 9});
  mesh.triangles.push_back({0, 0, 1});
  const SurfaceValidity validity = check_validity(mesh);
  EXPECT_EQ(validity.unused_vertices, 1U);
  EXPECT_EQ(validity.degenerate_faces, 1U);
  EXPECT_FALSE(validity.manifold());
  EXPECT_TRUE(validity.closed());
  EXPECT_EQ(validity.components, 1U);
}

TEST(Validity, AMoebiusStripCannotBeOriented) {
  SurfaceMesh strip;
  constexpr std::uint32_t pieces = 9;
  strip.vertices.resize(2 * pieces, Vec3::Zero());
  for (std::uint32_t i = 0; i < pieces; ++i) {
    const std::uint32_t a = 2 * i, b = 2 * i + 1;
    const bool last = i + 1 == pieces;
    const std::uint32_t c = last ? 1 : a + 2, d = last ? 0 : b + 2;
    strip.triangles.push_back({a, c, b});
    strip.triangles.push_back({b, c, d});
  }
  EXPECT_FALSE(check_validity(strip).oriented());
}

TEST(Validity, WhetherAVolumeIsEnclosedNeedsNoSortedEdges) {
  SurfaceMesh open = analytic::sphere(1, 3), turned = open, doubled = open, repeated = open;
  open.triangles.pop_back();
  std::swap(turned.triangles[5][0], turned.triangles[5][1]);
  doubled.triangles.push_back(doubled.triangles.front());
  repeated.triangles.push_back({0, 0, 1});
  for (const SurfaceMesh& mesh : {analytic::torus(3, 1, 20, 10), two_tetrahedra_sharing(1), two_tetrahedra_sharing(2),
                                  open, turned, doubled, repeated, SurfaceMesh()})
    EXPECT_EQ(encloses_volume(mesh), check_validity(mesh).encloses_volume());
}

TEST(Validity, NothingHasNoComponents) {
  const SurfaceValidity validity = check_validity({});
  EXPECT_EQ(validity.components, 0U);
  EXPECT_TRUE(validity.closed());
}

}  // namespace
}  // namespace scan2fea
