// Scans that are thinned while they are read: from every format, with their names.
#include "preproc/surface/thinning/read_thinned_scan.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/write_surface.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <variant>
#include <vector>

namespace scan2fea {
namespace {

// Whose coordinates a binary STL holds as they are; uneven, so that no vertex is as near to one as to another.
SurfaceMesh torus_of_floats() {
  SurfaceMesh torus = analytic::torus(3, 1, 300, 100);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> noise(-0.005, 0.005);
  for (Vec3& p : torus.vertices)
    p = (p + Vec3(noise(random), noise(random), noise(random))).cast<float>().cast<double>();
  return torus;
}

const SurfaceMesh& mesh_of(const ThinnedScan& read) {
  return std::get<NamedSurface>(read.scan).mesh;
}

TEST(ReadThinnedScan, IsTheSameFromEveryFormat) {
  const SurfaceMesh torus = torus_of_floats();
  const TemporaryFolder folder;
  const auto read_as = [&](const std::string& name, bool ascii) {
    write_surface(torus, folder / name, {.measured = {}, .unit = {}, .face_sets = {}, .ascii = ascii});
    return read_thinned_scan(folder / name, {.largest = 20000});
  };
  const ThinnedScan first = read_as("torus.ply", false);
  ASSERT_TRUE(first.thinning);
  EXPECT_EQ(first.thinning->given.triangles, torus.triangles.size());
  EXPECT_EQ(first.thinning->triangles, mesh_of(first).triangles.size());
  EXPECT_NEAR(static_cast<double>(first.thinning->triangles), 5000, 1500);
  for (const auto& [name, ascii] : {std::pair{"torus.stl", false},
                                    {"text.stl", true},
                                    {"text.ply", true},
                                    {"torus.obj", false},
                                    {"torus.off", false}}) {
    const ThinnedScan other = read_as(name, ascii);
    ASSERT_EQ(mesh_of(other).vertices.size(), mesh_of(first).vertices.size()) << name;
    for (std::size_t v = 0; v < mesh_of(other).vertices.size(); ++v)  // cells sum in 32 bits
      EXPECT_LT((mesh_of(other).vertices[v] - mesh_of(first).vertices[v]).norm(), 1e-3 * first.thinning->cell) << name;
    EXPECT_EQ(mesh_of(other).triangles, mesh_of(first).triangles) << name;
  }
}

TEST(ReadThinnedScan, IsTheWholeBelowTheLimit) {
  const SurfaceMesh torus = torus_of_floats();
  const TemporaryFolder folder;
  write_surface(torus, folder / "torus.ply");
  for (const std::size_t largest : {torus.triangles.size(), std::size_t{1000}}) {
    const ThinnedScan read = read_thinned_scan(
        folder / "torus.ply", {.largest = largest, .needed = [](const GivenScan& scan) { return scan.triangles; }});
    EXPECT_FALSE(read.thinning);
    EXPECT_EQ(mesh_of(read).vertices, torus.vertices);
    EXPECT_EQ(mesh_of(read).triangles, torus.triangles);
  }
}

// Of each half of a torus.
TEST(ReadThinnedScan, NamesStay) {
  const SurfaceMesh torus = torus_of_floats();
  NamedSet left{"left", {}}, right{"right", {}};
  for (std::uint32_t t = 0; t < torus.triangles.size(); ++t)
    (centroid(torus, torus.triangles[t]).x() < 0 ? left : right).members.push_back(t);
  const TemporaryFolder folder;
  write_surface(torus, folder / "torus.obj", {.measured = {}, .unit = "mm", .face_sets = {left, right}});
  const ThinnedScan read = read_thinned_scan(folder / "torus.obj", {.largest = 20000});
  ASSERT_TRUE(read.thinning);
  const auto& surface = std::get<NamedSurface>(read.scan);
  EXPECT_EQ(surface.unit, "mm");
  ASSERT_EQ(surface.face_sets.size(), 2u);
  std::size_t members = 0;
  for (const NamedSet& set : surface.face_sets) {
    members += set.members.size();
    const double side = set.name == "left" ? -1 : 1;
    for (const std::uint32_t t : set.members)
      EXPECT_GT(side * centroid(surface.mesh, surface.mesh.triangles[t]).x(), -2 * read.thinning->cell);
  }
  EXPECT_EQ(members, surface.mesh.triangles.size());
}

// Of single triangles, most of which become edges or points.
TEST(ReadThinnedScan, TellsWhichNamesAreGone) {
  const SurfaceMesh torus = torus_of_floats();
  std::vector<NamedSet> dots;
  for (std::uint32_t i = 0; i < 20; ++i) dots.push_back({"dot" + std::to_string(i), {3000 * i + 7}});
  const TemporaryFolder folder;
  write_surface(torus, folder / "torus.obj", {.measured = {}, .unit = {}, .face_sets = dots});
  const ThinnedScan read = read_thinned_scan(folder / "torus.obj", {.largest = 20000});
  ASSERT_TRUE(read.thinning);
  EXPECT_FALSE(read.thinning->lost_sets.empty());
  const std::vector<NamedSet>& left = std::get<NamedSurface>(read.scan).face_sets;
  for (const NamedSet& dot : dots) {
    const bool is_told = std::ranges::find(read.thinning->lost_sets, dot.name) != read.thinning->lost_sets.end();
    EXPECT_EQ(std::ranges::find(left, dot.name, &NamedSet::name) == left.end(), is_told) << dot.name;
  }
  for (const NamedSet& set : left) EXPECT_FALSE(set.members.empty());
}

// Noise of the size of cells would make folds of them; what bends as much does not, see the torus above.
TEST(ReadThinnedScan, NoiseGetsCellsTenTimesAsWide) {
  SurfaceMesh ball = analytic::sphere(1, 7);
  const double sigma = 0.004;
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, sigma);
  for (Vec3& p : ball.vertices) p += noise(random) * p;
  const TemporaryFolder folder;
  write_surface(ball, folder / "ball.ply");
  const ThinnedScan read = read_thinned_scan(folder / "ball.ply", {.largest = 160000});
  ASSERT_TRUE(read.thinning);
  EXPECT_NEAR(read.thinning->cell, 10 * sigma, 2 * sigma);
  // But for those that are asked for.
  const ThinnedScan more =
      read_thinned_scan(folder / "ball.ply", {.largest = 160000, .needed = [](const GivenScan&) { return 40000; }});
  EXPECT_GT(more.thinning->triangles, 30000u);
}

// As many cells as triangles, whatever their size: they grow until they are few enough.
TEST(ReadThinnedScan, DustDoesNotFillMemory) {
  SurfaceMesh dust = analytic::sphere(1, 4);
  for (int i = 0; i < 20000; ++i) {
    const auto first = static_cast<std::uint32_t>(dust.vertices.size());
    const Vec3 at(i % 27, i / 27 % 27, i / 729);
    for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(1e-6, 0, 0), Vec3(0, 1e-6, 0)}) dust.vertices.push_back(at + corner);
    dust.triangles.push_back({first, first + 1, first + 2});
  }
  const TemporaryFolder folder;
  write_surface(dust, folder / "dust.stl");
  const ThinnedScan read = read_thinned_scan(folder / "dust.stl", {.largest = 8000});
  ASSERT_TRUE(read.thinning);
  EXPECT_LT(mesh_of(read).vertices.size(), 1500u);
}

// Wherever it lies, and whichever way it is turned.
TEST(ReadThinnedScan, TellsWhatTheVolumeBecame) {
  const TemporaryFolder folder;
  for (const SurfaceMesh& torus :
       {torus_of_floats(), analytic::moved(torus_of_floats(), {1e6, 0, 0}), analytic::reversed(torus_of_floats())}) {
    write_surface(torus, folder / "torus.ply");
    const ThinnedScan read = read_thinned_scan(folder / "torus.ply", {.largest = 20000});
    ASSERT_TRUE(read.thinning && read.thinning->volume_change);
    const double before = enclosed_volume(torus);
    EXPECT_NEAR(*read.thinning->volume_change, enclosed_volume(mesh_of(read)) / before - 1, 1e-9);
    EXPECT_LT(*read.thinning->volume_change, 0);  // chords
  }
}

// Whose walls are thinner than the cells; the bottom is not.
TEST(ReadThinnedScan, APartThatLosesItsWallsIsRefused) {
  const SurfaceMesh foot = analytic::box({4, 10, 10}, 0.1), wall = analytic::box({60, 10, 0.1}, 0.1);
  const TemporaryFolder folder;
  write_surface(analytic::join(foot, analytic::moved(wall, {10, 0, 0})), folder / "walls.stl");
  EXPECT_THROW(read_thinned_scan(folder / "walls.stl", {.largest = 4000}), NotMeshable);
}

TEST(ReadThinnedScan, WhatIsTooThinForItsCellsIsRefused) {
  const TemporaryFolder folder;
  write_surface(analytic::box({10, 10, 1e-4}, 0.05), folder / "foil.stl");
  EXPECT_THROW(read_thinned_scan(folder / "foil.stl", {.largest = 4000}), NotMeshable);
}

}  // namespace
}  // namespace scan2fea
