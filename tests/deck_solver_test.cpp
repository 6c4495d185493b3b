// The real CalculiX on decks as they are written: reactions are the load, and frequencies those of theory and DOLFINx.
#include "export/formats.hpp"
#include "export/units.hpp"
#include "tests/calculix.hpp"
#include "tests/part_with_sets.hpp"
#include "tests/run_command.hpp"
#include "tests/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <sstream>
#include <sys/wait.h>

namespace scan2fea {
namespace {

class DeckSolver : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (!calculix::available()) GTEST_SKIP() << "ccx is not installed";
  }

  // Through the command, in another unit if one is given; returns the deck's name without its extension.
  std::string write_deck(const TetMesh& mesh, const std::string& kind, const std::string& unit = "mm") {
    write_volume(mesh, folder_ / "given.inp");
    const std::string scale = unit == "mm" ? "" : " --scale mm:" + unit;
    const CommandResult result =
        run_command("convert '" + (folder_ / "given.inp").string() + "' -o '" + (folder_ / "part.inp").string() +
                    "' --force --quiet --deck " + kind + scale);
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    return "part_" + kind;
  }

  // What CalculiX prints into the .dat file.
  std::string solve(const std::string& deck) {
    const int status =
        std::system(("cd '" + folder_.path().string() + "' && ccx -i " + deck + " > ccx.log 2>&1").c_str());
    EXPECT_EQ(status, 0) << contents(folder_ / "ccx.log");
    EXPECT_EQ(contents(folder_ / "ccx.log").find("*ERROR"), std::string::npos) << contents(folder_ / "ccx.log");
    return contents(folder_ / (deck + ".dat"));
  }

  static Vec3 reactions(const std::string& printed) {
    const std::size_t at = printed.find("total force");
    EXPECT_NE(at, std::string::npos) << printed;
    std::istringstream numbers(printed.substr(printed.find('\n', at)));
    Vec3 sum(0, 0, 0);
    numbers >> sum[0] >> sum[1] >> sum[2];
    return sum;
  }

  // In hertz.
  static std::vector<double> frequencies(const std::string& printed) {
    std::vector<double> found;
    std::istringstream lines(printed.substr(printed.find("E I G E N V A L U E")));
    for (std::string line; std::getline(lines, line) && found.size() < 10;) {
      std::istringstream fields(line);
      std::size_t mode = 0;
      double eigenvalue = 0, angular = 0, frequency = 0;
      if (fields >> mode >> eigenvalue >> angular >> frequency) found.push_back(frequency);
    }
    return found;
  }

  TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Order, DeckSolver, testing::Values(1, 2));

// A megapascal on two square millimetres, in whatever unit; and the weight where its lines are taken in.
TEST_P(DeckSolver, ReactionsAreTheLoad) {
  const TetMesh mesh = analytic::part_with_sets(GetParam(), {8, 4, 3});
  constexpr double newtons = 2, pound_force = 4.4482216152605;
  for (const auto& [unit, force] :
       {std::pair("mm", newtons), {"m", newtons}, {"um", newtons * 1e6}, {"in", newtons / pound_force}}) {
    const Vec3 reaction = reactions(solve(write_deck(mesh, "static", unit)));
    EXPECT_LE((reaction - Vec3(force, 0, 0)).norm(), 2e-6 * force) << unit << " " << reaction.transpose();
  }
  const std::string deck = write_deck(mesh, "static");
  std::string text = contents(folder_ / (deck + ".inp"));
  for (const std::string line : {"** *DLOAD", "** EALL, GRAV"}) text.erase(text.find(line), 3);
  write_text(folder_ / (deck + ".inp"), text);
  // The share of the clamped nodes is not in the sum: less than a layer of elements.
  const double weight = 8 * 7.85e-9 * 9806.65, share = reactions(solve(deck)).z() / weight;
  EXPECT_GT(share, 1 - 1.0 / 8);
  EXPECT_LT(share, 1);
}

TetMesh cantilever(int order) {
  TetMesh mesh = analytic::tetrahedra_of_box({100, 8, 5}, {40, 4, 2}, order);
  mesh.boundary = find_boundary(mesh.tetrahedra);
  mesh.face_sets = {named_set("fixed", analytic::boundary_faces_at(mesh, 0))};
  mesh.unit = "mm";
  return mesh;
}

// Twenty times as long as it is thick: shear and the clamp's width change theory's first frequencies by some per mille.
TEST_F(DeckSolver, FrequenciesAreThoseOfABeam) {
  for (const std::string unit : {"mm", "m", "in"}) {
    const std::vector<double> found = frequencies(solve(write_deck(cantilever(2), "modal", unit)));
    ASSERT_EQ(found.size(), 10U);
    const auto of_beam = [](double root, double thickness) {  // Euler and Bernoulli; metres
      const double radius = thickness / std::sqrt(12.0);
      return root * root / (2 * std::numbers::pi) * std::sqrt(210e9 / 7850) * radius / (0.1 * 0.1);
    };
    EXPECT_NEAR(found[0] / of_beam(1.8751041, 0.005), 1, 0.01) << unit;
    EXPECT_NEAR(found[1] / of_beam(1.8751041, 0.008), 1, 0.01) << unit;
    EXPECT_NEAR(found[2] / of_beam(4.6940911, 0.005), 1, 0.015) << unit;
  }
}

TEST_P(DeckSolver, FrequenciesAreThoseOfDolfinx) {
  const TetMesh mesh = cantilever(GetParam());
  const std::vector<double> found = frequencies(solve(write_deck(mesh, "modal")));
  TetMesh tagged = mesh;
  tagged.face_sets[0].name = "FIXED";
  write_volume(tagged, folder_ / "part.xdmf");
  // CalculiX integrates masses by the rule of its stiffness: of one point, or of four.
  const std::string order = std::to_string(GetParam()), file = (folder_ / "part.xdmf").string();
  const int status =
      WEXITSTATUS(std::system(("/usr/bin/python3 '" SCAN2FEA_TESTS_FOLDER "/modes_of_xdmf.py' '" + file + "' " + order +
                               " 10 " + order + " > '" + file + ".modes' 2> '" + file + ".log'")
                                  .c_str()));
  if (status == 77 || status == 127) GTEST_SKIP() << "python3-dolfinx is not installed";
  ASSERT_EQ(status, 0) << contents(file + ".log");
  std::istringstream eigenvalues(contents(file + ".modes"));
  for (const double frequency : found) {
    double eigenvalue = 0;
    eigenvalues >> eigenvalue;
    EXPECT_NEAR(frequency / (std::sqrt(eigenvalue) / (2 * std::numbers::pi)), 1, 1e-5);
  }
}

}  // namespace
}  // namespace scan2fea
