#include "preproc/surface/lattice/position_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace scan2fea {
namespace {

TEST(LatticeCoordinates, SixTurnsAreNone) {
  const LatticeCoordinates p{0.3F, -1.7F};
  LatticeCoordinates q = p;
  for (int k = 0; k < 6; ++k) {
    EXPECT_NEAR(turned(p, k)[0], q[0], 1e-6);
    EXPECT_NEAR(turned(p, k)[1], q[1], 1e-6);
    EXPECT_NEAR(squared_length(q), squared_length(p), 1e-5);
    q = turned(q, 1);
  }
  EXPECT_NEAR(q[0], p[0], 1e-6);
  EXPECT_NEAR(q[1], p[1], 1e-6);
}

TEST(LatticeCoordinates, RoundingFindsTheNearestPoint) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<float> uniform(-3, 3);
  for (int sample = 0; sample < 2000; ++sample) {
    const LatticeCoordinates p{uniform(generator), uniform(generator)};
    const LatticeCoordinates found = nearest_lattice_point(p);
    const float distance = squared_length({p[0] - found[0], p[1] - found[1]});
    for (float u = -5; u <= 5; ++u)
      for (float v = -5; v <= 5; ++v) EXPECT_LE(distance, squared_length({p[0] - u, p[1] - v}) + 1e-5F);
  }
}

TEST(LatticeStep, IsTheDisplacementOnAPlane) {
  // The same direction at both nodes, given with different representatives.
  const Vec3 normal = Vec3(1, 2, -3).normalized();
  const TangentFrame frame(normal);
  const Complex along = std::polar(1.0, 0.4), sixth = std::polar(1.0, M_PI / 3);
  const LatticeNode a({0, 0, 0}, normal, along, 0.5);
  const Complex step = 0.5 * along * (2.0 + 3.0 * sixth);
  const LatticeNode b(frame.vector(step), normal, along, 0.5);
  const LatticeStep there = lattice_step(a, b);
  EXPECT_EQ(there.turns, 0);
  EXPECT_NEAR(there.shift[0], 2, 1e-5);
  EXPECT_NEAR(there.shift[1], 3, 1e-5);
  const LatticeStep turned_there = lattice_step({a.position, normal, along * sixth, 0.5}, b);
  EXPECT_EQ(turned_there.turns, 1);
  EXPECT_NEAR(turned_there.shift[0], 2, 1e-5);
}

TEST(LatticeStep, TheWayBackIsTheInverse) {
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return Vec3(uniform(generator), uniform(generator), uniform(generator)); };
  for (int sample = 0; sample < 500; ++sample) {
    const Vec3 normal = vector().normalized();
    const LatticeNode a(vector(), normal, std::polar(1.0, 3 * uniform(generator)), 0.7);
    const LatticeNode b(vector(), (normal + 0.5 * vector()).normalized(), std::polar(1.0, 3 * uniform(generator)), 0.6);
    const LatticeCoordinates p{static_cast<float>(uniform(generator)), static_cast<float>(uniform(generator))};
    const LatticeCoordinates q = carried(lattice_step(b, a), carried(lattice_step(a, b), p));
    EXPECT_NEAR(q[0], p[0], 1e-4);
    EXPECT_NEAR(q[1], p[1], 1e-4);
    EXPECT_EQ(inverse(lattice_step(a, b)).turns, lattice_step(b, a).turns);
    EXPECT_NEAR(inverse(lattice_step(a, b)).shift[0], lattice_step(b, a).shift[0], 1e-4);
    EXPECT_NEAR(inverse(lattice_step(a, b)).shift[1], lattice_step(b, a).shift[1], 1e-4);
  }
}

}  // namespace
}  // namespace scan2fea
