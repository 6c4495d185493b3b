// The real CalculiX, with the sets that write_inp writes: a patch test, a pressure on a set of faces, and modes of
// vibration that DOLFINx finds, too, on the XDMF of the same mesh.
#include "export/inp.hpp"
#include "export/xdmf.hpp"
#include "tests/calculix.hpp"
#include "tests/part_with_sets.hpp"
#include "tests/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <sys/wait.h>

namespace scan2fea {
namespace {

constexpr const char* steel =
    "*MATERIAL, NAME=M\n*ELASTIC\n210000, 0.3\n*DENSITY\n7.85E-9\n*SOLID SECTION, ELSET=BRACKET, MATERIAL=M\n"
    "*SOLID SECTION, ELSET=PIN, MATERIAL=M\n";

class CalculixSets : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (!calculix::available()) GTEST_SKIP() << "ccx is not installed";
    // Sheared, so that nothing holds by symmetry; edges stay straight, so that all rules of integration are exact.
    for (Vec3& p : mesh_.nodes) p = Vec3(10 * p.x() + 2 * p.z(), 8 * p.y() + 3 * p.x(), 7 * p.z() + p.y());
    write_inp(mesh_, folder_ / "part.inp");
  }

  // What CalculiX prints into the .dat file.
  std::string run(const std::string& steps) {
    write_text(folder_ / "deck.inp", "*INCLUDE, INPUT=part.inp\n" + std::string(steel) + steps);
    const int status = std::system(("cd '" + folder_.path().string() + "' && ccx -i deck > ccx.log 2>&1").c_str());
    EXPECT_EQ(status, 0) << contents(folder_ / "ccx.log");
    return contents(folder_ / "deck.dat");
  }

  TetMesh mesh_ = analytic::part_with_sets(GetParam(), {6, 4, 3});
  TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Order, CalculixSets, testing::Values(1, 2));

// The linear displacement is given at every node, so that the forces inside, which are printed to their own last digits
// and not to those of a displacement, show how exact the elements are: all of the residual of the exact solution.
TEST_P(CalculixSets, PatchTestIsExact) {
  std::ostringstream step;
  step.precision(17);
  step << "*STEP\n*STATIC\n*BOUNDARY\n";
  for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) {
    const Vec3& p = mesh_.nodes[n];
    const Vec3 u(1e-3 * p.x() + 2e-3 * p.y(), -3e-3 * p.z(), 1e-3 * p.x() - 1e-3 * p.y());
    for (int k = 0; k < 3; ++k) {
      char value[32];
      std::snprintf(value, sizeof value, "%.12E", u[k]);
      step << n + 1 << ", " << k + 1 << ", " << k + 1 << ", " << value << "\n";
    }
  }
  step << "*NODE PRINT, NSET=NALL\nRF\n*END STEP\n";
  std::istringstream printed(run(step.str()));
  const std::vector<bool> on_boundary = [&] {
    std::vector<bool> is(mesh_.nodes.size(), false);
    for (std::uint32_t f = 0; f < mesh_.boundary.size(); ++f)
      for (const std::uint32_t n : nodes_of_faces(mesh_, std::array{f})) is[n] = true;
    return is;
  }();
  double largest = 0, inside = 0;
  std::size_t rows = 0;
  for (std::string line; std::getline(printed, line);) {
    std::istringstream fields(line);
    std::size_t node = 0;
    Vec3 force;
    if (!(fields >> node >> force[0] >> force[1] >> force[2])) continue;
    ++rows;
    (on_boundary[node - 1] ? largest : inside) = std::max(on_boundary[node - 1] ? largest : inside, force.norm());
  }
  EXPECT_EQ(rows, mesh_.nodes.size());
  EXPECT_GT(largest, 1);
  EXPECT_LE(inside, 1e-10 * largest) << "nodes inside: forces of " << inside << " beside " << largest;
}

TEST_P(CalculixSets, APressureOnASetSumsToPressureTimesArea) {
  constexpr double pressure = 3;
  Vec3 resultant = Vec3::Zero();
  for (const std::uint32_t f : mesh_.face_sets[1].members) {
    const Triangle t = boundary_triangle(mesh_, mesh_.boundary[f]);
    const Vec3& a = mesh_.nodes[t[0]];
    resultant += pressure / 2 * (mesh_.nodes[t[1]] - a).cross(mesh_.nodes[t[2]] - a);
  }
  const std::string printed =
      run("*STEP\n*STATIC\n*BOUNDARY\nFIXED_NODES, 1, 3\n*DSLOAD\nLOADED, P, 3\n"
          "*NODE PRINT, NSET=FIXED_NODES, TOTALS=ONLY\nRF\n*END STEP\n");
  const std::size_t at = printed.find("total force");
  ASSERT_NE(at, std::string::npos) << printed;
  std::istringstream numbers(printed.substr(printed.find('\n', at)));
  Vec3 reaction;
  numbers >> reaction[0] >> reaction[1] >> reaction[2];
  EXPECT_LE((reaction - resultant).norm(), 2e-6 * resultant.norm()) << reaction.transpose() << "\n"
                                                                    << resultant.transpose();
}

TEST_P(CalculixSets, ModesAreThoseOfDolfinx) {
  constexpr std::size_t modes = 6;
  const std::string printed =
      run("*BOUNDARY\nFIXED_NODES, 1, 3\n*STEP\n*FREQUENCY\n" + std::to_string(modes) + "\n*END STEP\n");
  std::vector<double> eigenvalues;
  std::istringstream lines(printed.substr(printed.find("E I G E N V A L U E")));
  for (std::string line; std::getline(lines, line) && eigenvalues.size() < modes;) {
    std::istringstream fields(line);
    std::size_t mode = 0;
    double value = 0;
    if (fields >> mode >> value) eigenvalues.push_back(value);
  }
  ASSERT_EQ(eigenvalues.size(), modes) << printed;

  write_xdmf(mesh_, folder_ / "part.xdmf");
  // CalculiX integrates masses by the rule of its stiffness: of one point, or of four.
  const std::string degree = std::to_string(GetParam());
  const std::string command = "/usr/bin/python3 '" SCAN2FEA_TESTS_FOLDER "/modes_of_xdmf.py' '" +
                              (folder_ / "part.xdmf").string() + "' " + std::to_string(GetParam()) + " " +
                              std::to_string(modes) + " " + degree + " > '" + (folder_ / "modes").string() + "' 2> '" +
                              (folder_ / "log").string() + "'";
  const int status = WEXITSTATUS(std::system(command.c_str()));
  if (status == 77 || status == 127) GTEST_SKIP() << "python3-dolfinx is not installed";
  ASSERT_EQ(status, 0) << contents(folder_ / "log");
  std::istringstream of_dolfinx(contents(folder_ / "modes"));
  for (const double eigenvalue : eigenvalues) {
    double other = 0;
    of_dolfinx >> other;
    EXPECT_NEAR(eigenvalue / other, 1, 1e-6) << "CalculiX prints seven digits";
  }
}

}  // namespace
}  // namespace scan2fea
