#include "preproc/surface/kernel/smallest_box.hpp"

#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

namespace scan2fea {
namespace {

double smallest_box_diagonal(std::vector<Vec3> points) {
  const Eigen::Matrix3d axes = smallest_box_axes(points);
  for (Vec3& p : points) p = axes.transpose() * p;
  return bounding_box(points).diagonal();
}

TEST(SmallestBox, OfABoxIsTheBoxHoweverItLies) {
  const Vec3 size(60, 40, 8);
  for (unsigned seed = 0; seed < 20; ++seed) {
    const SurfaceMesh box = analytic::elsewhere(analytic::box(size, 4), seed);
    EXPECT_NEAR(smallest_box_diagonal(box.vertices), size.norm(), 0.005 * size.norm()) << "placement " << seed;
  }
}

TEST(SmallestBox, OfARodIsItsLength) {
  const SurfaceMesh rod = analytic::elsewhere(analytic::cylinder(0.1, 50, 24, 10), 7);
  EXPECT_NEAR(smallest_box_diagonal(rod.vertices), 50, 0.005 * 50);
}

TEST(SmallestBox, WhatLiesAlongTheAxesStays) {
  EXPECT_EQ(smallest_box_axes(analytic::box({100, 2, 2}, 2).vertices), Eigen::Matrix3d::Identity());
  EXPECT_EQ(smallest_box_axes(analytic::box({300, 20, 2}, 1).vertices), Eigen::Matrix3d::Identity());
  EXPECT_EQ(smallest_box_axes(analytic::box({60, 40, 8}, 4).vertices), Eigen::Matrix3d::Identity());
  EXPECT_EQ(smallest_box_axes({Vec3(1, 2, 3), Vec3(1, 2, 3)}), Eigen::Matrix3d::Identity());
}

}  // namespace
}  // namespace scan2fea
