// Several bodies in one file: that touch along faces, edges or vertices, that pass through themselves, lie within one
// another, or are debris. And what looks like damage but is the part.
#include "preproc/surface/repair/repair.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/surfaces_to_repair.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

namespace scan2fea {
namespace {

using ::testing::HasSubstr;

SurfaceMesh box(const Vec3& low, const Vec3& high, double edge_length) {
  return analytic::moved(analytic::box(high - low, edge_length), low);
}

// Each square of a box cut along its other diagonal.
SurfaceMesh other_diagonal(SurfaceMesh mesh) {
  for (std::size_t f = 0; f + 1 < mesh.triangles.size(); f += 2) {
    const Triangle a = mesh.triangles[f], b = mesh.triangles[f + 1];  // ijk, ikl
    mesh.triangles[f] = {a[1], a[2], b[2]};
    mesh.triangles[f + 1] = {b[2], a[0], a[1]};
  }
  return mesh;
}

SurfaceMesh joined(const std::vector<SurfaceMesh>& parts) {
  SurfaceMesh all;
  for (const SurfaceMesh& part : parts) all = analytic::join(all, part);
  return all;
}

// Of solids whose faces are square to the axes: each face of the result lies in the plane of one of the input.
void expect_planes_of(const SurfaceMesh& mesh, const SurfaceMesh& input, double tolerance) {
  for (const Triangle& t : mesh.triangles) {
    const Vec3 normal = area_vector(mesh, t).normalized();
    int axis = 0;
    const double along = normal.cwiseAbs().maxCoeff(&axis);
    EXPECT_NEAR(along, 1, 1e-9);
    const double at = mesh.vertices[t[0]][axis];
    double nearest = 1;
    for (const Vec3& p : input.vertices) nearest = std::min(nearest, std::abs(p[axis] - at));
    EXPECT_LE(nearest, tolerance);
  }
}

void expect_one_body(const SurfaceMesh& input, double volume, int genus, double tolerance = 1e-9) {
  SurfaceMesh mesh = input;
  repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(check_validity(mesh).components, 1u);
  EXPECT_EQ(check_validity(mesh).genus, genus);
  EXPECT_NEAR(enclosed_volume(mesh), volume, tolerance * volume);
  expect_planes_of(mesh, input, tolerance);
}

TEST(RepairBodies, BoxesThatShareAFaceBecomeOneHoweverItIsCut) {
  for (const double edge : {20.0, 5.0}) {
    const SurfaceMesh a = box({0, 0, 0}, {20, 20, 20}, edge), b = box({20, 0, 0}, {50, 20, 20}, edge);
    for (const SurfaceMesh& beside : {b, other_diagonal(b), box({20, 0, 0}, {50, 20, 20}, 4), analytic::reversed(b),
                                      box({20, 0, 0}, {50, 20, 20}, 30)}) {
      expect_one_body(analytic::join(a, beside), 20 * 20 * 50, 0);
      expect_one_body(analytic::join(beside, a), 20 * 20 * 50, 0);
      expect_one_body(torn(analytic::join(a, beside)), 20 * 20 * 50, 0);
      expect_one_body(welded(analytic::join(a, beside)), 20 * 20 * 50, 0);
    }
  }
}

// In 32-bit floats the planes of contact are the same, but the boxes of other sides may lie a step off.
TEST(RepairBodies, BoxesTurnedInSpaceThatShareAFaceBecomeOne) {
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
  for (const double edge : {20.0, 5.0, 7.0})
    for (const bool floats : {false, true}) {
      SCOPED_TRACE(std::to_string(edge) + (floats ? ", floats" : ", doubles"));
      SurfaceMesh mesh = analytic::join(box({0, 0, 0}, {20, 20, 20}, 5), box({20, 0, 0}, {50, 20, 20}, edge));
      for (Vec3& p : mesh.vertices) {
        p = turn * p;
        if (floats) p = p.cast<float>().cast<double>();
      }
      repair(mesh);
      expect_sound(mesh);
      EXPECT_EQ(check_validity(mesh).components, 1u);
      EXPECT_NEAR(enclosed_volume(mesh), 20000, floats ? 0.1 : 1e-6);
      for (Vec3& p : mesh.vertices) p = turn.inverse() * p;
      expect_planes_of(mesh, joined({box({0, 0, 0}, {20, 20, 20}, 20), box({20, 0, 0}, {50, 20, 20}, 30)}), 1e-5);
    }
}

TEST(RepairBodies, PartialContact) {
  const SurfaceMesh plate = box({0, 0, 0}, {40, 30, 5}, 5);
  expect_one_body(joined({plate, box({7, 8, 5}, {13, 14, 25}, 3)}), 6000 + 720, 0);           // within a side
  expect_one_body(joined({plate, box({-4, 8, 5}, {6, 14, 9}, 3)}), 6000 + 240, 0);            // over an edge
  expect_one_body(joined({plate, box({30, 20, 5}, {40, 30, 15}, 5)}), 6000 + 1000, 0);        // flush at a corner
  expect_one_body(joined({plate, box({30, 20, 5}, {40, 30, 15}, 4)}), 6000 + 1000, 0);        // flush, cut otherwise
  expect_one_body(joined({plate, box({35, 25, 5}, {60, 50, 10}, 2.5)}), 6000 + 25 * 125, 0);  // over a corner
  expect_one_body(joined({plate, box({0, 10, 5}, {40, 11, 6}, 40)}), 6000 + 40, 0);           // from side to side
}

TEST(RepairBodies, SeveralBoxesInARowAnLACrossAndARing) {
  for (const double edge : {10.0, 5.0, 3.0}) {
    SCOPED_TRACE(edge);
    const auto cube = [&](int i, int j, double length) {
      return box({10.0 * i, 10.0 * j, 0}, {10.0 * i + 10, 10.0 * j + 10, 10}, length);
    };
    expect_one_body(joined({cube(0, 0, 10), cube(1, 0, edge), cube(2, 0, 10), cube(3, 0, edge)}), 4000, 0);
    expect_one_body(joined({cube(0, 0, 10), cube(1, 0, edge), cube(1, 1, 10)}), 3000, 0);
    expect_one_body(joined({cube(0, 0, 5), cube(1, 0, edge), cube(-1, 0, edge), cube(0, 1, edge), cube(0, -1, edge)}),
                    5000, 0);
    // Four that meet in one edge.
    expect_one_body(joined({cube(0, 0, 5), cube(1, 0, edge), cube(0, 1, edge), cube(1, 1, 10)}), 4000, 0);
    std::vector<SurfaceMesh> ring;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (i != 1 || j != 1) ring.push_back(cube(i, j, (i + j) % 2 == 0 ? 10 : edge));
    expect_one_body(joined(ring), 8000, 1);
  }
}

// Eight boxes that meet in one vertex, and seven: the eighth is a notch.
TEST(RepairBodies, BoxesAboutOneVertex) {
  for (const int count : {7, 8})
    for (const double edge : {10.0, 5.0}) {
      std::vector<SurfaceMesh> boxes;
      for (int i = 0; i < count; ++i) {
        const Vec3 low = 10 * Vec3(i & 1, (i >> 1) & 1, (i >> 2) & 1);
        boxes.push_back(box(low, low + Vec3::Constant(10), i % 2 == 0 ? 10 : edge));
      }
      expect_one_body(joined(boxes), 1000 * count, 0);
    }
}

// A box in the notch of another: contact on two and on three sides.
TEST(RepairBodies, ContactOnSeveralSides) {
  const SurfaceMesh step = joined({box({0, 0, 0}, {20, 10, 10}, 5), box({0, 0, 10}, {10, 10, 20}, 5)});
  for (const double edge : {10.0, 5.0, 2.5})
    expect_one_body(joined({step, box({10, 0, 10}, {20, 10, 20}, edge)}), 4000, 0);
  SurfaceMesh slot =
      joined({box({0, 0, 0}, {30, 10, 10}, 5), box({0, 0, 10}, {10, 10, 20}, 5), box({20, 0, 10}, {30, 10, 20}, 5)});
  repair(slot);
  for (const double edge : {10.0, 5.0, 4.0})
    expect_one_body(joined({slot, box({10, 0, 10}, {20, 10, 20}, edge)}), 6000, 0);
}

TEST(RepairBodies, RoundContact) {
  const double height = 7;
  for (const int around : {24, 25, 60}) {
    SCOPED_TRACE(around);
    const SurfaceMesh stud = analytic::cylinder(3, height, around, 2);
    SurfaceMesh on_plate = joined({box({-10, -10, -4}, {10, 10, 0}, 5), stud});
    const double wanted = 1600 + enclosed_volume(stud);
    repair(on_plate);
    expect_sound(on_plate);
    EXPECT_EQ(check_validity(on_plate).components, 1u);
    EXPECT_NEAR(enclosed_volume(on_plate), wanted, 1e-9 * wanted);

    const SurfaceMesh other = analytic::moved(analytic::cylinder(3, 4, 24, 1), {0, 0, height});
    SurfaceMesh end_to_end = joined({stud, other});
    repair(end_to_end);
    expect_sound(end_to_end);
    EXPECT_EQ(check_validity(end_to_end).components, 1u);
    EXPECT_NEAR(enclosed_volume(end_to_end), enclosed_volume(stud) + enclosed_volume(other), 1e-9 * wanted);
  }
}

// A pin in the bore that it fits: the facets of both lie upon one another.
TEST(RepairBodies, APinInItsBore) {
  const int around = 32;
  const SurfaceMesh outer = analytic::cylinder(10, 8, around, 1);
  SurfaceMesh tube;  // the outer wall, the bore turned inwards, and rings between their rims
  const auto n = static_cast<std::uint32_t>(around);
  for (const double r : {10.0, 4.0})
    for (const double z : {0.0, 8.0})
      for (int i = 0; i < around; ++i)
        tube.vertices.push_back(
            {r * std::cos(2 * std::numbers::pi * i / around), r * std::sin(2 * std::numbers::pi * i / around), z});
  const auto strip = [&](std::uint32_t low, std::uint32_t high) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t j = (i + 1) % n;
      tube.triangles.push_back({low * n + i, low * n + j, high * n + j});
      tube.triangles.push_back({low * n + i, high * n + j, high * n + i});
    }
  };
  strip(0, 1);
  strip(1, 3);
  strip(3, 2);
  strip(2, 0);
  ASSERT_NEAR(enclosed_volume(tube), enclosed_volume(outer) * (1 - 0.16), 1e-9);
  for (const int along : {1, 4}) {
    SurfaceMesh mesh = joined({tube, analytic::cylinder(4, 8, around, along)});
    repair(mesh);
    expect_sound(mesh);
    EXPECT_EQ(check_validity(mesh).components, 1u);
    EXPECT_EQ(check_validity(mesh).genus, 0);
    EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(outer), 1e-9 * enclosed_volume(outer));
  }
}

TEST(RepairBodies, WhatTouchesInAnEdgeOrAVertexStaysTwoBodies) {
  for (const double edge : {10.0, 5.0, 4.0})
    for (const Vec3& by : {Vec3(10, 10, 0), Vec3(10, 10, 3), Vec3(10, 10, 10)})
      for (const bool is_welded : {false, true}) {
        SCOPED_TRACE(std::to_string(edge) + (is_welded ? ", welded" : ""));
        const SurfaceMesh input =
            analytic::join(box({0, 0, 0}, {10, 10, 10}, 5), box(by, by + Vec3::Constant(10), edge));
        SurfaceMesh mesh = is_welded ? welded(input) : input;
        repair(mesh);
        expect_sound(mesh);
        EXPECT_EQ(check_validity(mesh).components, 2u);
        EXPECT_NEAR(enclosed_volume(mesh), 2000, 2000 * 1e-5);
        double farthest = 0;
        for (const Vec3& p : mesh.vertices) {
          double nearest = 1;
          for (const Vec3& q : input.vertices) nearest = std::min(nearest, (p - q).norm());
          farthest = std::max(farthest, nearest);
        }
        EXPECT_LE(farthest, 0.05 + 1e-9);
        expect_planes_of(mesh, input, 1e-4);
      }
}

// A tube about a closed curve, outwards.
template <class Curve>
SurfaceMesh tube_about(const Curve& curve, double radius, int along, int around) {
  SurfaceMesh mesh;
  const auto index = [&](int i, int j) { return static_cast<std::uint32_t>((i % along) * around + j % around); };
  for (int i = 0; i < along; ++i) {
    const double step = 2 * std::numbers::pi / along, t = step * i;
    const Vec3 tangent = (curve(t + step / 2) - curve(t - step / 2)).normalized();
    const Vec3 across = tangent.cross(Vec3::UnitZ()).normalized(), up = across.cross(tangent);
    for (int j = 0; j < around; ++j) {
      const double angle = 2 * std::numbers::pi * j / around;
      mesh.vertices.push_back(curve(t) + radius * (std::cos(angle) * across + std::sin(angle) * up));
      mesh.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
      mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
    }
  }
  return enclosed_volume(mesh) > 0 ? mesh : analytic::reversed(mesh);
}

TEST(RepairBodies, ATubeThatPassesThroughItselfIsJoinedThere) {
  for (const int petals : {2, 3})
    for (const int around : {16, 31}) {
      SCOPED_TRACE(std::to_string(petals) + " petals, " + std::to_string(around));
      const auto curve = [&](double t) -> Vec3 {
        return petals == 2 ? 40 * Vec3(std::cos(t), std::sin(t) * std::cos(t), 0) / (1 + std::pow(std::sin(t), 2))
                           : Vec3(20 * std::sin(t) + 30 * std::sin(2 * t), 20 * std::cos(t) - 30 * std::cos(2 * t), 0);
      };
      const SurfaceMesh tube = tube_about(curve, 3, 240, around);
      SurfaceMesh mesh = tube;
      const RepairResult result = repair(mesh);
      expect_sound(mesh);
      EXPECT_EQ(result.count(RepairKind::SmoothedFold), 0U);  // which would lose volume
      EXPECT_EQ(check_validity(mesh).components, 1u);
      // One loop more for each of the crossings, of which the eight has one and the trefoil three.
      EXPECT_EQ(check_validity(mesh).genus, petals == 2 ? 2 : 4);
      const double volume = enclosed_volume(tube);
      EXPECT_LT(enclosed_volume(mesh), volume);
      EXPECT_GT(enclosed_volume(mesh), volume - (petals == 2 ? 1 : 3) * 16 * 27 / 3.0 * 1.3);
    }
}

TEST(RepairBodies, ShellsWithinShellsWhateverTheirOrientation) {
  std::vector<SurfaceMesh> shells;
  for (const double r : {10.0, 8.0, 6.0, 4.0, 2.0}) shells.push_back(analytic::sphere(r, 3));
  double wanted = 0;
  for (std::size_t i = 0; i < shells.size(); ++i) wanted += (i % 2 == 0 ? 1 : -1) * enclosed_volume(shells[i]);
  for (unsigned turned = 0; turned < 32; ++turned) {
    SurfaceMesh mesh;
    for (std::size_t i = 0; i < shells.size(); ++i) {
      const std::size_t k = (i * 3) % shells.size();  // in any order
      mesh = analytic::join(mesh, ((turned >> k) & 1) != 0 ? analytic::reversed(shells[k]) : shells[k]);
    }
    repair(mesh);
    expect_sound(mesh);
    EXPECT_EQ(check_validity(mesh).components, 5u);
    EXPECT_NEAR(enclosed_volume(mesh), wanted, 1e-9 * wanted) << turned;
  }
}

TEST(RepairBodies, SpecksOpenAndClosedAreDroppedAndTold) {
  const SurfaceMesh body = analytic::sphere(20, 4);
  SurfaceMesh mesh = body;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> one(-1, 1);
  const std::size_t count = 200;
  for (std::size_t i = 0; i < count; ++i) {
    Vec3 place(one(random), one(random), one(random));
    place *= (25 + 30 * std::abs(one(random))) / place.norm();
    SurfaceMesh speck = analytic::sphere(0.05 + 0.3 * std::abs(one(random)), i % 2 == 0 ? 0 : 1);
    if (i % 3 == 0) speck.triangles.resize(speck.triangles.size() / 2);
    mesh = analytic::join(mesh, analytic::moved(speck, place));
  }
  const RepairResult result = repair(mesh);
  EXPECT_EQ(mesh.triangles, body.triangles);
  EXPECT_EQ(mesh.vertices, body.vertices);
  EXPECT_EQ(result.count(RepairKind::DroppedSpeck) + result.count(RepairKind::DroppedFragment), count);
}

// Long thin bodies far apart are small beside the whole, and bodies all the same.
TEST(RepairBodies, BodiesFarApartStay) {
  for (const double apart : {300.0, 4000.0, 1e6}) {
    SurfaceMesh mesh = joined({box({0, 0, 0}, {200, 2, 2}, 2), box({apart, 0, 0}, {apart + 150, 3, 1}, 1)});
    const SurfaceMesh input = mesh;
    EXPECT_TRUE(repair(mesh).unchanged());
    EXPECT_EQ(mesh.triangles, input.triangles);
    EXPECT_EQ(mesh.vertices, input.vertices);
  }
}

TEST(RepairBodies, ThinAndSharpPartsStayBitByBit) {
  SurfaceMesh wedge = box({0, 0, 0}, {50, 20, 1}, 5);  // to a knife's edge of 0.01 and 0.001 degrees
  SurfaceMesh finer = wedge;
  for (Vec3& p : wedge.vertices) p.z() *= 50 * std::tan(0.01 * std::numbers::pi / 180) * (1 - p.x() / 50) + 1e-6;
  for (Vec3& p : finer.vertices) p.z() *= 50 * std::tan(1e-3 * std::numbers::pi / 180) * (1 - p.x() / 50) + 1e-6;
  for (const SurfaceMesh& part :
       {wedge, finer, analytic::lens(1, 60, 10), analytic::lens(0.05, 60, 10), box({0, 0, 0}, {100, 100, 0.01}, 5),
        analytic::block_with_fin(1), analytic::plate({100, 80, 0.05}, 4)}) {
    SurfaceMesh mesh = part;
    EXPECT_TRUE(repair(mesh).unchanged());
    EXPECT_EQ(mesh.vertices, part.vertices);
    EXPECT_EQ(mesh.triangles, part.triangles);
  }
}

// A thin part whose faces have no common vertices in the file is welded, not thinned.
TEST(RepairBodies, ThinPartsAsSoupAreWeldedAsTheyAre) {
  for (const double thickness : {1.0, 0.1, 0.01, 1e-3}) {
    SCOPED_TRACE(thickness);
    const SurfaceMesh part = box({0, 0, 0}, {100, 80, thickness}, 10);
    SurfaceMesh mesh = torn(part);
    repair(mesh);
    expect_sound(mesh);
    EXPECT_NEAR(enclosed_volume(mesh), 8000 * thickness, 1e-9 * thickness * 8000);
    EXPECT_EQ(mesh.triangles.size(), part.triangles.size());
  }
}

TEST(RepairBodies, APanelWithItsBackInTheSamePlaceEnclosesNothing) {
  SurfaceMesh front = analytic::sheet(60, 40, 4);
  for (Vec3& p : front.vertices) p.z() = 3 * std::sin(p.x() / 9);
  for (const SurfaceMesh& back : {analytic::reversed(front), front})
    for (const double away : {0.0, 1e-9}) {
      const SurfaceMesh panel = analytic::join(front, analytic::moved(back, {0, 0, away}));
      message_of_failure(panel);
      message_of_failure(welded(panel));
      message_of_failure(torn(panel));
    }
}

}  // namespace
}  // namespace scan2fea
