#include "preproc/surface/enrichment/curved_volume.hpp"

#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

constexpr double of_ball = 4 * std::numbers::pi / 3;

double volume_after(const HalfedgeMesh& mesh, const std::vector<bool>& free, double volume) {
  HalfedgeMesh moved = mesh;
  moved.points = with_curved_volume(mesh, free, volume);
  return enclosed_volume(moved.to_surface());
}

// A ball whose points crowd on one side: edges there are four times shorter than on the other.
SurfaceMesh uneven_ball() {
  SurfaceMesh ball = analytic::sphere(1, 2);
  for (Vec3& p : ball.vertices) p = (p + Vec3(0.6, 0, 0)).normalized();
  return ball;
}

TEST(CurvedVolume, OfABallHoweverItIsCutIntoTriangles) {
  for (const SurfaceMesh& surface : {analytic::sphere(1, 2), uneven_ball()}) {
    const HalfedgeMesh ball(surface);
    const double lost = of_ball - enclosed_volume(surface);
    ASSERT_GT(lost, 0.01 * of_ball);
    EXPECT_NEAR(curved_volume(ball), of_ball, 0.05 * lost);
  }
  const HalfedgeMesh hollow(analytic::reversed(analytic::sphere(1, 2)));
  EXPECT_NEAR(curved_volume(hollow), -of_ball, 0.005);
}

TEST(CurvedVolume, OfABoxIsItsOwn) {
  const HalfedgeMesh box(analytic::box({1, 2, 3}, 0.25));
  EXPECT_NEAR(curved_volume(box), 6, 1e-9);
  const std::vector<bool> all(box.vertex_slots(), true);
  const std::vector<Vec3> places = with_curved_volume(box, all, 6);
  for (std::size_t v = 0; v < places.size(); ++v) EXPECT_LT((places[v] - box.points[v]).norm(), 1e-9);
}

TEST(CurvedVolume, IsEnclosedByTheTrianglesAfterwards) {
  for (const SurfaceMesh& surface : {analytic::sphere(1, 2), uneven_ball()}) {
    const HalfedgeMesh ball(surface);
    const double lost = of_ball - enclosed_volume(surface);
    std::vector<bool> all(ball.vertex_slots(), true), half(all);
    for (std::size_t v = 0; v < half.size(); v += 2) half[v] = false;
    EXPECT_NEAR(volume_after(ball, all, of_ball), of_ball, 0.05 * lost);
    // Triangles without a free corner keep what they lack.
    EXPECT_NEAR(volume_after(ball, half, of_ball), of_ball, 0.2 * lost);
    // More than the chords of this mesh cut off, as where points of a coarser scan were not lifted far enough.
    EXPECT_NEAR(volume_after(ball, all, of_ball + lost), of_ball + lost, 0.1 * lost);
  }
}

TEST(CurvedVolume, TellsAFinerSurfaceFromAnotherBody) {
  const HalfedgeMesh scan(analytic::sphere(1, 1));
  SurfaceMesh fine = analytic::sphere(1, 4);
  EXPECT_TRUE(may_be_finer(HalfedgeMesh(fine), scan));
  for (const double size : {1.2, 0.8}) {
    SurfaceMesh other = fine;
    for (Vec3& p : other.vertices) p *= size;
    EXPECT_FALSE(may_be_finer(HalfedgeMesh(other), scan));
  }
}

TEST(CurvedVolume, BordersAndHeldVerticesStay) {
  const HalfedgeMesh ball(analytic::sphere(1, 2));
  EXPECT_EQ(with_curved_volume(ball, std::vector<bool>(ball.vertex_slots(), false), of_ball), ball.points);
  SurfaceMesh open = ball.to_surface();
  open.triangles.resize(open.triangles.size() / 2);
  const HalfedgeMesh half(open);
  const std::vector<bool> all(half.vertex_slots(), true);
  const std::vector<Vec3> moved = with_curved_volume(half, all, curved_volume(half));
  for (HalfedgeMesh::Index v = 0; v < moved.size(); ++v)
    if (!half.is_alive(v) || half.is_border_vertex(v)) {
      EXPECT_EQ(moved[v], half.points[v]);
    }
}

// Bumps as high as hollows are deep: whatever volume lacks, their heights stay nearly what their normals tell.
TEST(CurvedVolume, TellsNothingWhereBumpsAndHollowsCancelOut) {
  constexpr int n = 40;
  SurfaceMesh waves;
  const auto at = [](int i, int j) { return static_cast<std::uint32_t>(i * (n + 1) + j); };
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      waves.vertices.emplace_back(i, j, std::sin(i * std::numbers::pi / 5) * std::sin(j * std::numbers::pi / 5));
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      waves.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      waves.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  const HalfedgeMesh mesh(waves);
  const std::vector<bool> all(mesh.vertex_slots(), true);
  const double own = curved_volume(mesh);
  const std::vector<Vec3> usual = with_curved_volume(mesh, all, own);
  double largest = 0, largest_change = 0;
  for (const double off : {-2.0, 2.0}) {
    const std::vector<Vec3> places = with_curved_volume(mesh, all, own + off);
    for (std::size_t v = 0; v < places.size(); ++v) {
      largest = std::max(largest, (usual[v] - mesh.points[v]).norm());
      largest_change = std::max(largest_change, (places[v] - usual[v]).norm());
    }
  }
  ASSERT_GT(largest, 0.01);
  EXPECT_LT(largest_change, 0.1 * largest);
}

}  // namespace
}  // namespace scan2fea
