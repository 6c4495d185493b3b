#include "preproc/surface/faces/select_sets.hpp"

#include "preproc/surface/faces/carry_sets.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/error_from.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace scan2fea {
namespace {

using ::testing::HasSubstr;

const SurfaceMesh& box() {
  static const SurfaceMesh mesh = analytic::box({3, 4, 5}, 0.5);
  return mesh;
}

SelectedScan select(const SurfaceMesh& mesh, const std::string& expression) {
  const std::vector<NamedSelection> sets{parse_selection("a=" + expression, "mm")};
  return select_sets(mesh, sets);
}

double area(const std::string& expression) {
  return select(box(), expression).areas.at(0);
}

std::string error_of(const std::string& expression) {
  return error_from<WrongUsage>([&] { select(box(), expression); }).what();
}

TEST(Selection, IsOfFacesByName) {
  EXPECT_NEAR(area("FACE_1"), 20, 1e-9);
  EXPECT_NEAR(area("face_1 or FACE_2"), 40, 1e-9);
}

TEST(Selection, IsOfFacesByKindAndFigures) {
  EXPECT_NEAR(area("plane"), 94, 1e-9);
  EXPECT_NEAR(area("plane(z<0.01)"), 12, 1e-9);
  EXPECT_NEAR(area("plane(-z)"), 12, 1e-9);
  EXPECT_NEAR(area("plane(axis=(0,0,1); 10deg)"), 12, 1e-9);
  EXPECT_NEAR(area("plane(area>14, area<16)"), 30, 1e-9);
  EXPECT_NEAR(area("largest(plane(area<14))"), 12, 1e-9);
  EXPECT_NEAR(area("nearest(1.5, 2, 9)"), 12, 1e-9);
}

TEST(Selection, IsOfCylindersByAxisAndRadius) {
  const SurfaceMesh mesh = analytic::cylinder(5, 20, 96, 40);
  for (const char* expression :
       {"cylinder(z, r=5+-0.2)", "cylinder(r=5\u00b10.2, boss)", "cylinder(0,0,2, r=5)", "not plane"})
    EXPECT_NEAR(select(mesh, expression).areas[0], 200 * std::numbers::pi, 1) << expression;
  const auto refused = [&](const char* expression) {
    return std::string(error_from<WrongUsage>([&] { select(mesh, expression); }).what());
  };
  EXPECT_THAT(refused("cylinder(r=7+-0.2)"), HasSubstr("radius 5"));
  EXPECT_THAT(refused("cylinder(x)"), HasSubstr("axis (0, 0, -1)"));
  EXPECT_THAT(refused("cylinder(hole)"), HasSubstr("FACE_3 (cylinder"));
}

TEST(Selection, CutsTheSurfaceWherePlacesEnd) {
  EXPECT_NEAR(area("z<0.3"), 12 + 14 * 0.3, 1e-9);
  EXPECT_NEAR(area("z <= 300 um"), 12 + 14 * 0.3, 1e-9);
  // The corner within a triangle is cut off.
  EXPECT_NEAR(area("box(-1,-1,-1, 1.3,1.4,9)"), 2 * 1.3 * 1.4 + 5 * (1.3 + 1.4), 0.01);
  const double quarter = std::numbers::pi / 4;
  EXPECT_NEAR(area("ball(0,0,0, 1.3)"), 3 * quarter * 1.3 * 1.3, 0.02);
  EXPECT_NEAR(area("plane(z<0.1) and not ball(0,0,0, 1.3)"), 12 - quarter * 1.3 * 1.3, 0.01);
}

TEST(Selection, FindsPlacesSmallerThanTriangles) {
  const SurfaceMesh coarse = analytic::box({3, 4, 5}, 5);
  EXPECT_NEAR(select(coarse, "ball(1.5, 2, 5, 0.4)").areas[0], std::numbers::pi * 0.16, 0.01);
}

TEST(Selection, GoesByNormalsOnRoundFaces) {
  const SelectedScan made = select(analytic::sphere(10, 5), "normal(0,0,1; 60deg)");
  EXPECT_NEAR(made.areas[0], 2 * std::numbers::pi * 100 * 0.5, 2);
  for (const FeatureEdge& e : borders_between(made.mesh, made.of_triangle))
    for (const std::uint32_t v : e) EXPECT_NEAR(made.mesh.vertices[v].z(), 5, 0.1);
}

TEST(Selection, TakesSetsThatTheScanCameWith) {
  const std::vector<NamedSet> given{{"solid_1", {0, 1, 2}}};
  const std::vector<NamedSelection> sets{parse_selection("a=Solid_1", "")};
  EXPECT_EQ(select_sets(box(), sets, given).sets[0].members, given[0].members);
}

TEST(Selection, OfSeveralSetsPartsTheScan) {
  const std::vector<NamedSelection> sets{parse_selection("a=z<1", ""), parse_selection("b=z<2", "")};
  const SelectedScan made = select_sets(box(), sets);
  EXPECT_EQ(*std::max_element(made.of_triangle.begin(), made.of_triangle.end()), 2U);
  EXPECT_TRUE(std::includes(made.sets[1].members.begin(), made.sets[1].members.end(), made.sets[0].members.begin(),
                            made.sets[0].members.end()));
  EXPECT_NEAR(enclosed_volume(made.mesh), 60, 1e-9);
}

TEST(Selection, OfNothingSaysWhatIsNear) {
  EXPECT_THAT(error_of("FACE_9"), HasSubstr("FACE_1 to FACE_6"));
  EXPECT_THAT(error_of("z<-2"), HasSubstr("the scan lies in (0, 0, 0) to (3, 4, 5)"));
  EXPECT_THAT(error_of("ball(-5,0,0, 1)"), HasSubstr("nearest at (0, 0, 0)"));
  EXPECT_THAT(error_of("cylinder"), HasSubstr("FACE_1 (plane"));
  EXPECT_THAT(error_of("plane(z<0.1) and plane(z>4.9)"), HasSubstr("plane alone is of area 12"));
}

TEST(Selection, ThatCannotBeReadSaysWhere) {
  for (const char* text : {"a", "=FACE_1", "1a=FACE_1", "nall=FACE_1", "a=", "a=plane(", "a=plane(z<)", "a=box(1,2,3)",
                           "a=FACE_1 FACE_2", "a=cone(q=3)", "a=ball(0,0,0,-1)", "a=normal(0,0,0;5deg)", "a=r<5",
                           "a=largest(z<5)", "a=foo(3)", "a=z<0.5mm", "a=FACE_1 and", "a=(FACE_1"})
    error_from<WrongUsage>([&] { parse_selection(text, ""); });
  EXPECT_THAT(error_from<WrongUsage>([] { parse_selection("a=plane(z<x)", ""); }).what(),
              HasSubstr("plane(z< <- here"));
}

TEST(CarryLabels, GivesEachPieceBetweenLinesOneLabel) {
  const SelectedScan made = select(box(), "z<2.1");
  const SurfaceMesh coarse = analytic::box({3, 4, 5}, 0.7);
  const std::vector<std::uint32_t> same = carry_labels(made.mesh, made.of_triangle, made.mesh, {});
  EXPECT_EQ(same, made.of_triangle);
  std::size_t below = 0;
  const std::vector<std::uint32_t> carried = carry_labels(made.mesh, made.of_triangle, coarse, {});
  for (std::size_t f = 0; f < carried.size(); ++f) {
    double height = 0;
    for (const std::uint32_t v : coarse.triangles[f]) height += coarse.vertices[v].z() / 3;
    if (std::abs(height - 2.1) < 0.7) continue;
    EXPECT_EQ(carried[f] == carried[0], (height < 2.1) == (coarse.vertices[coarse.triangles[0][0]].z() < 2.1));
    below += height < 2.1;
  }
  EXPECT_GT(below, 0U);
}

}  // namespace
}  // namespace scan2fea
