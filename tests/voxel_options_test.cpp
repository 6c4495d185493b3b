// A scan that is made of voxels ends in a mesh of its shape and not of its stairs.
#include "preproc/surface/simplification/voxel_options.hpp"

#include "preproc/pipeline.hpp"
#include "quality/tetrahedron_measures.hpp"
#include "tests/analytic_meshes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <variant>

namespace scan2fea {
namespace {

using ::testing::HasSubstr;

constexpr StairSteps voxels_of_2{.kind = StairSteps::Kind::voxels, .size = {0.5, 1, 2}};

TEST(VoxelOptions, RaiseWhatIsOnlyAimedAt) {
  SimplifyOptions options;
  options.size = LargestDeviation{.distance = 0.2, .required = false};
  EXPECT_THAT(adapt_to_voxels(voxels_of_2, options), HasSubstr("no deviation below their size"));
  EXPECT_EQ(std::get<LargestDeviation>(options.size).distance, 2);
  EXPECT_FALSE(options.features.angle_deg);
}

TEST(VoxelOptions, LeaveWhatWasAskedFor) {
  SimplifyOptions options;
  options.size = LargestDeviation{.distance = 0.2, .required = true};
  options.given_features = FeatureLines{};
  EXPECT_EQ(adapt_to_voxels(voxels_of_2, options), "");
  EXPECT_EQ(std::get<LargestDeviation>(options.size).distance, 0.2);
  EXPECT_TRUE(options.features.angle_deg);
  options = {};
  EXPECT_EQ(adapt_to_voxels(StairSteps{.kind = StairSteps::Kind::slices, .size = {1, 1, 1}}, options), "");
  EXPECT_EQ(adapt_to_voxels({}, options), "");
  EXPECT_TRUE(options.features.angle_deg);
}

TEST(VoxelOptions, EndInAMeshOfTheShape) {
  const PipelineResult result = run_pipeline(analytic::voxel_ball(40), {});
  ASSERT_TRUE(result.volume_mesh);
  EXPECT_GT(measure_tetrahedra(*result.volume_mesh).min_dihedral_deg, 20);
  EXPECT_LT(result.surface.triangles.size(), 4000u) << "stairs take ten times as many";
  for (const Vec3& p : result.surface.vertices) EXPECT_NEAR((p - Vec3::Constant(20)).norm(), 20, 1.2);
}

}  // namespace
}  // namespace scan2fea
