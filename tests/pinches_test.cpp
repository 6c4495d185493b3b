#include "preproc/surface/reconstruction/pinches.hpp"

#include "preproc/surface/kernel/point_neighbours.hpp"
#include "quality/validity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace scan2fea {
namespace {

class Pinches : public testing::Test {
 protected:
  // Cells of points all about in a box from -1 to 1, those inside of which the centre says so.
  template <class IsInside>
  Pinches& with(IsInside is_inside_at) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-1, 1);
    for (int i = 0; i < 500; ++i) points_.emplace_back(place(random), place(random), place(random));
    cells_ = Delaunay(points_).cells();
    costs_.gain.assign(cells_.corners.size(), 0.0);
    costs_.price.assign(cells_.corners.size(), {1, 1, 1, 1});
    for (std::uint32_t c = 0; c < cells_.corners.size(); ++c) {
      Vec3 centre = Vec3::Zero();
      if (!cells_.is_infinite(c))
        for (const std::uint32_t v : cells_.corners[c]) centre += points_[v] / 4;
      is_inside_.push_back(!cells_.is_infinite(c) && is_inside_at(centre));
    }
    return *this;
  }

  std::vector<Vec3> points_;
  DelaunayCells cells_;
  CutCosts costs_;
  std::vector<bool> is_inside_;
};

// Cells taken at random meet in edges everywhere; the boundary of what is inside has four triangles there.
TEST_F(Pinches, EdgesOfFourTrianglesAreOpened) {
  std::mt19937 random(2);
  with([&](const Vec3& p) { return p.norm() < 0.7 && random() % 8 != 0; });
  const std::size_t before = count_pinched_edges(cells_, is_inside_);
  ASSERT_GT(before, 10);
  open_pinches(cells_, costs_, is_inside_);
  EXPECT_LT(count_pinched_edges(cells_, is_inside_), before / 10);
}

TEST_F(Pinches, WhatDoesNotMeetItselfStays) {
  with([](const Vec3& p) { return p.norm() < 0.7; });
  open_pinches(cells_, costs_, is_inside_);
  const std::vector<bool> before = is_inside_;
  open_pinches(cells_, costs_, is_inside_);
  EXPECT_EQ(is_inside_, before);
}

}  // namespace
}  // namespace scan2fea
