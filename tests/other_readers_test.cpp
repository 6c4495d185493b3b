// Readers that know nothing of scan2fea (Python's meshio and VTK) find in our files what we wrote.
#include "export/formats.hpp"
#include "tests/structured_tets.hpp"
#include "tests/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <sstream>
#include <string>
#include <sys/wait.h>

namespace scan2fea {
namespace {

struct Case {
  std::string library;
  std::string file;
  MshVersion msh_version;
};

// Otherwise the test's name shows the bytes of the struct, pointers among them.
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.library << " " << c.file << (c.msh_version == MshVersion::v2_2 ? " 2.2" : "");
}

class OtherReaders : public testing::TestWithParam<std::tuple<Case, int>> {};
INSTANTIATE_TEST_SUITE_P(LibraryAndOrder, OtherReaders,
                         testing::Combine(testing::Values(Case{"meshio", "box.inp", MshVersion::v4_1},
                                                          Case{"meshio", "box.msh", MshVersion::v2_2},
                                                          Case{"meshio", "box.msh", MshVersion::v4_1},
                                                          Case{"meshio", "box.vtu", MshVersion::v4_1},
                                                          Case{"vtk", "box.vtu", MshVersion::v4_1}),
                                          testing::Values(1, 2)));

TEST_P(OtherReaders, FindTheSameMesh) {
  const auto& [c, order] = GetParam();
  const TetMesh mesh = analytic::tetrahedra_of_box({3, 2, 1}, {3, 2, 2}, order);
  const TemporaryFolder folder;
  FileOptions options;
  options.provenance = "a test";
  options.msh_version = c.msh_version;
  write_volume(mesh, folder / c.file, options);

  // Debian's own interpreter, which has Debian's packages; another one may come first on the path.
  const std::string command = "/usr/bin/python3 '" SCAN2FEA_TESTS_FOLDER "/read_volume_mesh.py' " + c.library + " '" +
                              (folder / c.file).string() + "' 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string printed;
  for (int byte; (byte = std::fgetc(pipe)) != EOF;) printed += static_cast<char>(byte);
  const int status = WEXITSTATUS(pclose(pipe));
  if (status == 77 || status == 127)
    GTEST_SKIP() << c.library << " is not installed (Debian: python3-meshio, python3-vtk9)";
  ASSERT_EQ(status, 0) << printed;

  std::size_t nodes = 0, tetrahedra = 0;
  double volume = 0, midpoint_error = 1;
  // Some versions of meshio print warnings first.
  const std::size_t last_line = printed.rfind('\n', printed.size() - 2);
  std::istringstream(printed.substr(last_line == std::string::npos ? 0 : last_line + 1)) >> nodes >> tetrahedra >>
      volume >> midpoint_error;
  EXPECT_EQ(nodes, mesh.nodes.size());
  EXPECT_EQ(tetrahedra, mesh.tetrahedra.size());
  EXPECT_NEAR(volume, 6, 1e-12);
  EXPECT_LE(midpoint_error, 1e-12);
}

}  // namespace
}  // namespace scan2fea
