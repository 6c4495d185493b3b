#include "preproc/surface/enrichment/chord_volume.hpp"

#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

double volume_after(const HalfedgeMesh& mesh, const std::vector<bool>& free) {
  HalfedgeMesh moved = mesh;
  moved.points = with_chord_volume(mesh, free, {});
  return enclosed_volume(moved.to_surface());
}

TEST(ChordVolume, ABallHasItsVolumeAgain) {
  const HalfedgeMesh ball(analytic::sphere(1, 2));
  const double truth = 4 * std::numbers::pi / 3;
  const double lost = truth - enclosed_volume(ball.to_surface());
  ASSERT_GT(lost, 0.05);
  std::vector<bool> all(ball.vertex_slots(), true), half(all);
  for (std::size_t v = 0; v < half.size(); v += 2) half[v] = false;
  EXPECT_NEAR(volume_after(ball, all), truth, 0.15 * lost);
  // No vertex moves by more than the parabolas are high, so that a few do not stand out.
  EXPECT_GT(volume_after(ball, half), truth - 0.8 * lost);
}

TEST(ChordVolume, HollowsLoseWhatTheyHaveTooMuch) {
  const HalfedgeMesh ball(analytic::reversed(analytic::sphere(1, 2)));
  const std::vector<bool> all(ball.vertex_slots(), true);
  EXPECT_NEAR(volume_after(ball, all), -4 * std::numbers::pi / 3, 0.01);
}

TEST(ChordVolume, PlanesCreasesBordersAndHeldVerticesStay) {
  const HalfedgeMesh box(analytic::box({1, 1, 1}, 0.25));
  std::vector<bool> all(box.vertex_slots(), true), edges(box.vertex_slots(), false);
  for (std::size_t v = 0; v < edges.size(); ++v) {
    const Vec3& p = box.points[v];
    int extreme = 0;
    for (Eigen::Index k = 0; k < 3; ++k) extreme += std::abs(p[k] - 0.5) > 0.5 - 1e-9 || std::abs(p[k]) > 0.5 - 1e-9;
    edges[v] = extreme > 1;
  }
  const std::vector<Vec3> places = with_chord_volume(box, all, edges);
  for (std::size_t v = 0; v < places.size(); ++v) EXPECT_LT((places[v] - box.points[v]).norm(), 1e-12);
  const HalfedgeMesh ball(analytic::sphere(1, 2));
  EXPECT_EQ(with_chord_volume(ball, std::vector<bool>(ball.vertex_slots(), false), {}), ball.points);
  SurfaceMesh open = ball.to_surface();
  open.triangles.resize(open.triangles.size() / 2);
  const HalfedgeMesh half(open);
  const std::vector<Vec3> moved = with_chord_volume(half, std::vector<bool>(half.vertex_slots(), true), {});
  for (HalfedgeMesh::Index v = 0; v < moved.size(); ++v)
    if (!half.is_alive(v) || half.is_border_vertex(v)) {
      EXPECT_EQ(moved[v], half.points[v]);
    }
}

}  // namespace
}  // namespace scan2fea
