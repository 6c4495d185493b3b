// Surfaces of images are told from those of parts.
#include "preproc/mesh/stair_steps.hpp"

#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace scan2fea {
namespace {

SurfaceMesh askew(SurfaceMesh mesh) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, -3).normalized()).toRotationMatrix();
  for (Vec3& p : mesh.vertices) {
    p = (turn * p).eval() + Vec3(100, -30, 400);
    for (double& x : p) x = static_cast<double>(static_cast<float>(x));
  }
  return mesh;
}

// Discs of one height on one another, of the radii of a ball.
SurfaceMesh pile(int discs, double height) {
  constexpr std::uint32_t around = 60;
  const double radius = discs * height / 2;
  SurfaceMesh mesh{{{0, 0, 0}, {0, 0, 2 * radius}}, {}};
  const auto add_ring = [&](double r, double z) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const double angle = 2 * std::acos(-1.0) * i / around;
      mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
  };
  for (int d = 0; d < discs; ++d) {
    const double z = d * height, from_middle = z + height / 2 - radius;
    for (const double end : {z, z + height})
      add_ring(std::sqrt(radius * radius - from_middle * from_middle) + 1e-3 * d, end);
  }
  const auto rings = static_cast<std::uint32_t>(2 * discs);
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t j = (i + 1) % around, last = 2 + (rings - 1) * around;
    mesh.triangles.push_back({0, 2 + j, 2 + i});
    mesh.triangles.push_back({1, last + i, last + j});
    for (std::uint32_t r = 0; r + 1 < rings; ++r) {
      const std::uint32_t low = 2 + r * around, high = low + around;
      mesh.triangles.push_back({low + i, low + j, high + j});
      mesh.triangles.push_back({low + i, high + j, high + i});
    }
  }
  return mesh;
}

void expect_voxels(const SurfaceMesh& mesh, const std::array<double, 3>& size) {
  const auto steps = find_stair_steps(mesh);
  ASSERT_TRUE(steps);
  EXPECT_EQ(steps->kind, StairSteps::Kind::voxels);
  for (const std::size_t k : {0U, 1U, 2U}) EXPECT_NEAR(steps->size[k], size[k], 1e-4);
}

TEST(StairSteps, OfVoxelsAreTheirSize) {
  const SurfaceMesh ball = analytic::voxel_ball(20);
  expect_voxels(ball, {1, 1, 1});
  expect_voxels(askew(ball), {1, 1, 1});
  const auto is_in = [](const Vec3& p) { return (p - Vec3::Constant(10)).norm() < 9; };
  expect_voxels(analytic::voxels({40, 40, 10}, {0.5, 0.5, 2}, is_in), {0.5, 0.5, 2});
}

TEST(StairSteps, OfVoxelsThatTouchAtEdgesAreTheirSize) {
  const auto is_in = [](const Vec3& p) {
    return (p - Vec3::Constant(12)).norm() < 11 && std::fmod(7 * p.x() + 13 * p.y() + 29 * p.z(), 17) > 1;
  };
  expect_voxels(analytic::voxels({24, 24, 24}, Vec3::Ones(), is_in), {1, 1, 1});
}

TEST(StairSteps, OfSlicesAreTheirHeight) {
  for (const SurfaceMesh& mesh : {pile(20, 2.5), askew(pile(20, 2.5))}) {
    const auto steps = find_stair_steps(mesh);
    ASSERT_TRUE(steps);
    EXPECT_EQ(steps->kind, StairSteps::Kind::slices);
    EXPECT_NEAR(steps->largest(), 2.5, 1e-3);
  }
  EXPECT_FALSE(find_stair_steps(pile(5, 2.5))) << "a shaft with shoulders";
}

TEST(StairSteps, ArePartsOfNoPart) {
  EXPECT_FALSE(find_stair_steps(analytic::box({60, 40, 20}, 60)));
  EXPECT_FALSE(find_stair_steps(analytic::box({60, 40, 20}, 1)));
  EXPECT_FALSE(find_stair_steps(analytic::box({20, 20, 20}, 1)));
  EXPECT_FALSE(find_stair_steps(analytic::slab_with_holes(3, 0.25)));
  EXPECT_FALSE(find_stair_steps(analytic::cylinder(10, 30, 60, 20)));
  EXPECT_FALSE(find_stair_steps(analytic::sphere(10, 4)));
  const auto is_bracket = [](const Vec3& p) { return p.x() < 4 || p.z() < 4; };
  EXPECT_FALSE(find_stair_steps(analytic::voxels({20, 10, 20}, Vec3::Ones(), is_bracket)))
      << "a bracket with faces of one size";
}

TEST(StairSteps, OfNothingAreNone) {
  EXPECT_FALSE(find_stair_steps({}));
  EXPECT_FALSE(find_stair_steps({{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {{0, 1, 2}}}));
}

}  // namespace
}  // namespace scan2fea
