#include "quality/deviation.hpp"

#include "preproc/mesh/error.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace scan2fea {
namespace {

const DeviationOptions few_samples{.samples = 5000, .seed = 1};

TEST(Deviation, OfASurfaceFromItselfIsZero) {
  const SurfaceMesh mesh = analytic::torus(3, 1, 40, 20);
  const Deviation deviation = measure_deviation(mesh, mesh, few_samples);
  EXPECT_EQ(deviation.volume_difference_pct, 0);
  EXPECT_EQ(deviation.area_difference_pct, 0);
  EXPECT_LT(deviation.hausdorff_pct_diagonal, 1e-12);
  EXPECT_LT(deviation.rms_pct_diagonal, 1e-12);
}

TEST(Deviation, OfConcentricSpheres) {
  const SurfaceMesh inner = analytic::sphere(1, 4), outer = analytic::sphere(1.1, 4);
  const double diagonal = bounding_box(inner.vertices).diagonal();
  const Deviation deviation = measure_deviation(outer, inner, few_samples);
  // The outer one is the inner one scaled by 1.1: no point of it is farther than its own radius less a eleventh.
  EXPECT_NEAR(deviation.hausdorff, 0.1, 1e-12);
  EXPECT_NEAR(deviation.hausdorff_pct_diagonal, 100 * 0.1 / diagonal, 1e-10);
  EXPECT_NEAR(deviation.rms_pct_diagonal * diagonal / 100, 0.1, 5e-4);
  EXPECT_NEAR(*deviation.volume_difference_pct, 33.1, 1e-9);
  EXPECT_NEAR(deviation.area_difference_pct, 21, 1e-9);
}

// A scanner's invalid points, at the origin of a part that lies elsewhere.
TEST(Deviation, VerticesOfNoTriangleDoNotCount) {
  SurfaceMesh ball = analytic::sphere(1, 3);
  for (Vec3& p : ball.vertices) p.x() += 30;
  SurfaceMesh with_more = ball;
  with_more.vertices.push_back(Vec3::Zero());
  for (const auto& [mesh, reference] : {std::pair(ball, with_more), std::pair(with_more, ball)})
    EXPECT_EQ(measure_deviation(mesh, reference, few_samples).hausdorff,
              measure_deviation(ball, ball, few_samples).hausdorff);
}

TEST(Deviation, PercentagesAreOfTheReference) {
  const SurfaceMesh inner = analytic::sphere(1, 3), outer = analytic::sphere(2, 3);
  const Deviation grown = measure_deviation(outer, inner, few_samples);
  const Deviation shrunk = measure_deviation(inner, outer, few_samples);
  EXPECT_NEAR(grown.hausdorff_pct_diagonal, 2 * shrunk.hausdorff_pct_diagonal, 1e-9);
  EXPECT_NEAR(*shrunk.volume_difference_pct, -87.5, 1e-9);
}

TEST(Deviation, FindsTheFarthestPointOnEitherSide) {
  const SurfaceMesh box = analytic::box({1, 1, 1}, 0.25);
  SurfaceMesh spiked = box;
  std::uint32_t corner = 0;
  for (std::uint32_t v = 0; v < box.vertices.size(); ++v)
    if (box.vertices[v] == Vec3(1, 1, 1)) corner = v;
  spiked.vertices[corner] = {2, 2, 2};

  const Deviation on_mesh = measure_deviation(spiked, box, few_samples);
  EXPECT_FALSE(on_mesh.farthest_is_on_reference);
  EXPECT_EQ(on_mesh.farthest_point, Vec3(2, 2, 2));
  EXPECT_EQ(on_mesh.nearest_to_farthest, Vec3(1, 1, 1));
  EXPECT_NEAR(on_mesh.hausdorff, std::sqrt(3.0), 1e-15);

  const Deviation on_reference = measure_deviation(box, spiked, few_samples);
  EXPECT_TRUE(on_reference.farthest_is_on_reference);
  EXPECT_EQ(on_reference.farthest_point, Vec3(2, 2, 2));
}

TEST(Deviation, AMissingPartIsSeenFromTheReferenceOnly) {
  const SurfaceMesh ball = analytic::sphere(1, 2);
  SurfaceMesh second = ball;
  for (Vec3& v : second.vertices) v += Vec3(5, 0, 0);
  const Deviation deviation = measure_deviation(ball, analytic::join(ball, second), few_samples);
  EXPECT_TRUE(deviation.farthest_is_on_reference);
  EXPECT_NEAR(deviation.hausdorff, 5, 0.01);
}

TEST(Deviation, OpenSurfacesHaveNoVolumeDifference) {
  SurfaceMesh open = analytic::sphere(1, 2);
  open.triangles.pop_back();
  EXPECT_FALSE(measure_deviation(open, analytic::sphere(1, 2), few_samples).volume_difference_pct.has_value());
  EXPECT_FALSE(measure_deviation(analytic::sphere(1, 2), open, few_samples).volume_difference_pct.has_value());
}

// A sheet and its back enclose what rounding leaves; a thin plate has a volume.
TEST(Deviation, DoubledSheetsHaveNoVolumeDifference) {
  const SurfaceMesh plate = analytic::box({30, 20, 0.03}, 1);
  SurfaceMesh doubled = plate;
  for (Vec3& v : doubled.vertices) v.z() = 1e-7 * std::sin(v.x() + 2 * v.y());
  EXPECT_FALSE(measure_deviation(plate, doubled, few_samples).volume_difference_pct.has_value());
  EXPECT_FALSE(measure_deviation(doubled, plate, few_samples).volume_difference_pct.has_value());
  EXPECT_TRUE(measure_deviation(plate, plate, few_samples).volume_difference_pct.has_value());
}

TEST(Deviation, InsideOutIsTheSameVolume) {
  const SurfaceMesh ball = analytic::sphere(1, 2);
  EXPECT_NEAR(*measure_deviation(analytic::reversed(ball), ball, few_samples).volume_difference_pct, 0, 1e-12);
}

TEST(Deviation, TheRmsIsAnIntegralOverTheArea) {
  SurfaceMesh sheet{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  SurfaceMesh tilted = sheet;
  tilted.vertices[1].z() = 0.01;  // distance rises linearly to 0.01: RMS = 0.01 / sqrt(6)
  const Deviation deviation = measure_deviation(tilted, sheet, {.samples = 100'000, .seed = 3});
  EXPECT_NEAR(deviation.rms_pct_diagonal / 100 * std::sqrt(2.0), 0.01 / std::sqrt(6.0), 1e-5);
}

TEST(Deviation, ThreadsDoNotChangeABit) {
  const SurfaceMesh smooth = analytic::sphere(1, 4), rough = analytic::noisy(smooth, 0.02, 1);
  const auto measure = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return measure_deviation(rough, smooth, few_samples);
  };
  const Deviation one = measure(1), four = measure(4);
  EXPECT_EQ(one.rms_pct_diagonal, four.rms_pct_diagonal);
  EXPECT_EQ(one.hausdorff, four.hausdorff);
  EXPECT_EQ(one.farthest_point, four.farthest_point);
}

TEST(Deviation, SeedsDifferLittle) {
  const SurfaceMesh smooth = analytic::sphere(1, 3), rough = analytic::noisy(smooth, 0.02, 1);
  const double first = measure_deviation(rough, smooth, {.samples = 50'000, .seed = 1}).rms_pct_diagonal;
  const double second = measure_deviation(rough, smooth, {.samples = 50'000, .seed = 2}).rms_pct_diagonal;
  EXPECT_NE(first, second);
  EXPECT_NEAR(first, second, 0.01 * first);
}

TEST(Deviation, FromNothingIsRefused) {
  const SurfaceMesh ball = analytic::sphere(1, 1);
  EXPECT_THROW(measure_deviation(ball, {}), InvalidInput);
  EXPECT_THROW(measure_deviation(ball, {{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {{0, 1, 2}}}), InvalidInput);
}

}  // namespace
}  // namespace scan2fea
