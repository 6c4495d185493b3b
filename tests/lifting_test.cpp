#include "preproc/surface/placement/lifting.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace scan2fea {
namespace {

constexpr Lifting all[] = {Lifting::shepard, Lifting::modified_quadratic_shepard, Lifting::moving_least_squares,
                           Lifting::hermite};
constexpr Lifting sound[] = {Lifting::modified_quadratic_shepard, Lifting::moving_least_squares, Lifting::hermite};
const Vec3 up(0, 0, 1);

SurfaceSample on_sphere(double x, double y, double radius) {
  const Vec3 p(x, y, std::sqrt(radius * radius - x * x - y * y));
  return {p - Vec3(0, 0, radius), p / radius};
}

// Scattered samples of a sphere that touches z = 0 at the origin from below.
std::vector<SurfaceSample> cap(double radius, unsigned seed, int count = 24) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  std::vector<SurfaceSample> samples;
  for (int i = 0; i < count; ++i) samples.push_back(on_sphere(coordinate(random), coordinate(random), radius));
  return samples;
}

TEST(Wendland, FallsFromOneToZeroWithoutAStep) {
  EXPECT_EQ(wendland(0), 1);
  EXPECT_EQ(wendland(1), 0);
  EXPECT_EQ(wendland(3), 0);
  EXPECT_NEAR(wendland(0.5), 0.0625 * 3, 1e-15);
  EXPECT_LT(wendland(0.999), 1e-9);
  for (double r = 0; r < 1; r += 0.01) EXPECT_GT(wendland(r), wendland(r + 0.01));
}

TEST(Lifting, ReproducesAPlane) {
  std::vector<SurfaceSample> samples = cap(3, 1);
  const Vec3 normal = Vec3(-0.2, 0.1, 1).normalized();
  for (SurfaceSample& s : samples) s = {Vec3(s.point[0], s.point[1], 0.2 * s.point[0] - 0.1 * s.point[1]), normal};
  for (const Lifting lifting : sound) EXPECT_NEAR(lifted_height(lifting, samples, Vec3::Zero(), up, 1.5), 0, 1e-5);
  EXPECT_GT(std::abs(lifted_height(Lifting::shepard, samples, Vec3::Zero(), up, 1.5)), 1e-4)
      << "the plain method has no linear precision unless samples lie evenly";
}

TEST(Lifting, ReproducesAParaboloid) {
  std::vector<SurfaceSample> samples = cap(3, 2);
  const auto z = [](double x, double y) { return 0.1 + 0.3 * x - 0.2 * x * x + 0.1 * x * y + 0.15 * y * y; };
  for (SurfaceSample& s : samples) {
    const double x = s.point[0], y = s.point[1];
    s = {Vec3(x, y, z(x, y)), Vec3(-0.3 + 0.4 * x - 0.1 * y, -0.1 * x - 0.3 * y, 1).normalized()};
  }
  for (const Lifting lifting : sound)
    EXPECT_NEAR(lifted_height(lifting, samples, Vec3::Zero(), up, 1.5), 0.1, 1e-4) << name_of(lifting);
}

TEST(Lifting, InterpolatesTheSamples) {
  const auto samples = cap(2, 3);
  for (const Lifting lifting : sound)
    for (const SurfaceSample& s : samples) {
      const Vec3 foot(s.point[0], s.point[1], 0);
      EXPECT_NEAR(lifted_height(lifting, samples, foot, up, 1), s.point[2], 1e-5) << name_of(lifting);
    }
}

TEST(Lifting, QuadricsFindASphereThatTheMeanFlattens) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const auto samples = cap(2, seed);
    const double plain = std::abs(lifted_height(Lifting::shepard, samples, Vec3::Zero(), up, 1));
    for (const Lifting lifting : sound)
      EXPECT_LT(std::abs(lifted_height(lifting, samples, Vec3::Zero(), up, 1)), 0.3 * plain) << name_of(lifting);
  }
}

TEST(Lifting, TurnsAndScalesWithTheSamples) {
  auto samples = cap(2, 4);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()).matrix();
  const Vec3 base(0.1, 0.05, 0);
  for (const Lifting lifting : all) {
    const double before = lifted_height(lifting, samples, base, up, 1);
    auto turned = samples;
    for (SurfaceSample& s : turned) s = {1000 * (turn * s.point), turn * s.normal};
    EXPECT_NEAR(lifted_height(lifting, turned, 1000 * (turn * base), turn * up, 1000), 1000 * before, 1e-6)
        << name_of(lifting);
  }
}

TEST(Lifting, FewOrCollinearSamplesGiveNoWildHeights) {
  std::vector<SurfaceSample> samples;
  for (const Lifting lifting : all) EXPECT_EQ(lifted_height(lifting, samples, Vec3::Zero(), up, 1), 0);
  for (int i = 0; i < 4; ++i) samples.push_back({Vec3(0.3 + 0.1 * i, 0, 0.02), up});
  for (const Lifting lifting : all)
    for (std::size_t n = 1; n <= samples.size(); ++n)
      EXPECT_NEAR(lifted_height(lifting, std::span(samples).first(n), Vec3::Zero(), up, 1), 0.02, 0.02)
          << name_of(lifting) << ", " << n << " samples";
}

TEST(Lifting, SamplesOfTheOtherSideOfAWallDoNotCount) {
  auto samples = cap(5, 5);
  const auto front = samples;
  for (const SurfaceSample& s : cap(5, 6)) samples.push_back({s.point - Vec3(0, 0, 0.1), -s.normal});
  for (const Lifting lifting : sound)
    EXPECT_EQ(lifted_height(lifting, samples, Vec3::Zero(), up, 1), lifted_height(lifting, front, Vec3::Zero(), up, 1));
}

}  // namespace
}  // namespace scan2fea
