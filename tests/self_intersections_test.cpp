#include "quality/self_intersections.hpp"

#include "tests/analytic_meshes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace scan2fea {
namespace {

SurfaceMesh triangles(std::vector<Vec3> vertices, std::vector<Triangle> faces) {
  return {std::move(vertices), std::move(faces)};
}

TEST(SelfIntersections, SmoothSurfacesHaveNone) {
  EXPECT_TRUE(find_self_intersections(analytic::sphere(1, 4)).empty());
  EXPECT_TRUE(find_self_intersections(analytic::torus(3, 1, 60, 30)).empty());
}

TEST(SelfIntersections, FlatNeighboursHaveNone) {  // exact: coplanar faces side by side
  EXPECT_TRUE(find_self_intersections(analytic::slab_with_holes(3, 0.125)).empty());
}

TEST(SelfIntersections, CrossingBoxesIntersect) {
  const SurfaceMesh box = analytic::box({1, 1, 1}, 0.5);
  const auto n = static_cast<std::uint32_t>(box.triangles.size());
  const auto pairs = find_self_intersections(analytic::join(box, analytic::moved(box, {0.3, 0.31, 0.32})));
  EXPECT_FALSE(pairs.empty());
  for (const FacePair& pair : pairs) {
    EXPECT_LT(pair.face, n);
    EXPECT_GE(pair.other, n);
  }
  EXPECT_TRUE(std::is_sorted(pairs.begin(), pairs.end()));
}

TEST(SelfIntersections, ABoxInsideAnotherDoesNot) {
  EXPECT_TRUE(find_self_intersections(
                  analytic::join(analytic::box({3, 3, 3}, 1), analytic::moved(analytic::box({1, 1, 1}, 1), {1, 1, 1})))
                  .empty());
}

TEST(SelfIntersections, ASharedVertexIsNoIntersectionButACoincidentOneIs) {
  const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 1}, {0, -1, 1}, {0, 0, 0}};
  EXPECT_TRUE(find_self_intersections(triangles(corners, {{0, 1, 2}, {0, 3, 4}})).empty());
  EXPECT_THAT(find_self_intersections(triangles(corners, {{0, 1, 2}, {5, 3, 4}})),
              testing::ElementsAre(FacePair{0, 1}));
}

TEST(SelfIntersections, FacesThatShareAVertexAndPassThroughOneAnother) {
  const auto mesh = triangles({{0, 0, 0}, {2, -1, 0}, {2, 1, 0}, {1, 0, -1}, {1, 0, 1}}, {{0, 1, 2}, {0, 3, 4}});
  EXPECT_THAT(find_self_intersections(mesh), testing::ElementsAre(FacePair{0, 1}));
}

TEST(SelfIntersections, AFoldIsOneOnlyWhenFlat) {
  const std::vector<Vec3> open{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 1e-300}};
  EXPECT_TRUE(find_self_intersections(triangles(open, {{0, 1, 2}, {1, 0, 3}})).empty());
  const std::vector<Vec3> shut{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.5, 0}};
  EXPECT_THAT(find_self_intersections(triangles(shut, {{0, 1, 2}, {1, 0, 3}})), testing::ElementsAre(FacePair{0, 1}));
}

TEST(SelfIntersections, TheUnitDoesNotMatter) {  // down to where products of coordinates underflow
  const SurfaceMesh sphere = analytic::sphere(1, 2);
  const SurfaceMesh crossing = analytic::join(sphere, analytic::moved(sphere, {0.4, 0.1, 0.2}));
  const auto expected = find_self_intersections(crossing);
  ASSERT_FALSE(expected.empty());
  for (const double unit : {0x1p-600, 0x1p-300, 0x1p300}) {
    SurfaceMesh scaled = crossing;
    for (Vec3& v : scaled.vertices) v *= unit;
    EXPECT_EQ(find_self_intersections(scaled), expected);
  }
}

TEST(SelfIntersections, AFaceTwiceIsOne) {
  const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_THAT(find_self_intersections(triangles(corners, {{0, 1, 2}, {0, 2, 1}})),
              testing::ElementsAre(FacePair{0, 1}));
}

TEST(SelfIntersections, ACollinearFaceIsReportedByItself) {
  const std::vector<Vec3> corners{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {0, 0, 1}};
  EXPECT_THAT(find_self_intersections(triangles(corners, {{0, 1, 2}, {0, 1, 3}})),
              testing::ElementsAre(FacePair{0, 0}));
}

TEST(SelfIntersections, OfASubsetAreThoseOfAllThatTouchIt) {
  const SurfaceMesh sphere = analytic::sphere(1, 3);
  const SurfaceMesh mesh = analytic::join(analytic::noisy(sphere, 0.05, 3), analytic::moved(sphere, {0.4, 0.1, 0.2}));
  const auto all = find_self_intersections(mesh);
  ASSERT_GT(all.size(), 10U);
  std::vector<std::uint32_t> subset;
  for (std::uint32_t f = static_cast<std::uint32_t>(mesh.triangles.size()); f-- > 0;)
    if (f % 3 == 0) subset.push_back(f);
  std::vector<FacePair> expected;
  for (const FacePair& pair : all)
    if (pair.face % 3 == 0 || pair.other % 3 == 0) expected.push_back(pair);
  EXPECT_EQ(find_self_intersections(mesh, subset), expected);
  EXPECT_TRUE(find_self_intersections(mesh, {}).empty());
}

}  // namespace
}  // namespace scan2fea
