// The faces of a machined part against its drawing, at three noises and two densities.
#include "preproc/surface/faces/find_faces.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/assemblies.hpp"
#include "tests/machined_part.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace scan2fea {
namespace {

using analytic::machined_part;
using analytic::MachinedPart;

double area_of(const SurfaceMesh& mesh, std::uint32_t f) {
  return area_vector(mesh, mesh.triangles[f]).norm() / 2;
}

// Per drawn face the found one that has most of it.
std::vector<std::uint32_t> matched(const MachinedPart& part, const SurfaceFaces& found) {
  std::vector<std::map<std::uint32_t, double>> shared(part.faces.size());
  for (std::uint32_t f = 0; f < part.face_of_triangle.size(); ++f)
    shared[part.face_of_triangle[f]][found.of_triangle[f]] += area_of(part.scan, f);
  std::vector<std::uint32_t> match;
  for (const auto& areas : shared)
    match.push_back(std::max_element(areas.begin(), areas.end(), [](const auto& a, const auto& b) {
                      return a.second < b.second;
                    })->first);
  return match;
}

// Triangles whose middle is farther than an edge from the drawn borders.
std::vector<bool> far_from_borders(const MachinedPart& part, double edge) {
  std::vector<Vec3> places;
  for (const FeatureEdge& e : borders_between(part.scan, part.face_of_triangle))
    for (const std::uint32_t v : e) places.push_back(part.scan.vertices[v]);
  std::vector<bool> far;
  for (const auto& [a, b, c] : part.scan.triangles) {
    const Vec3 middle = (part.scan.vertices[a] + part.scan.vertices[b] + part.scan.vertices[c]) / 3;
    far.push_back(
        std::none_of(places.begin(), places.end(), [&](const Vec3& p) { return (p - middle).norm() < edge; }));
  }
  return far;
}

void expect_the_drawing(const MachinedPart& part, const SurfaceFaces& found, double edge, bool figures) {
  ASSERT_EQ(found.list.size(), part.faces.size());
  const std::vector<std::uint32_t> match = matched(part, found);
  EXPECT_EQ(std::set<std::uint32_t>(match.begin(), match.end()).size(), match.size()) << "one for each";
  const std::vector<bool> far = far_from_borders(part, edge);
  std::size_t all = 0, right = 0;
  for (std::size_t f = 0; f < far.size(); ++f) {
    all += far[f];
    right += far[f] && found.of_triangle[f] == match[part.face_of_triangle[f]];
  }
  EXPECT_GT(all, far.size() / 2);
  EXPECT_GE(static_cast<double>(right), 0.99 * static_cast<double>(all));
  for (std::size_t i = 0; i < match.size(); ++i) {
    const SurfaceFace& face = found.list[match[i]];
    EXPECT_EQ(kind_of(face), part.faces[i].kind) << face.name;
    if (!figures || part.faces[i].kind != "cylinder" || !face.shape) continue;
    EXPECT_NEAR(face.shape->radius, part.faces[i].radius, 0.005 * part.faces[i].radius) << face.name;
    const double cosine = std::abs(face.shape->axis.dot(part.faces[i].axis));
    EXPECT_LT(std::acos(std::min(1.0, cosine)) * 180 / std::numbers::pi, 0.3) << face.name;
  }
}

std::vector<std::string> kinds_by_name(const SurfaceFaces& faces) {
  std::vector<std::string> kinds;
  for (const SurfaceFace& face : faces.list) kinds.emplace_back(kind_of(face));
  return kinds;
}

class FacesOfAPart : public ::testing::TestWithParam<double> {};

TEST_P(FacesOfAPart, AreThoseOfTheDrawing) {
  const MachinedPart part = machined_part(1, GetParam());
  expect_the_drawing(part, find_faces(part.scan), 1, GetParam() <= 0.0002);
}

TEST_P(FacesOfAPart, HaveTheSameNamesAtTwiceTheTriangles) {
  const MachinedPart part = machined_part(1, GetParam()), finer = machined_part(0.7, GetParam(), 2);
  EXPECT_GT(finer.scan.triangles.size(), 2 * part.scan.triangles.size());
  const SurfaceFaces faces = find_faces(part.scan), of_finer = find_faces(finer.scan);
  ASSERT_EQ(kinds_by_name(faces), kinds_by_name(of_finer));
  for (std::size_t i = 0; i < faces.list.size(); ++i)
    EXPECT_LT((faces.list[i].place - of_finer.list[i].place).norm(), 1) << faces.list[i].name;
}

INSTANTIATE_TEST_SUITE_P(Noises, FacesOfAPart, ::testing::Values(0, 0.0002, 0.001));

TEST(Faces, AreTheSameForAnyNumberOfThreads) {
  const MachinedPart part = machined_part(1, 0.001);
  const auto with = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return find_faces(part.scan).of_triangle;
  };
  EXPECT_EQ(with(1), with(2));
}

TEST(Faces, DoNotDependOnTheOrderOfTriangles) {
  const MachinedPart part = machined_part(1, 0.0002);
  SurfaceMesh turned = part.scan;
  std::reverse(turned.triangles.begin(), turned.triangles.end());
  const SurfaceFaces faces = find_faces(part.scan), of_turned = find_faces(turned);
  ASSERT_EQ(faces.list.size(), of_turned.list.size());
  for (std::size_t i = 0; i < faces.list.size(); ++i)
    EXPECT_LT((faces.list[i].place - of_turned.list[i].place).norm(), 0.2) << faces.list[i].name;
}

TEST(Faces, OfABoxAreSixPlanes) {
  const SurfaceFaces faces = find_faces(analytic::box({3, 4, 5}, 0.5));
  EXPECT_THAT(kinds_by_name(faces), ::testing::Each("plane"));
  ASSERT_EQ(faces.list.size(), 6U);
  EXPECT_NEAR(faces.list[0].area, 20, 1e-9);
  EXPECT_NEAR(faces.list[5].area, 12, 1e-9);
  EXPECT_LT(faces.list[0].place.x(), faces.list[1].place.x());
}

// A shoulder between two cylinders, from nearly plane to steep: creases all around it make it a face of its own.
TEST(Faces, OfATurnedPartAreThoseOfItsProfile) {
  for (const double top : {10.5, 12.0, 14.0, 20.0}) {
    const SurfaceMesh part = analytic::revolved(
        analytic::divided({{8, 0}, {30, 0}, {30, 10}, {18, top}, {18, 40}, {8, 40}}, 1.5, true), 120);
    const SurfaceFaces faces = find_faces(part);
    ASSERT_EQ(faces.list.size(), 6U) << top;
    const double area = std::numbers::pi * 48 * std::hypot(12, top - 10);
    const auto shoulder =
        std::ranges::find_if(faces.list, [&](const SurfaceFace& f) { return std::abs(f.area - area) < 0.001 * area; });
    ASSERT_NE(shoulder, faces.list.end()) << top;
    if (top > 11) EXPECT_EQ(kind_of(*shoulder), "cone") << top;  // a shallow one is a sphere as well
  }
}

TEST(Faces, OfABallAreOneSphere) {
  const SurfaceFaces faces = find_faces(analytic::sphere(10, 4));
  ASSERT_EQ(faces.list.size(), 1U);
  ASSERT_EQ(kind_of(faces.list[0]), "sphere");
  EXPECT_NEAR(faces.list[0].shape->radius, 10, 0.01);
}

}  // namespace
}  // namespace scan2fea
