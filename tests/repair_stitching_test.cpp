// Surfaces whose faces miss one another by little: float steps, seams, corners apart, corners on the edges of others.
#include "preproc/surface/repair/repair.hpp"
#include "quality/deviation.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/surfaces_to_repair.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <string>

namespace scan2fea {
namespace {

using Move = std::function<Vec3(const Vec3&)>;

// Faces of one group keep common vertices, which `move` (called once for each group's vertex) puts elsewhere.
template <class Group>
SurfaceMesh parted(const SurfaceMesh& mesh, const Group& group_of, const Move& move) {
  std::map<std::pair<int, std::uint32_t>, std::uint32_t> number;
  SurfaceMesh apart;
  for (Triangle t : mesh.triangles) {
    const int group = group_of(t);
    for (std::uint32_t& v : t) {
      const auto [at, is_new] = number.try_emplace({group, v}, static_cast<std::uint32_t>(apart.vertices.size()));
      if (is_new) apart.vertices.push_back(move(mesh.vertices[v]));
      v = at->second;
    }
    apart.triangles.push_back(t);
  }
  return apart;
}

Vec3 centre(const SurfaceMesh& mesh, const Triangle& t) {
  return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
}

// Which of the six sides of a box a face lies on.
int side_of(const SurfaceMesh& mesh, const Triangle& t) {
  const Vec3 normal = area_vector(mesh, t);
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return 2 * axis + (normal[axis] > 0);
}

// Anywhere within a ball of this radius.
Move within(double radius, unsigned seed) {
  return [radius, random = std::mt19937(seed)](const Vec3& p) mutable -> Vec3 {
    std::uniform_real_distribution<double> one(-1, 1);
    Vec3 d;
    do d = Vec3(one(random), one(random), one(random));
    while (d.norm() > 1);
    return p + radius * d;
  };
}

Move float_steps(unsigned seed) {
  return [random = std::mt19937(seed)](const Vec3& p) mutable -> Vec3 {
    constexpr float far = std::numeric_limits<float>::max();
    Vec3 moved;
    for (int k = 0; k < 3; ++k) {
      const auto x = static_cast<float>(p[k]);
      const int step = std::uniform_int_distribution<int>(-1, 1)(random);
      moved[k] = step == 0 ? x : std::nextafter(x, step > 0 ? far : -far);
    }
    return moved;
  };
}

// Each face's own corners, moved.
SurfaceMesh torn_and_moved(const SurfaceMesh& mesh, const Move& move) {
  int next = 0;
  return parted(
      mesh, [&](const Triangle&) { return next++; }, move);
}

// What a repair may do to a surface whose faces miss one another by no more than `gap`: close it, by joining vertices
// where they are.
void expect_stitched(const SurfaceMesh& damaged, const SurfaceMesh& whole, double gap, double volume_tolerance) {
  SurfaceMesh mesh = damaged;
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  const SurfaceValidity validity = check_validity(mesh), wanted = check_validity(whole);
  EXPECT_EQ(validity.components, wanted.components);
  EXPECT_EQ(validity.genus, wanted.genus);
  EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(whole), volume_tolerance * enclosed_volume(whole));
  EXPECT_EQ(result.count(RepairKind::ClosedHole), 0u);
  EXPECT_EQ(result.count(RepairKind::Intersection), 0u);
  EXPECT_EQ(result.count(RepairKind::DroppedFragment), 0u);
  for (const RepairChange& change : result.changes)
    if (change.kind == RepairKind::WeldedVertex || change.kind == RepairKind::SplitEdge) {
      EXPECT_LE(change.size, gap * (1 + 1e-9)) << change.place.transpose();
    }
}

std::vector<std::pair<std::string, SurfaceMesh>> bodies() {
  return {{"ball", analytic::sphere(25, 3)},
          {"ring", analytic::moved(analytic::torus(9, 2, 40, 16), {31, -7, 12})},
          {"cylinder", analytic::cylinder(4, 30, 32, 12)},
          {"box", analytic::moved(analytic::box({60, 40, 20}, 5), {100, 0.3, -20})},
          {"slab", analytic::slab_with_holes(3, 0.5)}};
}

double shortest_edge(const SurfaceMesh& mesh) {
  double shortest = std::numeric_limits<double>::max();
  for (const Triangle& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      shortest = std::min(shortest, (mesh.vertices[t[i]] - mesh.vertices[t[(i + 1) % 3]]).norm());
  return shortest;
}

TEST(RepairStitching, CornersAFloatStepApartAreJoined) {
  for (const auto& [name, whole] : bodies()) {
    SCOPED_TRACE(name);
    const double step = bounding_box(whole.vertices).high.cwiseAbs().maxCoeff() * 4 * 1.2e-7;
    expect_stitched(torn_and_moved(whole, float_steps(3)), whole, step, 1e-5);
  }
}

TEST(RepairStitching, CornersApartAreJoinedWhateverTheGap) {
  for (const auto& [name, whole] : bodies())
    for (const double gap : {1e-7, 1e-6, 1e-5, 1e-4, 1e-3}) {
      SCOPED_TRACE(name + ", gap " + std::to_string(gap * 1e6) + "e-6 of an edge");
      const double distance = gap * shortest_edge(whole);
      expect_stitched(torn_and_moved(whole, within(distance / 2, 5)), whole, distance, 4 * gap);
    }
}

TEST(RepairStitching, FacesTessellatedOneByOneAreJoined) {
  const SurfaceMesh whole = analytic::box({60, 40, 20}, 5);
  for (const double gap : {1e-8, 1e-5, 1e-3, 0.01}) {
    SCOPED_TRACE(gap);
    const SurfaceMesh apart = parted(
        whole, [&](const Triangle& t) { return side_of(whole, t); }, within(gap / 2, 7));
    expect_stitched(apart, whole, gap, gap);
  }
}

// One part of the surface as a whole lies a little off the other.
TEST(RepairStitching, SeamsAreJoined) {
  for (const auto& [name, whole] : bodies())
    for (const double gap : {1e-6, 1e-4, 2e-3}) {
      SCOPED_TRACE(name + ", gap " + std::to_string(gap));
      const double middle = centre(whole, whole.triangles[0])[0];
      const Vec3 shift = gap * Vec3(1, -2, 2) / 3;
      SurfaceMesh apart = parted(
          whole, [&](const Triangle& t) { return centre(whole, t)[0] > middle; }, [](const Vec3& p) { return p; });
      std::vector<char> far(apart.vertices.size(), 0);
      for (const Triangle& t : apart.triangles)
        if (centre(apart, t)[0] > middle)
          for (const std::uint32_t v : t) far[v] = 1;
      for (std::size_t v = 0; v < far.size(); ++v)
        if (far[v]) apart.vertices[v] += shift;
      expect_stitched(apart, whole, gap, gap);
    }
}

// Gaps of two causes: a float step everywhere, and a seam a thousand times as wide.
TEST(RepairStitching, AWideSeamBesideFloatStepsIsJoinedToo) {
  const SurfaceMesh whole = analytic::sphere(25, 3);
  SurfaceMesh apart = torn_and_moved(whole, float_steps(9));
  for (const Triangle& t : apart.triangles)
    if (centre(apart, t)[2] > 0)
      for (const std::uint32_t v : t) apart.vertices[v] += Vec3(6e-4, 0, 8e-4);
  expect_stitched(apart, whole, 1.1e-3, 1e-3);
}

// A hole stays a hole while the seams around it close.
TEST(RepairStitching, AHoleIsNotTakenForASeam) {
  const SurfaceMesh whole =
      without_faces(analytic::sphere(10, 3), [](const Vec3& c) { return (c - Vec3(0, 0, 10)).norm() < 2; });
  SurfaceMesh mesh = torn_and_moved(whole, float_steps(2));
  const RepairResult result = repair(mesh, {.holes = Holes::keep});
  EXPECT_EQ(check_validity(mesh).boundary_edges, check_validity(whole).boundary_edges);
  EXPECT_TRUE(check_validity(mesh).manifold());
  EXPECT_EQ(mesh.triangles.size(), whole.triangles.size());

  mesh = torn_and_moved(whole, float_steps(2));
  EXPECT_EQ(repair(mesh).count(RepairKind::ClosedHole), 1u);
  expect_sound(mesh);
}

// A side of some faces gets corners that the neighbour does not have.
SurfaceMesh with_corners_on_edges(SurfaceMesh mesh, double share, int corners, double beside, bool both_sides) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> one(0, 1);
  std::set<std::pair<std::uint32_t, std::uint32_t>> done;
  for (std::size_t f = 0, n = mesh.triangles.size(); f < n; ++f) {
    if (one(random) > share) continue;
    Triangle t = mesh.triangles[f];
    std::rotate(t.begin(), t.begin() + std::uniform_int_distribution<int>(0, 2)(random), t.end());
    if (!done.insert(std::minmax(t[0], t[1])).second && !both_sides) continue;
    const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]];
    const Move move = within(beside * (b - a).norm(), random());
    std::uint32_t last = t[0];
    for (int i = 1; i <= corners; ++i) {
      const auto corner = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(move(a + (b - a) * (i + 0.4 * one(random) - 0.2) / (corners + 1)));
      mesh.triangles.push_back({last, corner, t[2]});
      last = corner;
    }
    mesh.triangles[f] = {last, t[1], t[2]};
  }
  return mesh;
}

TEST(RepairStitching, EdgesAreSplitAtTheCornersThatLieOnThem) {
  for (const auto& [name, whole] : bodies())
    for (const int corners : {1, 2, 5})
      for (const double share : {0.02, 0.3, 1.0}) {
        SCOPED_TRACE(name + ", " + std::to_string(corners) + " corners on " + std::to_string(share));
        expect_stitched(with_corners_on_edges(whole, share, corners, 0, true), whole, 1e-9, 1e-12);
      }
}

TEST(RepairStitching, EdgesAreSplitAtCornersBesideThem) {
  for (const auto& [name, whole] : bodies())
    for (const double beside : {1e-7, 1e-5, 1e-3}) {
      SCOPED_TRACE(name + ", beside by " + std::to_string(beside * 1e6) + "e-6");
      const double longest = 2 * mean_edge_length(whole);
      expect_stitched(with_corners_on_edges(whole, 0.2, 2, beside, false), whole, 2 * beside * longest, 10 * beside);
    }
}

// A plate whose top, bottom and sides were cut without a look at one another, with corners of both sides on an edge.
TEST(RepairStitching, CornersOnBothSidesOfALongEdge) {
  SurfaceMesh mesh;
  const auto strip = [&](const std::vector<double>& at, const std::function<Vec3(double, double)>& place) {
    for (std::size_t i = 0; i + 1 < at.size(); ++i) {
      const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const auto& [s, t] : {std::pair(at[i], 0.0), {at[i + 1], 0.0}, {at[i + 1], 1.0}, {at[i], 1.0}})
        mesh.vertices.push_back(place(s, t));
      mesh.triangles.push_back({n, n + 1, n + 2});
      mesh.triangles.push_back({n, n + 2, n + 3});
    }
  };
  strip({0, 11.3, 29, 29.5, 70}, [](double s, double t) { return Vec3(s, 30 * t, 6); });
  strip({0, 17, 33.1, 70}, [](double s, double t) { return Vec3(s, 30 - 30 * t, 0); });
  strip({0, 5, 64, 70}, [](double s, double t) { return Vec3(s, 0, 6 * t); });
  strip({0, 70}, [](double s, double t) { return Vec3(s, 30, 6 - 6 * t); });
  strip({0, 8, 9, 30}, [](double s, double t) { return Vec3(0, s, 6 - 6 * t); });
  strip({0, 30}, [](double s, double t) { return Vec3(70, s, 6 * t); });
  repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(check_validity(mesh).genus, 0);
  EXPECT_NEAR(enclosed_volume(mesh), 70 * 30 * 6, 1e-8);
  EXPECT_NEAR(surface_area(mesh), 2 * (70 * 30 + 70 * 6 + 30 * 6), 1e-8);
}

// Corners on the chords of a rim, in 32-bit floats: they lie off the chord by a rounding.
TEST(RepairStitching, CornersOnTheChordsOfARim) {
  for (const int around : {12, 32, 90})
    for (const int every : {1, 5})
      for (const int corners : {1, 3}) {
        SCOPED_TRACE(std::to_string(around) + ", " + std::to_string(every) + ", " + std::to_string(corners));
        const SurfaceMesh whole = analytic::cylinder(10, 25, around, 1);
        SurfaceMesh mesh{whole.vertices, {}};
        int chord = 0;
        for (const Triangle& t : whole.triangles) {
          const bool is_cap = mesh.vertices[t[0]] == Vec3(0, 0, 25);
          if (!is_cap || chord++ % every != 0) {
            mesh.triangles.push_back(t);
            continue;
          }
          std::uint32_t last = t[1];
          for (int i = 1; i <= corners + 1; ++i) {
            auto next = t[2];
            if (i <= corners) {
              next = static_cast<std::uint32_t>(mesh.vertices.size());
              mesh.vertices.push_back(mesh.vertices[t[1]] +
                                      (mesh.vertices[t[2]] - mesh.vertices[t[1]]) * i / (corners + 1));
            }
            mesh.triangles.push_back({t[0], last, next});
            last = next;
          }
        }
        for (Vec3& p : mesh.vertices) p = p.cast<float>().cast<double>();
        expect_stitched(torn(mesh), whole, 1e-5, 1e-6);
      }
}

// The two walls of a cup without the faces of its rim: their borders are as near as the wall is thin.
TEST(RepairStitching, TheRimOfAThinWallIsNotClosed) {
  for (const double wall : {1e-4, 1e-3, 0.01, 0.1}) {
    SCOPED_TRACE(wall);
    const auto no_lid = [](const SurfaceMesh& box) {
      const double top = bounding_box(box.vertices).high.z();
      return without_faces(box, [&](const Vec3& c) { return c.z() > top - 1e-9; });
    };
    const SurfaceMesh outer = no_lid(analytic::box({20, 15, 10}, 2.5));
    SurfaceMesh inner = no_lid(analytic::box({20 - 2 * wall, 15 - 2 * wall, 10 - wall}, 2.5));
    inner = analytic::reversed(analytic::moved(inner, {wall, wall, wall}));
    const SurfaceMesh cup = analytic::join(outer, inner);
    SurfaceMesh mesh = cup;
    const RepairResult result = repair(mesh, {.holes = Holes::keep});
    EXPECT_EQ(result.count(RepairKind::WeldedVertex), 0u);
    EXPECT_EQ(result.count(RepairKind::SplitEdge), 0u);
    EXPECT_EQ(check_validity(mesh).boundary_edges, check_validity(cup).boundary_edges);
    // As a solid it has no rim, and none is invented.
    message_of_failure(cup);
  }
}

// A sheet that is bent until its two ends all but meet, edge to edge, is a tube with a seam; one whose ends lie upon
// one another is not.
TEST(RepairStitching, EndsThatLieUponOneAnotherAreNotJoined) {
  const int along = 40;
  const double wall = 1e-3;
  SurfaceMesh mesh;
  const auto at = [](int i, int j) { return static_cast<std::uint32_t>(2 * i + j); };
  for (int i = 0; i <= along; ++i) {  // there in the plane z = 0, around a bend, and back above it
    const double s = 20.0 * i / along;
    const Vec3 p = s <= 10 ? Vec3(10 - s, 0, 0) : Vec3(s - 10, 0, wall);
    for (const double y : {0.0, 4.0}) mesh.vertices.push_back({p.x(), y, p.z()});
    if (i == 0) continue;
    mesh.triangles.push_back({at(i - 1, 0), at(i, 0), at(i, 1)});
    mesh.triangles.push_back({at(i - 1, 0), at(i, 1), at(i - 1, 1)});
  }
  const SurfaceMesh sheet = mesh;
  const RepairResult result = repair(mesh, {.holes = Holes::keep});
  EXPECT_EQ(result.count(RepairKind::WeldedVertex), 0u);
  EXPECT_EQ(result.count(RepairKind::SplitEdge), 0u);
}

// Patches rounded to the same digits, each from a place of its own: corners lie up to a 500th of the diagonal apart,
// more than gaps are else taken for seams.
TEST(RepairStitching, PatchesOfFewDigitsAreJoined) {
  const SurfaceMesh ball = analytic::sphere(25, 4);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> offset(-0.03, 0.03);
  std::array<Vec3, 8> offsets;
  for (Vec3& o : offsets) o = Vec3(offset(random), offset(random), offset(random));
  const auto octant = [&](const Triangle& t) {
    const Vec3 c = centre(ball, t);
    return (c.x() > 0) + 2 * (c.y() > 0) + 4 * (c.z() > 0);
  };
  SurfaceMesh mesh = parted(ball, octant, [](const Vec3& p) { return p; });
  std::vector<int> group(mesh.vertices.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (const std::uint32_t v : mesh.triangles[f]) group[v] = octant(ball.triangles[f]);
  for (std::size_t v = 0; v < group.size(); ++v)
    mesh.vertices[v] =
        (10 * (mesh.vertices[v] + offsets[static_cast<std::size_t>(group[v])])).array().round().matrix() / 10;
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(result.count(RepairKind::ClosedHole), 0u);
  EXPECT_EQ(mesh.triangles.size(), ball.triangles.size());
  EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(ball), 0.003 * enclosed_volume(ball));
}

}  // namespace
}  // namespace scan2fea
