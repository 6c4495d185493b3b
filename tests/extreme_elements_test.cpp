#include "quality/extreme_elements.hpp"

#include "quality/tetrahedron_measures.hpp"
#include "quality/triangle_measures.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/structured_tets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>

namespace scan2fea {
namespace {

// No two elements alike.
TetMesh uneven_box() {
  TetMesh mesh = analytic::tetrahedra_of_box({3, 2, 1}, {3, 3, 3}, 1);
  for (std::size_t v = 0; v < mesh.nodes.size(); ++v)
    mesh.nodes[v] += 0.05 * Vec3(std::sin(1.0 * static_cast<double>(v)), std::sin(2.3 * static_cast<double>(v)),
                                 std::sin(3.1 * static_cast<double>(v)));
  return mesh;
}

TEST(ExtremeElements, TheElementHasTheFigureOfAll) {
  const TetMesh mesh = uneven_box();
  const TetSummary all = measure_tetrahedra(mesh);
  const auto angles = [&](std::uint32_t t) {
    const Tetrahedron& c = mesh.tetrahedra[t];
    return measure_face_angles(mesh.nodes[c[0]], mesh.nodes[c[1]], mesh.nodes[c[2]], mesh.nodes[c[3]]);
  };
  const std::map<std::string, std::pair<double, std::function<double(std::uint32_t)>>> figures{
      {"volume_mesh.scaled_jacobian.min",
       {all.scaled_jacobian.min, [&](auto t) { return measure_tetrahedron(mesh, t).scaled_jacobian; }}},
      {"volume_mesh.min_dihedral_deg",
       {all.min_dihedral_deg, [&](auto t) { return measure_tetrahedron(mesh, t).min_dihedral_deg; }}},
      {"volume_mesh.max_dihedral_deg",
       {all.max_dihedral_deg, [&](auto t) { return measure_tetrahedron(mesh, t).max_dihedral_deg; }}},
      {"volume_mesh.min_face_angle_deg", {all.min_face_angle_deg, [&](auto t) { return angles(t).min_deg; }}},
      {"volume_mesh.max_face_angle_deg", {all.max_face_angle_deg, [&](auto t) { return angles(t).max_deg; }}},
      {"volume_mesh.edge_ratio", {all.edge_ratio, [&](auto t) { return *measure_tetrahedron(mesh, t).edge_ratio; }}},
      {"volume_mesh.radius_edge_ratio",
       {all.radius_edge_ratio, [&](auto t) { return *measure_tetrahedron(mesh, t).radius_edge_ratio; }}}};
  for (const auto& [name, figure] : figures) {
    const auto found = extreme_tetrahedron(mesh, name);
    ASSERT_TRUE(found) << name;
    EXPECT_EQ(figure.second(found->index), figure.first) << name;
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t v : mesh.tetrahedra[found->index]) middle += 0.25 * mesh.nodes[v];
    EXPECT_LT((found->place - middle).norm(), 1e-12) << name;
  }
}

TEST(ExtremeElements, TrianglesHaveTheFigureOfAll) {
  SurfaceMesh mesh = analytic::sphere(1, 2);
  mesh.vertices[7] *= 1.2;
  mesh.triangles.push_back({0, 0, 1});  // without area: it has no shape
  const TriangleSummary all = measure_triangles(mesh);
  const auto shape = [&](const std::string& figure) {
    const Triangle& t = mesh.triangles[extreme_triangle(mesh, figure).value().index];
    return *measure_triangle(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  };
  EXPECT_EQ(shape("surface.edge_ratio.max").edge_ratio, all.edge_ratio.max);
  EXPECT_EQ(shape("surface.min_angle_deg.min").min_angle_deg, all.min_angle_deg.min);
  EXPECT_EQ(shape("surface.max_angle_deg").max_angle_deg, all.max_angle_deg);
  EXPECT_EQ(shape("surface.radius_ratio.min").radius_ratio, all.radius_ratio.min);
}

TEST(ExtremeElements, OnlyWhatIsInsideOutIsInverted) {
  TetMesh mesh = uneven_box();
  EXPECT_FALSE(extreme_tetrahedron(mesh, "volume_mesh.inverted"));
  std::swap(mesh.tetrahedra[5][0], mesh.tetrahedra[5][1]);
  EXPECT_EQ(extreme_tetrahedron(mesh, "volume_mesh.inverted").value().index, 5U);
}

TEST(ExtremeElements, WhatIsOfAllElementsIsOfNone) {
  const TetMesh mesh = uneven_box();
  for (const char* figure : {"volume_mesh.scaled_jacobian.mean", "volume_mesh.volume", "volume_mesh.nodes", ""})
    EXPECT_FALSE(extreme_tetrahedron(mesh, figure)) << figure;
  EXPECT_FALSE(extreme_triangle(analytic::sphere(1, 1), "surface.edge_ratio.mean"));
  EXPECT_FALSE(extreme_triangle(SurfaceMesh{}, "surface.edge_ratio.max"));
}

}  // namespace
}  // namespace scan2fea
