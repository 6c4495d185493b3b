// Meshes in parts as parallel programs read them: two processes, each its own part, by VTK, DOLFINx, which solves a
// patch test on them, and a reader of Elmer's files after its manual (Debian has no Elmer).
#include "export/formats.hpp"
#include "export/partition.hpp"
#include "tests/part_with_sets.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>

#include <cstdio>
#include <map>
#include <sstream>
#include <sys/wait.h>

namespace scan2fea {
namespace {

constexpr std::size_t processes = 2;

// The faces of BRACKET on the plane where it meets PIN.
void add_interface(TetMesh& mesh) {
  NamedSet& set = mesh.face_sets.emplace_back(NamedSet{"BETWEEN", {}});
  for (const std::uint32_t t : mesh.element_sets[0].members)
    for (std::uint8_t k = 0; k < 4; ++k) {
      const Triangle corners = boundary_triangle(mesh, {t, k});
      if (!std::ranges::all_of(corners, [&](std::uint32_t n) { return mesh.nodes[n].x() == 2; })) continue;
      set.members.push_back(static_cast<std::uint32_t>(mesh.boundary.size()));
      mesh.boundary.push_back({t, k});
      ++mesh.faces_between;
    }
}

struct Told {
  int status = 0;
  std::string printed;
  std::vector<double> mesh;  // nodes, tetrahedra, volume, error
  std::vector<std::uint32_t> parts;
  std::map<std::string, double> sets;

  // A library, or mpirun.
  bool is_missing() const { return status == 77 || status == 127; }
};

Told read_in_parallel(const std::string& arguments) {
  // Debian's own interpreter, and as root, too.
  const std::string command = "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe -n " +
                              std::to_string(processes) +
                              " /usr/bin/python3 '" SCAN2FEA_TESTS_FOLDER "/read_in_parallel.py' " + arguments +
                              " 2>&1";
  Told told;
  FILE* pipe = popen(command.c_str(), "r");
  for (int byte = 0; (byte = std::fgetc(pipe)) != EOF;) told.printed += static_cast<char>(byte);
  told.status = WEXITSTATUS(pclose(pipe));
  std::istringstream lines(told.printed);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string first, name;
    words >> first;
    if (first == "mesh")
      for (double figure = 0; words >> figure;) told.mesh.push_back(figure);
    if (first == "set") words >> name >> told.sets[name];
    if (first == "part") words >> told.parts.emplace_back();
  }
  return told;
}

class ParallelReaders : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    mesh_ = analytic::part_with_sets(GetParam(), {8, 4, 2});
    add_interface(mesh_);
    options_.part_sizes = order_by_parts(mesh_, processes);
  }

  // The mesh that all processes together have is the one that was written, part by part.
  void expect_the_mesh(const Told& told) const {
    ASSERT_EQ(told.status, 0) << told.printed;
    ASSERT_EQ(told.mesh.size(), 4U) << told.printed;
    EXPECT_EQ(told.mesh[0], static_cast<double>(mesh_.nodes.size()));
    EXPECT_EQ(told.mesh[1], static_cast<double>(mesh_.tetrahedra.size()));
    EXPECT_NEAR(told.mesh[2], 8, 1e-12);
    EXPECT_LE(told.mesh[3], 1e-12) << told.printed;
    EXPECT_EQ(told.parts, options_.part_sizes);
  }

  static void expect_sets(const Told& told, const std::vector<NamedSet>& sets) {
    for (const NamedSet& set : sets) {
      ASSERT_TRUE(told.sets.contains(set.name)) << set.name << " in:\n" << told.printed;
      EXPECT_EQ(told.sets.at(set.name), static_cast<double>(set.members.size())) << set.name;
    }
  }

  TemporaryFolder folder_;
  TetMesh mesh_;
  FileOptions options_;
};
INSTANTIATE_TEST_SUITE_P(Order, ParallelReaders, testing::Values(1, 2));

TEST_P(ParallelReaders, VtkReadsAPieceAProcess) {
  write_volume(mesh_, folder_ / "part.pvtu", options_);
  const Told told = read_in_parallel("vtk '" + (folder_ / "part.pvtu").string() + "'");
  if (told.is_missing()) GTEST_SKIP() << "VTK or mpi4py is not installed (see examples/setup)";
  expect_the_mesh(told);
  expect_sets(told, mesh_.node_sets);
  expect_sets(told, mesh_.face_sets);
  expect_sets(told, mesh_.element_sets);
}

TEST_P(ParallelReaders, ElmersPartsFitTogether) {
  write_volume(mesh_, folder_ / "mesh.header", options_);
  const Told told = read_in_parallel("elmer '" + (folder_ / "mesh.header").string() + "'");
  if (told.is_missing()) GTEST_SKIP() << "mpi4py is not installed (see examples/setup)";
  expect_the_mesh(told);
  expect_sets(told, mesh_.face_sets);
  expect_sets(told, mesh_.element_sets);
}

TEST_P(ParallelReaders, DolfinxKeepsThePartsAndSolvesThePatchTest) {
  write_volume(mesh_, folder_ / "part.xdmf", options_);
  const Told told =
      read_in_parallel("dolfinx '" + folder_.path().string() + "' '" SCAN2FEA_TESTS_FOLDER "/../export/xdmf.hpp'");
  if (told.is_missing()) GTEST_SKIP() << "DOLFINx is not installed (see examples/setup)";
  expect_the_mesh(told);
  for (const char* name : {"area_of_FIXED", "area_of_LOADED"}) {
    ASSERT_TRUE(told.sets.contains(name)) << told.printed;
    EXPECT_NEAR(told.sets.at(name), 2, 1e-12) << name;
  }
}

}  // namespace
}  // namespace scan2fea
