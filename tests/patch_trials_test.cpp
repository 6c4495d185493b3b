#include "preproc/surface/mending/patch_trials.hpp"

#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <gtest/gtest.h>

namespace scan2fea {
namespace {

// The patch is two sides of a spire of three: the other diagonal joins two corners that an edge of the third side
// joins, too. The third side and the foot bulge, so that nothing crosses.
TEST(PatchTrials, NoEdgeIsLaidBesideOneOfTheSurfaceAround) {
  const SurfaceMesh spire{{{0, 0, 0}, {1, 0, 0}, {0.5, 0.8, 0}, {0.5, 0.3, 5}, {-0.5, 1, 1}, {0.5, 0.3, -1}},
                          {{0, 1, 3}, {1, 2, 3}, {2, 0, 4}, {0, 3, 4}, {3, 2, 4}, {0, 2, 5}, {2, 1, 5}, {1, 0, 5}}};
  PatchOutline outline{.faces = {0, 1}, .vertices = {}, .rim = std::vector<bool>(4, true), .edge = 1, .box = {}};
  const SurfaceMesh patch = part_of(spire, outline.faces, outline.vertices);
  outline.box = bounding_box(spire.vertices);
  const PatchGoal goal{.limit = 0.1, .allowed = 0.1, .fidelity = 0.1};
  const Surroundings surroundings(spire, outline, patch, {2, 3, 4, 5, 6, 7}, spire, {0, 1, 2, 3, 4, 5, 6, 7}, goal);
  EXPECT_TRUE(surroundings.is_clear({.patch = patch}));

  HalfedgeMesh flipped(patch);
  for (HalfedgeMesh::Index h = 0; h < 6; ++h)
    if (!flipped.is_border(h) && h < flipped.opposite(h)) {
      ASSERT_TRUE(flipped.can_flip(h));
      flipped.flip(h);
    }
  EXPECT_FALSE(surroundings.is_clear({.patch = flipped.to_surface()}));
}

}  // namespace
}  // namespace scan2fea
