// Surfaces of bodies that touch, joined: each stays closed, keeps its volume, and shares triangles where it touches.
#include "preproc/bodies/body_complex.hpp"
#include "preproc/mesh/error.hpp"
#include "quality/self_intersections.hpp"
#include "tests/touching_bodies.hpp"

#include <gtest/gtest.h>

namespace scan2fea {
namespace {

using analytic::bored_block;
using analytic::moved;

double volume_of(const BodyComplex& complex, std::uint32_t body) {
  return enclosed_volume({complex.mesh.vertices, triangles_of_body(complex, body)});
}

double interface_area(const BodyComplex& complex, std::uint32_t first, std::uint32_t second) {
  double area = 0;
  for (std::size_t f = 0; f < complex.sides.size(); ++f)
    if (complex.sides[f] == Sides{first, second})
      area += area_vector(complex.mesh, complex.mesh.triangles[f]).norm() / 2;
  return area;
}

void expect_joined(const BodyComplex& complex, const std::vector<Body>& bodies, double volume_tolerance) {
  for (std::uint32_t b = 0; b < bodies.size(); ++b) {
    EXPECT_EQ(analytic::open_edges(triangles_of_body(complex, b)), 0U) << bodies[b].name;
    const double volume = enclosed_volume(bodies[b].surface);
    EXPECT_NEAR(volume_of(complex, b), volume, volume_tolerance * volume) << bodies[b].name;
  }
}

SurfaceMesh box(double x, double y, double z, double edge, const Vec3& at) {
  return moved(analytic::box({x, y, z}, edge), at);
}

TEST(JoinBodies, StackedBoxesShareTheSmallersBase) {
  const std::vector<Body> bodies{{"base", box(10, 8, 2, 20, {0, 0, 0})}, {"top", box(4, 3, 5, 1.7, {3, 2, 2})}};
  const BodyComplex complex = join_bodies(bodies);
  expect_joined(complex, bodies, 1e-12);
  EXPECT_NEAR(interface_area(complex, 0, 1), 12, 1e-9);
  ASSERT_EQ(complex.contacts.size(), 1U);
  EXPECT_NEAR(complex.contacts[0].area, 12, 1e-9);
  EXPECT_LT(complex.contacts[0].largest_gap, 1e-9);
}

TEST(JoinBodies, BoxesThatOverhangEachOther) {
  const std::vector<Body> bodies{{"base", box(10, 8, 2, 3, {0, 0, 0})}, {"top", box(9, 9, 3, 4, {4, -3, 2})}};
  const BodyComplex complex = join_bodies(bodies);
  expect_joined(complex, bodies, 1e-12);
  EXPECT_NEAR(interface_area(complex, 0, 1), 6 * 6, 1e-9);
}

TEST(JoinBodies, ThreeBlocksInARowWithEqualFaces) {
  const std::vector<Body> bodies{
      {"a", box(4, 3, 2, 1, {0, 0, 0})}, {"b", box(5, 3, 2, 0.7, {4, 0, 0})}, {"c", box(2, 3, 2, 5, {9, 0, 0})}};
  const BodyComplex complex = join_bodies(bodies);
  expect_joined(complex, bodies, 1e-12);
  EXPECT_NEAR(interface_area(complex, 0, 1), 6, 1e-9);
  EXPECT_NEAR(interface_area(complex, 1, 2), 6, 1e-9);
  EXPECT_EQ(complex.contacts.size(), 2U);
}

TEST(JoinBodies, ABrickOnTwoOthers) {
  const std::vector<Body> bodies{{"left", box(5, 4, 2, 1, {0, 0, 0})},
                                 {"right", box(5, 4, 2, 1.3, {5, 0, 0})},
                                 {"top", box(6, 4, 2, 1.1, {2, 0, 2})}};
  const BodyComplex complex = join_bodies(bodies);
  expect_joined(complex, bodies, 1e-12);
  EXPECT_NEAR(interface_area(complex, 0, 1), 8, 1e-9);
  EXPECT_NEAR(interface_area(complex, 0, 2), 12, 1e-9);
  EXPECT_NEAR(interface_area(complex, 1, 2), 12, 1e-9);
}

TEST(JoinBodies, APinThroughABracket) {
  const std::vector<Body> bodies{{"bracket", bored_block({30, 20, 10}, 5, 96, 1)},
                                 {"pin", moved(analytic::cylinder(5, 24, 120, 3), {0, 0, -7})}};
  const BodyComplex complex = join_bodies(bodies);
  expect_joined(complex, bodies, 1e-3);
  EXPECT_NEAR(interface_area(complex, 0, 1), 2 * std::numbers::pi * 5 * 10, 0.2);
  ASSERT_EQ(complex.contacts.size(), 1U);
  EXPECT_LT(complex.contacts[0].largest_gap, 5 * (1 - std::cos(std::numbers::pi / 96)) + 1e-9);
}

TEST(JoinBodies, APinThatIsFlush) {
  const std::vector<Body> bodies{{"bracket", bored_block({30, 20, 10}, 5, 96, 1)},
                                 {"pin", analytic::cylinder(5, 10, 120, 1)}};
  const BodyComplex complex = join_bodies(bodies);
  expect_joined(complex, bodies, 1e-3);
}

TEST(JoinBodies, APinThatEndsInTheBore) {
  const std::vector<Body> bodies{{"bracket", bored_block({30, 20, 10}, 5, 96, 1)},
                                 {"pin", moved(analytic::cylinder(5, 10, 120, 2), {0, 0, 4})}};
  const BodyComplex complex = join_bodies(bodies);
  expect_joined(complex, bodies, 1e-3);
  EXPECT_NEAR(interface_area(complex, 0, 1), 2 * std::numbers::pi * 5 * 6, 0.2);
}

TEST(JoinBodies, ACoatedBall) {
  const SurfaceMesh shell = analytic::join(analytic::sphere(10, 5), analytic::reversed(analytic::sphere(8, 5)));
  const std::vector<Body> bodies{{"coat", shell}, {"core", analytic::sphere(8, 4)}};
  const BodyComplex complex = join_bodies(bodies);
  expect_joined(complex, bodies, 3e-3);
  EXPECT_NEAR(interface_area(complex, 0, 1), 4 * std::numbers::pi * 64, 1);
}

TEST(JoinBodies, APlateOnACylindersEnd) {
  const std::vector<Body> bodies{{"rod", analytic::cylinder(4, 20, 64, 5)}, {"plate", box(14, 12, 2, 3, {-7, -6, 20})}};
  const BodyComplex complex = join_bodies(bodies);
  expect_joined(complex, bodies, 1e-6);
}

TEST(JoinBodies, ATWhoseFlangeIsLonger) {
  const std::vector<Body> bodies{{"web", box(20, 2, 10, 2, {0, -1, 0})}, {"flange", box(24, 8, 2, 2.5, {-2, -4, 10})}};
  const BodyComplex complex = join_bodies(bodies);
  expect_joined(complex, bodies, 1e-12);
  EXPECT_NEAR(interface_area(complex, 0, 1), 40, 1e-9);
}

// As in a real scan: no coordinate is round, and single precision.
std::vector<Body> elsewhere(std::vector<Body> bodies, double angle) {
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(angle, Vec3(1, 2, 3).normalized()));
  for (Body& body : bodies)
    for (Vec3& p : body.surface.vertices) p = (turn * p + Vec3(11, -7, 5)).cast<float>().cast<double>();
  return bodies;
}

TEST(JoinBodies, WhereverTheyLieAndInAnyOrder) {
  const Body bracket{"bracket", bored_block({30, 20, 10}, 5, 96, 2)};
  const Body pin{"pin", moved(analytic::cylinder(5, 24, 120, 3), {0, 0, -7})};
  const Body block{"block", box(8, 20, 4, 3, {-15, -10, 10})};
  for (int turn = 0; turn < 8; ++turn)
    for (const std::vector<Body>& bodies : {std::vector{bracket, pin, block}, std::vector{pin, block, bracket}}) {
      const std::vector<Body> turned = elsewhere(bodies, 0.4 * turn);
      const BodyComplex complex = join_bodies(turned);
      expect_joined(complex, turned, 2e-3);
      EXPECT_EQ(complex.contacts.size(), 2U);
    }
}

TEST(JoinBodies, GapsAndOverlapsBelowTheToleranceAreClosed) {
  for (const double offset : {-0.01, 0.01}) {
    const std::vector<Body> bodies{{"base", box(10, 8, 2, 2, {0, 0, 0})},
                                   {"top", box(4, 3, 5, 1.7, {3, 2, 2 + offset})}};
    const BodyComplex complex = join_bodies(bodies, {.tolerance = 0.02});
    expect_joined(complex, bodies, 0.003);
    ASSERT_EQ(complex.contacts.size(), 1U);
    EXPECT_NEAR(complex.contacts[0].largest_gap - complex.contacts[0].largest_overlap, offset, 1e-9);
    EXPECT_GT(complex.contacts[0].triangles, 0U);
  }
}

std::string failure_of(const std::vector<Body>& bodies, const JoinOptions& options = {}) {
  try {
    join_bodies(bodies, options);
  } catch (const NotMeshable& e) {
    return e.what();
  }
  return "";
}

std::vector<Body> stacked(double gap) {
  return {{"base", box(10, 8, 2, 2, {0, 0, 0})}, {"top", box(4, 3, 5, 1.7, {3, 2, 2 + gap})}};
}

TEST(JoinBodies, LargerGapsAreAnErrorWhoseAdviceWorks) {
  const std::string failure = failure_of(stacked(0.001));
  EXPECT_NE(failure.find("gap between the bodies"), std::string::npos) << failure;
  EXPECT_NE(failure.find("base and top"), std::string::npos) << failure;
  const std::size_t at = failure.find("--contact ");
  ASSERT_NE(at, std::string::npos) << failure;
  const double closing = std::stod(failure.substr(at + 10));
  EXPECT_EQ(join_bodies(stacked(0.001), {.tolerance = closing}).contacts.size(), 1U);
  const double leaving = std::stod(failure.substr(failure.find("--contact ", at + 1) + 10));
  EXPECT_EQ(join_bodies(stacked(0.001), {.tolerance = leaving}).contacts.size(), 0U);
}

TEST(JoinBodies, LargerOverlapsAreAnErrorWhoseAdviceWorks) {
  for (const double depth : {0.01, 0.2}) {
    const std::string failure = failure_of(stacked(-depth));
    EXPECT_NE(failure.find("overlap"), std::string::npos) << failure;
    const std::size_t at = failure.find("--contact ");
    ASSERT_NE(at, std::string::npos) << failure;
    const BodyComplex complex = join_bodies(stacked(-depth), {.tolerance = std::stod(failure.substr(at + 10))});
    ASSERT_EQ(complex.contacts.size(), 1U);
    EXPECT_NEAR(complex.contacts[0].largest_overlap, depth, 1e-9);
  }
}

TEST(JoinBodies, OneWithinAnothersMaterialIsAnOverlap) {
  EXPECT_NE(failure_of({{"block", box(10, 10, 10, 3, {0, 0, 0})}, {"pin", box(2, 2, 2, 1, {4, 4, 4})}}).find("overlap"),
            std::string::npos);
}

// As large a tolerance as an error's advice once was: two solids in one place are no contact.
TEST(JoinBodies, OneWithinAnothersMaterialIsOneWhateverTheTolerance) {
  const std::vector<Body> bodies{{"big", box(20, 20, 10, 20, {0, 0, 0})}, {"inner", box(7, 8, 6, 8, {5, 5, 2})}};
  EXPECT_THROW(join_bodies(bodies, {.tolerance = 2.02}), NotMeshable);
  EXPECT_THROW(join_bodies(std::vector<Body>{bodies[1], bodies[0]}, {.tolerance = 2.02}), NotMeshable);
}

// Each in several places and sizes, and in single precision where it does not lie as it was made.
std::vector<std::vector<Body>> in_places(const std::vector<Body>& bodies) {
  std::vector<std::vector<Body>> placed{bodies};
  for (const double scale : {0.001, 1.0, 25.4}) {
    const Eigen::Matrix3d turn(Eigen::AngleAxisd(0.7 + scale, Vec3(3, 1, 2).normalized()));
    std::vector<Body>& other = placed.emplace_back(bodies);
    for (Body& body : other)
      for (Vec3& p : body.surface.vertices) p = (scale * (turn * p + Vec3(3, -5, 2))).cast<float>().cast<double>();
  }
  return placed;
}

struct TouchingCase {
  std::string name;
  std::vector<Body> bodies;
  double length;  // of the line; 0: a point
};

std::vector<TouchingCase> touching_cases() {
  const SurfaceMesh cube = box(2, 2, 2, 0.7, {0, 0, 0});
  const auto rod = [](double angle) {
    SurfaceMesh lying = analytic::cylinder(1, 6, 24, 3);
    const Eigen::Matrix3d turn(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY()) *
                               Eigen::AngleAxisd(angle, Vec3::UnitZ()));
    for (Vec3& p : lying.vertices) p = turn * p;
    double lowest = 0;
    for (const Vec3& p : lying.vertices) lowest = std::min(lowest, p.z());
    return moved(lying, {-3, 0, -lowest});
  };
  SurfaceMesh tip = box(2, 2, 2, 0.7, {-1, -1, -1});  // on a corner
  const Eigen::Matrix3d stand(Eigen::Quaterniond::FromTwoVectors(Vec3(1, 1, 1), Vec3(0, 0, 1)));
  for (Vec3& p : tip.vertices) p = stand * p;
  return {
      {"an edge", {{"a", cube}, {"b", box(2, 2, 2, 0.9, {2, 2, 0})}}, 2},
      {"a piece of an edge", {{"a", cube}, {"b", box(2, 2, 2, 0.9, {2, 2, 1})}}, 1},
      {"a corner", {{"a", cube}, {"b", box(2, 2, 2, 0.9, {2, 2, 2})}}, 0},
      {"an edge in a face", {{"a", box(6, 6, 1, 1, {-3, -3, -1})}, {"b", rod(0)}}, 6},
      {"a corner in a face", {{"a", box(6, 6, 1, 1, {-3.1, -3.2, -1})}, {"b", moved(tip, {0, 0, std::sqrt(3.0)})}}, 0}};
}

TEST(JoinBodies, WhatTouchesAlongALineOrAtAPointIsDrawnApartAndTold) {
  for (const TouchingCase& c : touching_cases())
    for (const std::vector<Body>& bodies : in_places(c.bodies)) {
      SCOPED_TRACE(c.name);
      const double scale = std::cbrt(enclosed_volume(bodies[0].surface) / enclosed_volume(c.bodies[0].surface));
      const BodyComplex complex = join_bodies(bodies);
      EXPECT_TRUE(find_self_intersections(complex.mesh).empty());
      expect_joined(complex, bodies, 5e-3);
      if (complex.touches.empty()) continue;  // rounding has parted them, or made a strip of the line
      expect_joined(complex, bodies, 1e-4);
      EXPECT_TRUE(complex.contacts.empty());
      ASSERT_EQ(complex.touches.size(), 1U);
      EXPECT_LE(complex.touches[0].length, scale * (1.01 * c.length + 1e-6));
      EXPECT_LT(complex.touches[0].moved, 1e-4 * scale);
      EXPECT_LT(complex.touches[0].at.norm(), 1e3 * scale);
    }
  // As they were made nothing is rounded; facets beside an edge that lies on a face may lie on it, too.
  for (const TouchingCase& c : touching_cases()) {
    const BodyComplex complex = join_bodies(c.bodies);
    ASSERT_EQ(complex.touches.size() + complex.contacts.size(), 1U) << c.name;
    if (!complex.touches.empty()) {
      EXPECT_NEAR(complex.touches[0].length, c.length, 0.01 * c.length) << c.name;
    }
  }
}

TEST(JoinBodies, OneBodyTwiceIsSaidToBe) {
  const SurfaceMesh cube = box(2, 3, 2, 0.7, {0, 0, 0});
  for (const SurfaceMesh& again : {cube, box(2, 3, 2, 0.9, {0, 0, 0})})
    EXPECT_NE(failure_of({{"a", cube}, {"b", again}}).find("one and the same"), std::string::npos)
        << failure_of({{"a", cube}, {"b", again}});
}

TEST(JoinBodies, BarsThatCrossAreToldSo) {
  const std::string failure = failure_of({{"a", box(10, 1, 1, 20, {0, 0, 0})}, {"b", box(1, 10, 1, 20, {4, -4, 0.3})}});
  EXPECT_NE(failure.find("the bodies cross"), std::string::npos) << failure;
  EXPECT_EQ(failure.find("--contact"), std::string::npos) << failure;
}

TEST(JoinBodies, NoBodyChangesItsVolumeByMoreThanIsTold) {
  const std::vector<Body> bodies{{"base", box(10, 8, 2, 2, {0, 0, 0})}, {"foil", box(4, 3, 0.7, 1.7, {3, 2, 2.1})}};
  const std::string failure = failure_of(bodies, {.tolerance = 0.11});
  EXPECT_NE(failure.find("changes the volume"), std::string::npos) << failure;
  EXPECT_NE(failure.find("foil"), std::string::npos) << failure;
}

TEST(JoinBodies, AGapThatStaysOpenIsToldWithItsPlaceAndSize) {
  const std::vector<Body> bodies{{"base", box(10, 8, 2, 2, {0, 0, 0})}, {"top", box(4, 3, 5, 1.7, {3, 2, 2.05})}};
  const BodyComplex complex = join_bodies(bodies);
  ASSERT_EQ(complex.gaps.size(), 1U);
  EXPECT_NEAR(complex.gaps[0].size, 0.05, 1e-9);
  EXPECT_NEAR(complex.gaps[0].at.z(), 2.025, 1e-9);
  // What lies between two bodies is no gap of theirs.
  const std::vector<Body> filled{bodies[0], bodies[1], {"foil", box(4, 3, 0.05, 1.1, {3, 2, 2})}};
  EXPECT_TRUE(join_bodies(filled).gaps.empty());
}

TEST(JoinBodies, FarBodiesStayAsTheyAre) {
  const std::vector<Body> bodies{{"a", box(4, 3, 2, 1, {0, 0, 0})}, {"b", box(5, 3, 2, 0.7, {6, 0, 0})}};
  const BodyComplex complex = join_bodies(bodies);
  EXPECT_TRUE(complex.contacts.empty());
  EXPECT_EQ(complex.mesh.triangles.size(), bodies[0].surface.triangles.size() + bodies[1].surface.triangles.size());
}

}  // namespace
}  // namespace scan2fea
