#include "preproc/surface/mending/constraint_projection.hpp"

#include "quality/triangle_measures.hpp"

#include <gtest/gtest.h>

namespace scan2fea {
namespace {

// Two triangles over the edge from 0 to 1, folded onto one another: 30 degrees between them on the inner side.
SurfaceMesh fold() {
  SurfaceMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0.4, 0.9, 0.24}, {0.6, 0.9, -0.24}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
  return mesh;
}

Hinge hinge_of(const SurfaceMesh& mesh) {
  return {.face = 0, .side = 2, .apex = 3, .beyond = area_vector(mesh, mesh.triangles[1])};
}

Vec3 centre(const SurfaceMesh& mesh) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& v : mesh.vertices) sum += v;
  return sum / static_cast<double>(mesh.vertices.size());
}

const std::vector<bool> all_free(4, false);

TEST(ConstraintProjection, APointComesJustSoNear) {
  SurfaceMesh mesh = fold();
  const Location at{0, false, {0.5, 0.2, 0.3}};
  const Vec3 to = point_at(mesh, at) + Vec3(0.3, -0.2, 0.5);
  pull_point(mesh, all_free, at, to, 0.1);
  EXPECT_NEAR((point_at(mesh, at) - to).norm(), 0.1, 1e-12);
}

TEST(ConstraintProjection, APointThatIsNearStays) {
  SurfaceMesh mesh = fold();
  const SurfaceMesh before = mesh;
  const Location at{0, false, {0.5, 0.2, 0.3}};
  pull_point(mesh, all_free, at, point_at(mesh, at) + Vec3(0, 0, 0.05), 0.1);
  EXPECT_EQ(mesh.vertices, before.vertices);
}

TEST(ConstraintProjection, HeldVerticesStayAndTheOthersDoTheirPart) {
  SurfaceMesh mesh = fold();
  const SurfaceMesh before = mesh;
  const std::vector<bool> held{true, false, true, false};
  const Location at{0, false, {0.3, 0.4, 0.3}};
  const Vec3 to = point_at(mesh, at) + Vec3(0, 0, 0.5);
  pull_point(mesh, held, at, to, 0.1);
  EXPECT_NEAR((point_at(mesh, at) - to).norm(), 0.1, 1e-12);
  EXPECT_EQ(mesh.vertices[0], before.vertices[0]);
  EXPECT_EQ(mesh.vertices[2], before.vertices[2]);
}

TEST(ConstraintProjection, AFoldOpensAndGoesNowhere) {
  SurfaceMesh mesh = fold();
  const Vec3 before = centre(mesh);
  ASSERT_NEAR(hinge_of(mesh).angle_deg(mesh), 30, 1);
  for (int step = 0; step < 20; ++step) open_hinge(mesh, all_free, hinge_of(mesh), 60, 0.1);
  EXPECT_NEAR(hinge_of(mesh).angle_deg(mesh), 60, 0.1);
  EXPECT_LT((centre(mesh) - before).norm(), 1e-12);
}

TEST(ConstraintProjection, AFoldOpensByOneFaceWhereTheOtherStays) {
  SurfaceMesh mesh = fold();
  const SurfaceMesh before = mesh;
  const std::vector<bool> held{true, true, false, false};
  for (int step = 0; step < 40; ++step) {
    Hinge hinge = hinge_of(mesh);
    hinge.apex.reset();
    open_hinge(mesh, held, hinge, 60, 0.1);
  }
  EXPECT_NEAR(hinge_of(mesh).angle_deg(mesh), 60, 0.1);
  EXPECT_NE(mesh.vertices[2], before.vertices[2]);
  for (const std::size_t v : {0, 1, 3}) EXPECT_EQ(mesh.vertices[v], before.vertices[v]);
}

TEST(ConstraintProjection, NoVertexGoesFartherThanAllowed) {
  SurfaceMesh mesh = fold();
  const SurfaceMesh before = mesh;
  open_hinge(mesh, all_free, hinge_of(mesh), 170, 0.01);
  for (std::size_t v = 0; v < 4; ++v) EXPECT_LE((mesh.vertices[v] - before.vertices[v]).norm(), 0.01 + 1e-12);
}

}  // namespace
}  // namespace scan2fea
