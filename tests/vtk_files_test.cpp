// What VTK and meshio save, in every way that they know, is read: the ball's surface and the box of tetrahedra.
#include "export/formats.hpp"
#include "tests/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <numbers>

namespace scan2fea {
namespace {

TEST(VtkFiles, OfVtkAndMeshioAreRead) {
  const TemporaryFolder folder;
  const int status = std::system(
      ("/usr/bin/python3 '" SCAN2FEA_TESTS_FOLDER "/write_vtk_files.py' '" + folder.path().string() + "'").c_str());
  if (WEXITSTATUS(status) == 77 || WEXITSTATUS(status) == 127) GTEST_SKIP() << "python3-vtk9 or python3-meshio is missing";
  ASSERT_EQ(status, 0);
  std::size_t balls = 0, boxes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    const std::string name = entry.path().filename().string();
    const MeshFile read = read_mesh(entry.path());
    if (name.starts_with("ball")) {
      ASSERT_FALSE(read.is_volume()) << name;
      const SurfaceMesh& ball = std::get<NamedSurface>(read.mesh).mesh;
      EXPECT_EQ(ball.triangles.size(), 2 * 24 * 15U - 2 * 24U) << name;
      EXPECT_NEAR(enclosed_volume(ball), std::numbers::pi / 6, 0.03) << name;
      EXPECT_GT(enclosed_volume(ball), 0) << name;
      ++balls;
    } else {
      ASSERT_TRUE(read.is_volume()) << name;
      EXPECT_NEAR(total_volume(std::get<TetMesh>(read.mesh)), 12, 1e-12) << name;
      ++boxes;
    }
  }
  EXPECT_EQ(balls, 21U);
  EXPECT_EQ(boxes, 20U);
}

}  // namespace
}  // namespace scan2fea
