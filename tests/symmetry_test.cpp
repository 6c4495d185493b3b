// Halves of symmetric parts, and meshes that are symmetric to the last bit.
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/six_node_triangle.hpp"
#include "preproc/pipeline.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/cut_surface.hpp"
#include "preproc/symmetry/half_scan.hpp"
#include "preproc/symmetry/mirror_plane.hpp"
#include "quality/self_intersections.hpp"
#include "tests/analytic_meshes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace scan2fea {
namespace {

using testing::HasSubstr;

SurfaceMesh tilted(SurfaceMesh mesh, const Eigen::Matrix3d& turn, const Vec3& by) {
  for (Vec3& p : mesh.vertices) p = turn * p + by;
  return mesh;
}

Eigen::Matrix3d a_turn() {
  return (Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())).toRotationMatrix();
}

TEST(MirrorPlane, IsFoundWhereverThePartLies) {
  // Moments differ along all three axes.
  const SurfaceMesh box = analytic::box({3, 5, 9}, 0.5);
  for (const double noise : {0.0, 0.01}) {
    const SurfaceMesh scan = analytic::noisy(tilted(box, a_turn(), {4, -7, 11}), noise, 3);
    const MirrorPlane plane = find_mirror_plane(scan);
    double best = 0;
    for (int k = 0; k < 3; ++k) best = std::max(best, std::abs(plane.normal.dot(a_turn().col(k))));
    EXPECT_GT(best, std::cos(0.1 * EIGEN_PI / 180));
    const Vec3 middle = a_turn() * Vec3(1.5, 2.5, 4.5) + Vec3(4, -7, 11);
    EXPECT_LT(std::abs(plane.normal.dot(middle) - plane.offset), 0.001 * bounding_box(scan.vertices).diagonal());
    const MirrorLimits limits = mirror_limits(scan);
    EXPECT_LE(plane.rms_distance, limits.rms);
    EXPECT_LE(plane.largest_distance, limits.largest);
  }
}

TEST(MirrorPlane, OfExactCoordinatesIsExact) {
  const MirrorPlane plane = find_mirror_plane(analytic::moved(analytic::box({3, 5, 9}, 0.5), {-1.5, 2, 2}), 0);
  EXPECT_EQ(plane.normal, Vec3::UnitX());
  EXPECT_EQ(plane.offset, 0);
}

TEST(MirrorPlane, OfARoundPartIsOneThroughItsAxis) {
  // Its moments leave all directions across the axis open.
  const MirrorPlane plane = find_mirror_plane(tilted(analytic::cylinder(2, 9, 48, 30), a_turn(), Vec3::Zero()));
  const double along = std::abs(plane.normal.dot(a_turn().col(2)));
  EXPECT_TRUE(along < 0.002 || along > 0.999998) << along;
}

TEST(HalfScan, IsClosedAndHasHalfOfTheVolume) {
  for (const SurfaceMesh& scan : {analytic::moved(analytic::slab_with_holes(2, 0.25), {0, 0, 0}),
                                  analytic::torus(5, 1.5, 60, 30), analytic::sphere(3, 3)}) {
    const MirrorPlane plane = find_mirror_plane(scan, 2);
    const HalfScan half = halve(scan, MirrorFrame(plane));
    EXPECT_TRUE(boundary_edges(half.mesh).empty());
    EXPECT_NEAR(enclosed_volume(half.mesh), enclosed_volume(scan) / 2, 1e-3 * enclosed_volume(scan));
    EXPECT_EQ(find_self_intersections(half.mesh).size(), 0U);
    for (const Vec3& p : half.mesh.vertices) EXPECT_GE(p.x(), 0);
    for (std::size_t f = half.mesh.triangles.size() - half.cut_faces; f < half.mesh.triangles.size(); ++f)
      for (const std::uint32_t v : half.mesh.triangles[f]) EXPECT_EQ(half.mesh.vertices[v].x(), 0);
  }
}

using Place = std::array<double, 3>;

std::set<Place> places_of(const std::vector<Vec3>& nodes) {
  std::set<Place> places;
  for (const Vec3& p : nodes) places.insert({p.x(), p.y(), p.z()});
  return places;
}

class MirroredMesh : public testing::TestWithParam<int> {};

TEST_P(MirroredMesh, IsSymmetricToTheLastBit) {
  // Centred, so that a sign is all that a mirrored coordinate needs.
  const SurfaceMesh scan = analytic::moved(analytic::block_with_fin(0.5), Vec3::Zero());
  const BoundingBox box = bounding_box(scan.vertices);
  const SurfaceMesh centred = analytic::moved(scan, -(box.low + box.high) / 2);
  PipelineOptions options;
  options.order = GetParam();
  int symmetric = 0;
  for (int axis = 0; axis < 3; ++axis) {
    options.symmetry = SymmetryOptions{axis};
    const MirrorPlane plane = find_mirror_plane(centred, axis);
    if (plane.rms_distance > mirror_limits(centred).rms) continue;
    ++symmetric;
    const PipelineResult result = run_pipeline(centred, options);
    const TetMesh& mesh = *result.volume_mesh;
    const std::set<Place> places = places_of(mesh.nodes);
    EXPECT_EQ(places.size(), mesh.nodes.size()) << "no node is there twice";
    for (Place p : places) {
      p[static_cast<std::size_t>(axis)] = -p[static_cast<std::size_t>(axis)] + 0.0;
      EXPECT_TRUE(places.contains(p)) << p[0] << " " << p[1] << " " << p[2];
    }
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) EXPECT_GT(volume_of(mesh, t), 0);
    EXPECT_EQ(find_boundary(mesh.tetrahedra).size(), mesh.boundary.size()) << "the cut is inside";
    EXPECT_NEAR(total_volume(mesh), enclosed_volume(centred), 1e-6 * enclosed_volume(centred));
    ASSERT_EQ(result.surface.triangles.size(), mesh.boundary.size());
    for (std::size_t f = 0; f < mesh.boundary.size(); ++f) {
      Triangle a = boundary_triangle(mesh, mesh.boundary[f]), b = result.surface.triangles[f];
      std::sort(a.begin(), a.end());
      std::sort(b.begin(), b.end());
      EXPECT_EQ(a, b);
    }
  }
  EXPECT_GE(symmetric, 1);
}

INSTANTIATE_TEST_SUITE_P(Orders, MirroredMesh, testing::Values(1, 2));

// Curves through nodes on the scan between corners off it would halve the distance at best; those that are fitted are
// a tenth as far, also where the halves meet.
TEST(MirroredMesh, OfSecondOrderIsFitted) {
  const SurfaceMesh scan = analytic::torus(3, 1, 240, 96);
  PipelineOptions options;
  options.symmetry = SymmetryOptions{0};
  options.simplify->size = FaceCount{1500};
  const auto distance = [](const Vec3& p) { return std::hypot(std::hypot(p.x(), p.y()) - 3, p.z()) - 1; };
  options.order = 2;
  const PipelineResult result = run_pipeline(scan, options);
  const TetMesh& mesh = *result.volume_mesh;
  double curved = 0, straight = 0;
  for (const BoundaryFace& face : mesh.boundary) {
    const SixNodeTriangle x = boundary_face_nodes(mesh, face);
    curved += std::pow(distance(point_on(x, {1. / 3, 1. / 3, 1. / 3})), 2);
    straight += std::pow(distance((x[0] + x[1] + x[2]) / 3), 2);
  }
  EXPECT_LT(std::sqrt(curved), std::sqrt(straight) / 10);
  EXPECT_NEAR(total_volume(mesh), enclosed_volume(scan), 1e-8 * enclosed_volume(scan));
}

TEST(MirroredMesh, KeepsSetsOfOneSide) {
  const SurfaceMesh scan = analytic::moved(analytic::box({4, 3, 2}, 0.25), {-2, 0, 0});
  PipelineOptions options;
  options.symmetry = SymmetryOptions{0};
  options.sets = {parse_selection("left=x<-1", ""), parse_selection("ends=plane(x) or plane(-x)", "")};
  const PipelineResult result = run_pipeline(scan, options);
  ASSERT_GE(result.sets.size(), 2U);
  EXPECT_NEAR(result.sets[0].area, 1 * 10 + 6, 0.02);
  for (const std::uint32_t f : result.face_sets[0].members)
    EXPECT_LT(centroid(result.surface, result.surface.triangles[f]).x(), -1);
  EXPECT_NEAR(result.sets[1].area, 12, 1e-6);
}

TEST(MirroredMesh, IsRefusedOfWhatIsNotSymmetric) {
  const SurfaceMesh scan =
      analytic::join(analytic::box({4, 3, 2}, 0.25), analytic::moved(analytic::sphere(0.5, 3), {6, 1, 1}));
  PipelineOptions options;
  options.symmetry = SymmetryOptions{0};
  try {
    run_pipeline(scan, options);
    FAIL() << "no error";
  } catch (const NotMeshable& error) {
    EXPECT_THAT(error.what(), HasSubstr("no mirror plane across this axis"));
    EXPECT_THAT(error.what(), HasSubstr("--symmetry off"));
  }
}

TEST(MirroredMesh, OfTwinBodiesSharesNothing) {
  const SurfaceMesh body = analytic::box({4, 3, 2}, 0.5);
  PipelineOptions options;
  options.symmetry = SymmetryOptions{0};
  const PipelineResult result =
      run_pipeline(analytic::join(analytic::moved(body, {1, 0, 0}), analytic::moved(body, {-5, 0, 0})), options);
  EXPECT_NEAR(total_volume(*result.volume_mesh), 48, 1e-9);
  for (const Vec3& p : result.volume_mesh->nodes) EXPECT_GE(std::abs(p.x()), 1 - 1e-9);
}

TEST(MirroredMesh, OfWhatHasNoHalfIsRefused) {
  PipelineOptions options;
  options.symmetry = SymmetryOptions{0};
  options.simplify->limits.balls.emplace_back();
  EXPECT_THROW(run_pipeline(analytic::box({4, 3, 2}, 0.25), options), WrongUsage);
  options.simplify = SimplifyOptions{.method = SimplifyMethod::collapse};
  EXPECT_THROW(run_pipeline(analytic::box({4, 3, 2}, 0.25), options), WrongUsage);
  options.simplify = SimplifyOptions{};
  options.repair.reset();
  options.tetrahedralize.reset();
  EXPECT_THROW(run_pipeline(analytic::sheet(4, 3, 0.25), options), WrongUsage);
}

}  // namespace
}  // namespace scan2fea
