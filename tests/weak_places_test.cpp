#include "preproc/weak_places.hpp"

#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace scan2fea {
namespace {

// A prism with a wedge of so many degrees along the z axis.
SurfaceMesh wedge(double degrees) {
  const double half = degrees / 2 * std::acos(-1.0) / 180;
  SurfaceMesh mesh;
  for (const double z : {0., 1.}) {
    mesh.vertices.emplace_back(0, 0, z);
    mesh.vertices.emplace_back(std::cos(half), -std::sin(half), z);
    mesh.vertices.emplace_back(std::cos(half), std::sin(half), z);
  }
  mesh.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  return mesh;
}

TetMesh one_tetrahedron(const Vec3& apex) {
  TetMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, apex};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  return mesh;
}

TEST(WeakPlaces, AreNotInASoundMesh) {
  const SurfaceMesh sphere = analytic::sphere(1, 2);
  EXPECT_TRUE(find_weak_places(sphere, nullptr, sphere).empty());
  const TetMesh tetrahedron = one_tetrahedron({0, 0, 1});
  EXPECT_TRUE(find_weak_places(sphere, &tetrahedron, sphere).empty());
}

TEST(WeakPlaces, NameTheFlatElementAndWhereItIs) {
  const SurfaceMesh sphere = analytic::sphere(1, 2);
  const TetMesh flat = one_tetrahedron({0.3, 0.3, 0.01});
  const std::vector<WeakPlace> places = find_weak_places(sphere, &flat, sphere);
  ASSERT_EQ(places.size(), 1u);
  EXPECT_LT(places[0].value, 5);
  EXPECT_NEAR((places[0].at - Vec3(1.3 / 4, 1.3 / 4, 0.0025)).norm(), 0, 1e-12);
  EXPECT_FALSE(places[0].is_unusable);
  EXPECT_NE(places[0].describe().find("below 5"), std::string::npos);
}

TEST(WeakPlaces, AreUnusableBelowHalfADegreeUnlessTheScanIsAsSharp) {
  const SurfaceMesh blunt = wedge(60), sharp = wedge(0.3);
  const TetMesh flat = one_tetrahedron({0.3, 0.3, 1e-4});
  const std::vector<WeakPlace> of_blunt = find_weak_places(blunt, &flat, blunt);
  ASSERT_FALSE(of_blunt.empty());
  EXPECT_TRUE(of_blunt[0].is_unusable);
  const std::vector<WeakPlace> of_sharp = find_weak_places(sharp, &flat, sharp);
  ASSERT_FALSE(of_sharp.empty());
  EXPECT_FALSE(of_sharp[0].is_unusable);
}

TEST(WeakPlaces, OfASurfaceAreNeedles) {
  const SurfaceMesh needles = wedge(0.3);
  const std::vector<WeakPlace> of_part = find_weak_places(needles, nullptr, needles);
  ASSERT_EQ(of_part.size(), 2u);  // an angle and an edge ratio
  EXPECT_NEAR(of_part[0].value, 0.3, 1e-4);
  EXPECT_GT(of_part[1].value, 10);
  EXPECT_FALSE(of_part[0].is_unusable);
  EXPECT_TRUE(find_weak_places(needles, nullptr, analytic::sphere(1, 2))[0].is_unusable);
}

}  // namespace
}  // namespace scan2fea
