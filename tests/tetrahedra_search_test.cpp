#include "preproc/tetrahedra_search.hpp"

#include "quality/self_intersections.hpp"
#include "quality/tetrahedron_measures.hpp"
#include "quality/triangle_measures.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace scan2fea {
namespace {

// A ball with a cavity out of its middle: the wall is 0.19 thick at one side, 0.01 at the other.
SurfaceMesh uneven_shell() {
  SurfaceMesh cavity = analytic::sphere(0.9, 4);
  for (Vec3& v : cavity.vertices) v.x() += 0.09;
  return analytic::join(analytic::sphere(1, 4), analytic::reversed(cavity));
}

struct Chain {
  SurfaceMesh scan;
  SimplifyOptions simplification;
  TetrahedralizeOptions tetrahedralization;
  std::optional<Simplification> search;
  FilledSurface made;

  explicit Chain(SurfaceMesh of, double ratio) : scan(std::move(of)) {
    simplification.size = FaceRatio{ratio};
    search.emplace(scan, simplification);
    made.simplified = search->run(made.surface);
    made.filled = tetrahedralize(made.surface, tetrahedralization);
  }
  bool worth() const { return worth_renewing(simplification, made); }
};

TEST(TetrahedraSearch, MendsElementsInAThinWall) {
  Chain chain(uneven_shell(), 0.25);
  ASSERT_TRUE(chain.worth());
  const double before = measure_tetrahedra(chain.made.filled.mesh).min_dihedral_deg;
  const RenewalResult result =
      renew_where_poor(*chain.search, chain.simplification, chain.tetrahedralization, chain.made);
  const TetSummary after = measure_tetrahedra(result.made.filled.mesh);
  EXPECT_TRUE(result.gained());
  EXPECT_EQ(result.min_dihedral_before_deg, before);
  EXPECT_EQ(result.min_dihedral_after_deg, after.min_dihedral_deg);
  EXPECT_GT(after.min_dihedral_deg, 20);  // what a surface without thin places is asked for
  EXPECT_EQ(after.inverted, 0u);
  // The surface and the mesh in it belong together, and enclose what the scan does.
  EXPECT_EQ(result.made.filled.mesh.boundary.size(), result.made.surface.triangles.size());
  EXPECT_NEAR(after.volume, enclosed_volume(result.made.surface), 1e-10 * after.volume);
  EXPECT_NEAR(after.volume, enclosed_volume(chain.scan), 1e-9 * after.volume);
  EXPECT_TRUE(find_self_intersections(result.made.surface).empty());
}

TEST(TetrahedraSearch, IsNotForGoodElements) {
  EXPECT_FALSE(Chain(analytic::sphere(1, 3), 0.5).worth());
}

TEST(TetrahedraSearch, IsNotWhereTimeMattersMore) {
  Chain chain(uneven_shell(), 0.25);
  ASSERT_TRUE(chain.worth());
  chain.simplification.effort = Effort::low;
  EXPECT_FALSE(chain.worth());
}

TEST(TetrahedraSearch, WithoutTimeTheFirstMeshStands) {
  Chain chain(uneven_shell(), 0.25);
  ASSERT_TRUE(chain.worth());
  const Progress progress = Progress().until(Progress::Clock::now());
  const TetMesh first = chain.made.filled.mesh;
  const RenewalResult result =
      renew_where_poor(*chain.search, chain.simplification, chain.tetrahedralization, chain.made, progress);
  EXPECT_EQ(result.rounds, 0);
  EXPECT_EQ(result.made.filled.mesh.tetrahedra, first.tetrahedra);
  EXPECT_TRUE(progress.ran_short());
}

}  // namespace
}  // namespace scan2fea
