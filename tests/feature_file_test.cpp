#include "preproc/surface/features/feature_file.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/features/match_features.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/error_from.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace scan2fea {
namespace {

using ::testing::HasSubstr;

TEST(FeatureFile, EdgesOfAScanComeBackAsThemselves) {
  const TemporaryFolder folder;
  SurfaceMesh scan = analytic::slab_with_holes(2, 0.25);
  for (Vec3& v : scan.vertices) v = v / 3 + Vec3(0.1, 1e6, -1e-7);
  const std::vector<FeatureEdge> edges = find_features(scan).edges;
  write_feature_lines(lines_of(scan, edges), folder / "edges.obj");
  EXPECT_EQ(match_features(scan, VertexStars(scan), read_feature_lines(folder / "edges.obj")), edges);
}

TEST(FeatureFile, PolylinesAndRelativeIndicesAreRead) {
  const TemporaryFolder folder;
  const auto file = write_text(folder / "drawn.obj",
                               "# drawn\no rim\nv 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2/1 3\nl -1 -3\nv 9 9 9\nf 1 2 3\n");
  const FeatureLines lines = read_feature_lines(file);
  EXPECT_EQ(lines.points.size(), 4U);
  using Segments = decltype(lines.segments);
  EXPECT_EQ(lines.segments, (Segments{{0, 1}, {1, 2}, {2, 0}}));
}

TEST(FeatureFile, NoLinesAreNoFeatures) {
  const TemporaryFolder folder;
  write_feature_lines({}, folder / "none.obj");
  EXPECT_TRUE(read_feature_lines(folder / "none.obj").segments.empty());
  const SurfaceMesh ball = analytic::sphere(1, 2);
  EXPECT_TRUE(match_features(ball, VertexStars(ball), {}).empty());
}

TEST(FeatureFile, BrokenLinesAreNamed) {
  const TemporaryFolder folder;
  const auto read = [&](const char* text) {
    return std::string(
        error_from<InvalidInput>([&] { read_feature_lines(write_text(folder / "bad.obj", text)); }).what());
  };
  EXPECT_THAT(read("v 0 0 0\nv 1 0 0\nl 1 3\n"), HasSubstr("bad.obj:3"));
  EXPECT_THAT(read("v 0 0 0\nv 1 0 0\nl 1\n"), HasSubstr("too few points"));
  EXPECT_THAT(read("v 0 0\n"), HasSubstr("bad.obj:1"));
}

TEST(MatchFeatures, ALongLineIsFollowedAlongItsEdge) {
  const SurfaceMesh box = analytic::box({4, 3, 2}, 0.25);
  const std::vector<FeatureEdge> edges =
      match_features(box, VertexStars(box), {{Vec3(0, 0.001, 0), Vec3(4, 0, -0.001)}, {{0, 1}}});
  EXPECT_EQ(edges.size(), 16U);
  for (const FeatureEdge& e : edges)
    for (const std::uint32_t v : e) EXPECT_EQ(box.vertices[v].tail<2>(), Eigen::Vector2d(0, 0));
}

TEST(MatchFeatures, ALineBesideTheScanIsAnError) {
  const SurfaceMesh box = analytic::box({4, 3, 2}, 0.25);
  EXPECT_THAT(error_from<InvalidInput>([&] {
                match_features(box, VertexStars(box), {{Vec3(0, 0, 0), Vec3(4, 0, 0.1)}, {{0, 1}}});
              }).what(),
              HasSubstr("(4, 0, 0.1)"));
  // Both ends are corners, but the way between them is the box's inside.
  EXPECT_THAT(error_from<InvalidInput>([&] {
                match_features(box, VertexStars(box), {{Vec3(0, 0, 0), Vec3(4, 3, 2)}, {{0, 1}}});
              }).what(),
              HasSubstr("(2, 1.5, 1)"));
}

TEST(MatchFeatures, BordersAreKeptAnyway) {
  const SurfaceMesh sheet = analytic::sheet(4, 3, 0.5);
  const std::vector<FeatureEdge> edges = match_features(
      sheet, VertexStars(sheet), {{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 1, 0), Vec3(4, 1, 0)}, {{0, 1}, {2, 3}}});
  EXPECT_EQ(edges.size(), 8U);
  for (const FeatureEdge& e : edges) EXPECT_EQ(sheet.vertices[e[0]][1], 1);
}

}  // namespace
}  // namespace scan2fea
