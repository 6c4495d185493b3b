#include "preproc/surface/fit/preserve_volume.hpp"

#include "preproc/mesh/error.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace scan2fea {
namespace {

TEST(PreserveVolume, GivesACoarseSphereTheVolumeOfTheFineOne) {
  const SurfaceMesh fine = analytic::sphere(2, 5);
  SurfaceMesh coarse = analytic::sphere(2, 3);
  const double missing = enclosed_volume(fine) - enclosed_volume(coarse);
  const VolumeShift shift = preserve_volume(coarse, fine);
  EXPECT_NEAR(enclosed_volume(coarse) / enclosed_volume(fine), 1, 1e-13);
  EXPECT_NEAR(shift.largest_displacement, missing / surface_area(coarse), 0.1 * shift.largest_displacement);
}

TEST(PreserveVolume, FarFromTheOriginToo) {
  const Vec3 far(1e5, -2e5, 3e5);
  const SurfaceMesh fine = analytic::moved(analytic::sphere(2, 4), far);
  SurfaceMesh coarse = analytic::moved(analytic::sphere(2, 3), far);
  preserve_volume(coarse, fine);
  EXPECT_NEAR(enclosed_volume(coarse) / enclosed_volume(fine), 1, 1e-10);
}

TEST(PreserveVolume, NestedSpheresEachKeepTheirOwn) {
  const SurfaceMesh inner = analytic::reversed(analytic::sphere(1, 4));
  const SurfaceMesh outer = analytic::sphere(1.3, 4);
  const SurfaceMesh like = analytic::join(inner, outer);
  // The components come in the other order, so the pairing must be by place.
  SurfaceMesh mesh = analytic::join(analytic::sphere(1.3, 3), analytic::reversed(analytic::sphere(1, 3)));
  const std::size_t of_outer = analytic::sphere(1.3, 3).triangles.size();
  const VolumeShift shift = preserve_volume(mesh, like);
  EXPECT_EQ(shift.components, 2U);
  SurfaceMesh part = mesh;
  part.triangles.resize(of_outer);
  EXPECT_NEAR(enclosed_volume(part) / enclosed_volume(outer), 1, 1e-12);
  EXPECT_NEAR(enclosed_volume(mesh) / enclosed_volume(like), 1, 1e-12);
}

TEST(PreserveVolume, UnpairedComponentsShareOneShift) {
  const SurfaceMesh like = analytic::sphere(1, 4);
  SurfaceMesh mesh = analytic::join(analytic::sphere(0.99, 3), analytic::moved(analytic::sphere(0.05, 2), {3, 0, 0}));
  EXPECT_EQ(preserve_volume(mesh, like).components, 1U);
  EXPECT_NEAR(enclosed_volume(mesh) / enclosed_volume(like), 1, 1e-12);
}

TEST(PreserveVolume, FixedVerticesStay) {
  const SurfaceMesh fine = analytic::sphere(2, 4);
  SurfaceMesh coarse = analytic::sphere(2, 3);
  VertexConstraints constraints(coarse.vertices.size(), VertexConstraint::free);
  constraints[5] = VertexConstraint::fixed;
  const Vec3 place = coarse.vertices[5];
  preserve_volume(coarse, fine, constraints);
  EXPECT_EQ(coarse.vertices[5], place);
  EXPECT_NEAR(enclosed_volume(coarse) / enclosed_volume(fine), 1, 1e-12);
}

TEST(PreserveVolume, RefusesWhereNothingMayMove) {
  SurfaceMesh mesh = analytic::sphere(2, 2);
  const VertexConstraints fixed(mesh.vertices.size(), VertexConstraint::fixed);
  EXPECT_THROW(preserve_volume(mesh, analytic::sphere(2, 4), fixed), NotMeshable);
}

TEST(PreserveVolume, RefusesAnotherBody) {
  SurfaceMesh mesh = analytic::sphere(1, 3);
  EXPECT_THROW(preserve_volume(mesh, analytic::sphere(3, 3)), NotMeshable);
}

TEST(PreserveVolume, RefusesAnOpenSurface) {
  SurfaceMesh mesh = analytic::sphere(1, 3);
  mesh.triangles.pop_back();
  EXPECT_THROW(preserve_volume(mesh, analytic::sphere(1, 4)), NotMeshable);
}

TEST(PreserveVolume, PlaneFacesStayPlaneWhereCurvedOnesCanGiveTheVolume) {
  const SurfaceMesh fine = analytic::cylinder(1, 2, 96, 20);
  SurfaceMesh coarse = analytic::cylinder(1, 2, 24, 6);
  const SurfaceMesh before = coarse;
  VertexConstraints constraints(coarse.vertices.size(), VertexConstraint::free);
  const auto is_cap = [](const Vec3& p) { return p.z() < 1e-9 || p.z() > 2 - 1e-9; };
  for (std::size_t v = 0; v < coarse.vertices.size(); ++v)
    if (is_cap(coarse.vertices[v]) && coarse.vertices[v].head<2>().norm() > 0.9)
      constraints[v] = VertexConstraint::fixed;
  preserve_volume(coarse, fine, constraints);
  EXPECT_NEAR(enclosed_volume(coarse) / enclosed_volume(fine), 1, 1e-12);
  for (std::size_t v = 0; v < coarse.vertices.size(); ++v)
    if (is_cap(before.vertices[v])) {
      EXPECT_EQ(coarse.vertices[v], before.vertices[v]);
    }
}

}  // namespace
}  // namespace scan2fea
