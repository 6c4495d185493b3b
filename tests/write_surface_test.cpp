#include "preproc/mesh/write_surface.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/read_surface.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace scan2fea {
namespace {

class WriteSurface : public testing::TestWithParam<const char*> {
 protected:
  SurfaceMesh round_trip(const SurfaceMesh& mesh) const {
    const std::filesystem::path file = folder_ / (std::string("part") + GetParam());
    write_surface(mesh, file);
    return read_surface(file);
  }

  TemporaryFolder folder_;
};

using WriteSurfaceExactly = WriteSurface;

TEST_P(WriteSurfaceExactly, KeepsAllDigitsAndTheOrder) {
  SurfaceMesh mesh = analytic::torus(3, 1, 24, 12);
  mesh.vertices[0] = {std::numbers::pi * 1e-300, -std::numbers::e * 1e300, 1.0 / 3};
  mesh.vertices[1] = {std::numeric_limits<double>::denorm_min(), std::nextafter(1.0, 2.0), 123456789012345680.0};
  const SurfaceMesh read = round_trip(mesh);
  EXPECT_EQ(read.vertices, mesh.vertices);
  EXPECT_EQ(read.triangles, mesh.triangles);
}

INSTANTIATE_TEST_SUITE_P(Formats, WriteSurfaceExactly, testing::Values(".ply", ".obj", ".off"));

TEST_P(WriteSurface, KeepsClosedSurfacesClosed) {
  const SurfaceMesh mesh = analytic::slab_with_holes(2, 0.25);
  const SurfaceMesh read = round_trip(mesh);
  EXPECT_EQ(read.vertices.size(), mesh.vertices.size());
  EXPECT_EQ(read.triangles.size(), mesh.triangles.size());
  EXPECT_NEAR(enclosed_volume(read), enclosed_volume(mesh), 1e-9);
  EXPECT_NEAR(surface_area(read), surface_area(mesh), 1e-9);
}

TEST_P(WriteSurface, RefusesAMissingFolder) {
  EXPECT_THROW(write_surface(analytic::sphere(1, 0), folder_ / "missing" / (std::string("part") + GetParam())),
               IoError);
}

INSTANTIATE_TEST_SUITE_P(Formats, WriteSurface, testing::Values(".ply", ".obj", ".off", ".stl", ".STL"));

TEST(WriteStl, RoundsToTheNearestFloat) {
  const TemporaryFolder folder;
  SurfaceMesh mesh = analytic::sphere(std::numbers::pi, 2);
  write_surface(mesh, folder / "part.stl");
  const SurfaceMesh read = read_surface(folder / "part.stl");
  ASSERT_EQ(read.triangles.size(), mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& written = mesh.vertices[mesh.triangles[t][k]];
      for (int axis = 0; axis < 3; ++axis)  // Eigen 3.4 drops a cast to float and back
        EXPECT_EQ(read.vertices[read.triangles[t][k]][axis], static_cast<double>(static_cast<float>(written[axis])));
    }
}

TEST(WriteStl, IsNotTakenForAscii) {
  const TemporaryFolder folder;
  write_surface(analytic::sphere(1, 1), folder / "part.stl");
  EXPECT_FALSE(contents(folder / "part.stl").starts_with("solid"));
}

TEST(WriteStl, RefusesCoordinatesBeyondFloats) {
  const TemporaryFolder folder;
  SurfaceMesh mesh = analytic::sphere(1, 0);
  mesh.vertices[3][1] = 1e39;
  EXPECT_THROW(write_surface(mesh, folder / "part.stl"), IoError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(WriteSurfaceFormats, UnknownExtensionIsWrongUsage) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_surface(analytic::sphere(1, 0), folder / "part.step"), WrongUsage);
  EXPECT_THROW(write_surface(analytic::sphere(1, 0), folder / "part"), WrongUsage);
}

}  // namespace
}  // namespace scan2fea
