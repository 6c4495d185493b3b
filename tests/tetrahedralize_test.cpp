#include "preproc/volume/tetrahedralize.hpp"

#include "preproc/mesh/error.hpp"
#include "quality/tetrahedron_measures.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/error_from.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <filesystem>

namespace scan2fea {
namespace {

using testing::HasSubstr;
using testing::Not;

Triangle starting_at_least(const Triangle& t) {
  if (t[0] < t[1] && t[0] < t[2]) return t;
  return t[1] < t[2] ? Triangle{t[1], t[2], t[0]} : Triangle{t[2], t[0], t[1]};
}

void expect_valid(const SurfaceMesh& surface, const TetMesh& mesh) {
  ASSERT_EQ(mesh.boundary.size(), surface.triangles.size());
  for (std::size_t i = 0; i < surface.triangles.size(); ++i)
    ASSERT_EQ(starting_at_least(boundary_triangle(mesh, mesh.boundary[i])), starting_at_least(surface.triangles[i]))
        << i;
  ASSERT_EQ(find_boundary(mesh.tetrahedra).size(), surface.triangles.size());
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) ASSERT_EQ(mesh.nodes[i], surface.vertices[i]) << i;
  for (const Tetrahedron& t : mesh.tetrahedra) {
    const Vec3& a = mesh.nodes[t[0]];
    ASSERT_GT((mesh.nodes[t[1]] - a).cross(mesh.nodes[t[2]] - a).dot(mesh.nodes[t[3]] - a), 0);
  }
  EXPECT_NEAR(total_volume(mesh), enclosed_volume(surface), 1e-10 * enclosed_volume(surface));
}

TEST(Tetrahedralize, KeepsTheBoundaryTriangleByTriangle) {
  for (const SurfaceMesh& surface :
       {analytic::sphere(2, 3), analytic::box({1, 2, 3}, 0.4), analytic::torus(3, 1, 40, 16),
        analytic::slab_with_holes(2, 0.25), analytic::noisy(analytic::sphere(1, 3), 0.004, 1)})
    expect_valid(surface, tetrahedralize(surface).mesh);
}

TEST(Tetrahedralize, ThinPlateKeepsItsBoundary) {
  const SurfaceMesh plate = analytic::box({20, 20, 0.5}, 1);
  expect_valid(plate, tetrahedralize(plate).mesh);
}

TEST(Tetrahedralize, FarFromTheOriginStillAddsUp) {
  const SurfaceMesh surface = analytic::moved(analytic::sphere(1, 2), {1e4, -1e4, 1e4});
  expect_valid(surface, tetrahedralize(surface).mesh);
}

TEST(Tetrahedralize, CavityStaysEmptyAndABodyInItIsFilled) {
  const SurfaceMesh hollow = analytic::join(analytic::sphere(3, 3), analytic::reversed(analytic::sphere(2, 3)));
  expect_valid(hollow, tetrahedralize(hollow).mesh);
  const SurfaceMesh with_core = analytic::join(hollow, analytic::sphere(1, 2));
  expect_valid(with_core, tetrahedralize(with_core).mesh);
}

TEST(Tetrahedralize, SeparateBodiesAreAllFilled) {
  const SurfaceMesh two =
      analytic::join(analytic::box({1, 1, 1}, 0.5), analytic::moved(analytic::sphere(1, 2), {5, 0, 0}));
  expect_valid(two, tetrahedralize(two).mesh);
}

TEST(Tetrahedralize, MaxVolumeMakesSmallerElements) {
  const SurfaceMesh surface = analytic::box({1, 1, 1}, 0.2);
  for (const InteriorPoints interior : {InteriorPoints::lattice, InteriorPoints::tetgen}) {
    TetrahedralizeOptions options;
    options.interior = interior;
    const TetMesh coarse = tetrahedralize(surface, options).mesh;
    options.max_volume = 2e-4;
    const TetMesh fine = tetrahedralize(surface, options).mesh;
    expect_valid(surface, fine);
    EXPECT_GT(fine.tetrahedra.size(), 2 * coarse.tetrahedra.size());
  }
}

TEST(Tetrahedralize, InteriorSizeMakesFewerElements) {
  const SurfaceMesh surface = analytic::box({1, 1, 1}, 0.05);
  std::size_t before = std::numeric_limits<std::size_t>::max();
  for (const double value : {1.3, 1.6, 3.0}) {
    TetrahedralizeOptions options;
    options.interior_size.value = value;
    const TetMesh mesh = tetrahedralize(surface, options).mesh;
    expect_valid(surface, mesh);
    EXPECT_LT(mesh.tetrahedra.size(), before);
    before = mesh.tetrahedra.size();
  }
}

TEST(Tetrahedralize, TellsTheCountBeforehandWithinAFifth) {
  for (const SurfaceMesh& surface : {analytic::sphere(1, 4), analytic::box({1, 1, 1}, 0.1),
                                     analytic::torus(3, 1, 60, 24), analytic::box({20, 20, 0.5}, 1)})
    for (const double value : {1.3, 1.6, 3.0}) {
      TetrahedralizeOptions options;
      options.interior_size.value = value;
      std::string told;
      const Progress progress([](std::string_view, double) { return true; },
                              [&](std::string_view work, double) { told = work; });
      const TetrahedralizeResult result = tetrahedralize(surface, options, progress);
      const auto count = static_cast<double>(result.mesh.tetrahedra.size());
      EXPECT_NEAR(static_cast<double>(result.estimated_tetrahedra), count, 0.2 * count) << surface.triangles.size();
      EXPECT_THAT(told, HasSubstr(std::to_string(result.estimated_tetrahedra)));
    }
}

TEST(Tetrahedralize, ThinWallsAreLeftToTetGen) {
  EXPECT_EQ(tetrahedralize(analytic::box({20, 20, 0.5}, 1)).interior, InteriorPoints::tetgen);
  EXPECT_EQ(tetrahedralize(analytic::box({3, 3, 3}, 0.5)).interior, InteriorPoints::lattice);
}

TEST(Tetrahedralize, PartsThickAndThinAreGoodInBoth) {
  const SurfaceMesh surface = analytic::block_with_fin(1);
  TetrahedralizeOptions options;
  const TetrahedralizeResult result = tetrahedralize(surface, options);
  EXPECT_EQ(result.interior, InteriorPoints::lattice);
  expect_valid(surface, result.mesh);
  const auto count = static_cast<double>(result.mesh.tetrahedra.size());
  EXPECT_NEAR(static_cast<double>(result.estimated_tetrahedra), count, 0.2 * count);
  options.interior = InteriorPoints::tetgen;
  EXPECT_GE(measure_tetrahedra(result.mesh).min_dihedral_deg,
            0.9 * measure_tetrahedra(tetrahedralize(surface, options).mesh).min_dihedral_deg);
}

TEST(Tetrahedralize, SameBytesForAnyNumberOfThreads) {
  const SurfaceMesh surface = analytic::noisy(analytic::sphere(1, 4), 0.004, 1);
  std::vector<TetMesh> meshes;
  for (const std::size_t threads : {1, 2, 5}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    meshes.push_back(tetrahedralize(surface).mesh);
    EXPECT_EQ(meshes.back().tetrahedra, meshes.front().tetrahedra);
    EXPECT_EQ(meshes.back().nodes, meshes.front().nodes);
  }
}

TEST(Tetrahedralize, WithoutTimeToOptimiseTheMeshIsValid) {
  const SurfaceMesh surface = analytic::sphere(1, 4);
  const Progress progress = Progress().until(Progress::Clock::time_point::max(), Progress::Clock::now());
  const TetrahedralizeResult result = tetrahedralize(surface, {}, progress);
  EXPECT_TRUE(result.optimised.stopped_by_time);
  EXPECT_TRUE(progress.ran_short());
  expect_valid(surface, result.mesh);
}

TEST(Tetrahedralize, SplitBoundaryNamesTheTriangleThatItLiesOn) {
  const SurfaceMesh surface = analytic::box({10, 1, 1}, 10);
  TetrahedralizeOptions options;
  options.max_volume = 0.1;
  options.split_boundary = true;
  const TetrahedralizeResult result = tetrahedralize(surface, options);
  ASSERT_EQ(result.boundary_parent.size(), result.mesh.boundary.size());
  ASSERT_GT(result.mesh.boundary.size(), surface.triangles.size());
  EXPECT_EQ(find_boundary(result.mesh.tetrahedra).size(), result.mesh.boundary.size());
  EXPECT_NEAR(total_volume(result.mesh), 10, 1e-9);
  for (std::size_t i = 0; i < result.mesh.boundary.size(); ++i) {
    const Triangle piece = boundary_triangle(result.mesh, result.mesh.boundary[i]);
    const Triangle& parent = surface.triangles[result.boundary_parent[i]];
    const Vec3 normal = area_vector(surface, parent).normalized();
    for (const std::uint32_t v : piece)
      EXPECT_NEAR((result.mesh.nodes[v] - surface.vertices[parent[0]]).dot(normal), 0, 1e-9);
  }
}

std::string failure(const SurfaceMesh& surface, const TetrahedralizeOptions& options = {}) {
  const auto error = error_from<MeshingFailed>([&] { tetrahedralize(surface, options); });
  EXPECT_EQ(error.exit_code(), 5);
  return error.what();
}

// Where it is not the mesher that fails.
std::string refusal(const SurfaceMesh& surface) {
  const auto error = error_from<NotMeshable>([&] { tetrahedralize(surface); });
  EXPECT_EQ(error.exit_code(), 4);
  return error.what();
}

TEST(Tetrahedralize, SelfIntersectionIsReported) {
  EXPECT_THAT(
      failure(analytic::join(analytic::sphere(1, 2), analytic::moved(analytic::sphere(1, 2), {0.9, 0.01, 0.02}))),
      HasSubstr("intersects itself"));
}

TEST(Tetrahedralize, ShellsThatFaceTheSameWayAreReported) {
  EXPECT_THAT(refusal(analytic::join(analytic::sphere(3, 2), analytic::sphere(1, 2))), HasSubstr("same way"));
}

TEST(Tetrahedralize, InsideOutIsReported) {
  EXPECT_THAT(refusal(analytic::reversed(analytic::sphere(1, 2))), HasSubstr("inside out"));
}

TEST(Tetrahedralize, OpenSurfaceIsReportedWithItsPlace) {
  SurfaceMesh open = analytic::box({1, 1, 1}, 1);
  std::erase_if(open.triangles, [&](const Triangle& t) {
    return std::ranges::all_of(t, [&](std::uint32_t v) { return open.vertices[v].z() == 1; });
  });
  const std::string text = refusal(open);
  EXPECT_THAT(text, HasSubstr("not closed"));
  EXPECT_THAT(text, HasSubstr(", 1): ")) << "on its border";
  EXPECT_THAT(text, HasSubstr("4 sides"));
  EXPECT_THAT(refusal({}), HasSubstr("no triangles"));
}

class TetrahedralizeChild : public testing::Test {
 protected:
  // A worker of this body.
  std::filesystem::path script(const std::string& body) const {
    const std::filesystem::path path = write_text(folder_ / "worker.sh", "#!/bin/sh\n" + body + "\n");
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    return path;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(TetrahedralizeChild, CrashIsReported) {
  TetrahedralizeOptions options;
  options.tetgen.worker = script("kill -SEGV $$");
  EXPECT_THAT(failure(analytic::sphere(1, 1), options), HasSubstr("signal 11"));
}

TEST_F(TetrahedralizeChild, WithoutOutputIsReported) {
  TetrahedralizeOptions options;
  options.tetgen.worker = script("exit 0");
  EXPECT_THROW(tetrahedralize(analytic::sphere(1, 1), options), Error);
}

TEST_F(TetrahedralizeChild, TimeLimitKillsIt) {
  TetrahedralizeOptions options;
  options.tetgen.worker = script("exec sleep 60");
  options.tetgen.time = std::chrono::milliseconds(100);
  EXPECT_THAT(failure(analytic::sphere(1, 1), options), HasSubstr("time limit"));
}

TEST_F(TetrahedralizeChild, TheEndOfTheTimeKillsIt) {
  TetrahedralizeOptions options;
  options.tetgen.worker = script("exec sleep 60");
  const Progress progress = Progress().until(Progress::Clock::now() + std::chrono::milliseconds(300));
  const auto error = error_from<OutOfTime>([&] { tetrahedralize(analytic::sphere(1, 1), options, progress); });
  EXPECT_EQ(error.exit_code(), 4);
  EXPECT_LT(Progress::Clock::now(), progress.end() + std::chrono::seconds(20));
}

TEST_F(TetrahedralizeChild, MemoryLimitIsReported) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer reserves more address space than any limit leaves";
#endif
  TetrahedralizeOptions options;
  options.max_volume = 1e-5;
  options.tetgen.memory_bytes = std::uint64_t{64} << 20;
  EXPECT_THAT(failure(analytic::sphere(1, 3), options), HasSubstr("memory"));
}

TEST(Tetrahedralize, MoreTetrahedraThanMemoryHoldsAreRefusedAtOnce) {
  TetrahedralizeOptions options;
  for (const InteriorSize& tiny :
       {InteriorSize{1e-4, InteriorSize::Unit::of_surface}, {1e-5, InteriorSize::Unit::model}}) {
    options.interior_size = tiny;
    const auto error = error_from<NotMeshable>([&] { tetrahedralize(analytic::sphere(1, 3), options); });
    EXPECT_THAT(error.what(), HasSubstr("memory"));
  }
}

TEST_F(TetrahedralizeChild, MoreTetrahedraThanAllowedAreNotMade) {
  TetrahedralizeOptions options;
  options.most_tetrahedra = 100;
  EXPECT_THROW(tetrahedralize(analytic::sphere(1, 3), options), NotMeshable);
}

TEST_F(TetrahedralizeChild, MissingWorkerIsReported) {
  TetrahedralizeOptions options;
  options.tetgen.worker = "/nonexistent/worker";
  EXPECT_THAT(failure(analytic::sphere(1, 1), options), HasSubstr("worker"));
}

TEST_F(TetrahedralizeChild, InterruptKillsIt) {
  TetrahedralizeOptions options;
  options.tetgen.worker = script("exec sleep 60");
  EXPECT_THROW(tetrahedralize(analytic::sphere(1, 1), options, Progress([](auto, double) { return false; })),
               Cancelled);
}

TEST_F(TetrahedralizeChild, LeavesNothingInTheTemporaryFolder) {
  const TemporaryFolder folder;
  const char* before = std::getenv("TMPDIR");
  const std::string saved = before ? before : "";
  setenv("TMPDIR", folder.path().c_str(), 1);
  tetrahedralize(analytic::sphere(1, 1));
  TetrahedralizeOptions crash;
  crash.tetgen.worker = script("kill -SEGV $$");
  failure(analytic::sphere(1, 1), crash);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  before ? setenv("TMPDIR", saved.c_str(), 1) : unsetenv("TMPDIR");
}

}  // namespace
}  // namespace scan2fea
