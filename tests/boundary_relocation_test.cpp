#include "preproc/volume/boundary_relocation.hpp"

#include "preproc/volume/tetrahedralize.hpp"
#include "quality/tetrahedron_measures.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace scan2fea {
namespace {

// A box of which one vertex was driven along a face, so that triangles and elements beside it are flat.
struct Driven {
  SurfaceMesh boundary = analytic::box({4, 4, 2}, 0.5);
  std::uint32_t vertex = 0;
  TetMesh mesh;

  Driven() {
    const auto squared_distance = [](const Vec3& p) { return (p - Vec3(2, 2, 2)).squaredNorm(); };
    const auto nearest =
        std::min_element(boundary.vertices.begin(), boundary.vertices.end(),
                         [&](const Vec3& a, const Vec3& b) { return squared_distance(a) < squared_distance(b); });
    vertex = static_cast<std::uint32_t>(nearest - boundary.vertices.begin());
    nearest->x() += 0.35;
    mesh = tetrahedralize(boundary).mesh;
  }

  double least_deg_with(const std::vector<Vec3>& places) const {
    SurfaceMesh moved = boundary;
    moved.vertices = places;
    return measure_tetrahedra(tetrahedralize(moved).mesh).min_dihedral_deg;
  }
};

TEST(BoundaryRelocation, MovesAVertexAlongTheBoundaryToWhereElementsAreBetter) {
  const Driven driven;
  const double before = measure_tetrahedra(driven.mesh).min_dihedral_deg;
  ASSERT_LT(before, 20);
  const std::vector<bool> held(driven.boundary.vertices.size(), false);
  const std::vector<Vec3> places = relocate_boundary(driven.mesh, driven.boundary, held, 0, 28);
  ASSERT_EQ(places.size(), driven.boundary.vertices.size());
  EXPECT_GT(driven.least_deg_with(places), before + 3);
  EXPECT_LT(places[driven.vertex].x(), driven.boundary.vertices[driven.vertex].x());
  EXPECT_NEAR(places[driven.vertex].z(), 2, 1e-12);
  for (std::size_t v = 0; v < places.size(); ++v)
    EXPECT_LE((places[v] - driven.boundary.vertices[v]).norm(), 0.25 * 0.9) << v;
}

TEST(BoundaryRelocation, LeavesWhatIsHeldAndWhatIsGood) {
  const Driven driven;
  const std::vector<bool> held(driven.boundary.vertices.size(), true), free(driven.boundary.vertices.size(), false);
  EXPECT_EQ(relocate_boundary(driven.mesh, driven.boundary, held, 0, 28), driven.boundary.vertices);
  EXPECT_EQ(relocate_boundary(driven.mesh, driven.boundary, free, 0, 1), driven.boundary.vertices);
}

}  // namespace
}  // namespace scan2fea
