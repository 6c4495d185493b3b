#include "preproc/surface/reconstruction/minimum_cut.hpp"

#include "preproc/surface/kernel/point_neighbours.hpp"
#include "preproc/surface/kernel/winding_number.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

namespace scan2fea {
namespace {

TEST(WindingNumber, OneInsideAndNoneOutside) {
  const SurfaceMesh ball = analytic::sphere(1, 4);
  const WindingNumber winding(ball.vertices, ball.triangles);
  for (const double r : {0.0, 0.5, 0.9, 0.97}) EXPECT_NEAR(winding(r * Vec3(0.6, 0, 0.8)), 1, 0.03) << r;
  for (const double r : {1.03, 1.2, 2.0, 50.0}) EXPECT_NEAR(winding(r * Vec3(0.6, 0, 0.8)), 0, 0.03) << r;
  const SurfaceMesh turned = analytic::reversed(ball);
  EXPECT_NEAR(WindingNumber(turned.vertices, turned.triangles)(Vec3::Zero()), -1, 0.03);
}

TEST(Delaunay, CellsKnowOneAnother) {
  const SurfaceMesh ball = analytic::sphere(1, 2);
  const DelaunayCells cells = Delaunay(ball.vertices).cells();
  for (std::uint32_t c = 0; c < cells.corners.size(); ++c)
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& back = cells.neighbours[cells.neighbours[c][k]];
      EXPECT_NE(std::find(back.begin(), back.end(), c), back.end());
    }
}

class MinimumCut : public testing::Test {
 protected:
  std::vector<Triangle> cut(const std::vector<std::vector<Triangle>>& surfaces) const {
    const std::vector<double> spacing = point_spacing(ball_.vertices, PointNeighbours(ball_.vertices));
    const DelaunayCells cells = Delaunay(ball_.vertices).cells();
    std::vector<WoundSurface> wound;
    for (const auto& triangles : surfaces) wound.push_back(wind(ball_.vertices, cells, triangles));
    std::vector<const WoundSurface*> all;
    for (const WoundSurface& surface : wound) all.push_back(&surface);
    return cut_surface(ball_.vertices, spacing, cells, all).triangles;
  }
  void expect_ball(const std::vector<Triangle>& triangles) const {
    const SurfaceMesh mesh{ball_.vertices, triangles};
    const SurfaceValidity validity = check_validity(mesh);
    EXPECT_TRUE(validity.closed() && validity.manifold());
    EXPECT_EQ(validity.genus, 0);
    EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(ball_), 0.02 * enclosed_volume(ball_));
  }

  const SurfaceMesh ball_ = analytic::sphere(1, 3);
};

TEST_F(MinimumCut, OfAClosedSurfaceIsThatSurface) {
  expect_ball(cut({ball_.triangles}));
  expect_ball(cut({analytic::reversed(ball_).triangles}));
}

TEST_F(MinimumCut, ClosesHoles) {
  std::vector<Triangle> open = ball_.triangles;
  std::erase_if(open, [&](const Triangle& t) { return ball_.vertices[t[0]].z() > 0.8; });
  ASSERT_LT(open.size(), ball_.triangles.size());
  EXPECT_TRUE(check_validity({ball_.vertices, cut({open})}).closed());
}

TEST_F(MinimumCut, OneSurfaceHasWhatAnotherLacks) {
  std::vector<Triangle> no_top = ball_.triangles, no_bottom = ball_.triangles;
  std::erase_if(no_top, [&](const Triangle& t) { return ball_.vertices[t[0]].z() > 0.8; });
  std::erase_if(no_bottom, [&](const Triangle& t) { return ball_.vertices[t[0]].z() < -0.8; });
  expect_ball(cut({no_top, no_bottom}));
}

}  // namespace
}  // namespace scan2fea
