// What the command tells of scans that it thins, and how it counts.
#include "preproc/mesh/read_surface.hpp"
#include "preproc/mesh/write_surface.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/run_command.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace scan2fea {
namespace {

using testing::HasSubstr;

class LargeScanCommand : public testing::Test {
 protected:
  void SetUp() override { write_surface(analytic::torus(3, 1, 300, 100), folder / "torus.stl"); }
  CommandResult surface(const std::string& options) const {
    const std::string out = (folder / "out.ply").string(), json = (folder / "figures.json").string();
    return run_command("surface " + (folder / "torus.stl").string() + " -o " + out + " --force --json " + json + " " +
                       options);
  }
  TemporaryFolder folder;
};

TEST_F(LargeScanCommand, TellsWhatWasThinned) {
  const CommandResult result = surface("--largest-scan 50000 --faces 2000 --quiet");
  ASSERT_EQ(result.exit_code, 0) << result.standard_error;
  const auto figures = nlohmann::json::parse(contents(folder / "figures.json"));
  const auto& stage = figures.at("stages").at(0);
  EXPECT_EQ(stage.at("name"), "thin");
  EXPECT_EQ(stage.at("triangles_given"), 60000);
  EXPECT_GT(stage.at("largest_distance"), 0);
  EXPECT_LT(stage.at("volume_difference_pct"), 0);  // chords
  EXPECT_GT(stage.at("volume_difference_pct"), -1);
  EXPECT_THAT(result.standard_error, HasSubstr("60000 triangles and was thinned to"));
}

TEST_F(LargeScanCommand, AShareIsOfWhatWasGiven) {
  ASSERT_EQ(surface("--largest-scan 50000 --ratio 0.05").exit_code, 0);
  const double triangles = static_cast<double>(read_surface(folder / "out.ply").triangles.size());
  EXPECT_NEAR(triangles, 3000, 150);
}

TEST_F(LargeScanCommand, TellsWhichOfSeveralWasThinned) {
  const SurfaceMesh torus = analytic::torus(3, 1, 300, 100);
  write_surface(analytic::moved(torus, {20, 0, 0}), folder / "other.stl");
  const CommandResult result =
      run_command("run " + (folder / "torus.stl").string() + " " + (folder / "other.stl").string() + " -o " +
                  (folder / "both.inp").string() + " --largest-scan 50000 --faces 2000 --effort low --quiet");
  ASSERT_EQ(result.exit_code, 0) << result.standard_error;
  EXPECT_THAT(result.standard_error, HasSubstr("the scan torus.stl has 60000 triangles"));
  EXPECT_THAT(result.standard_error, HasSubstr("the scan other.stl has 60000 triangles"));
}

// So many as four times those that are asked for are never thinned away.
TEST_F(LargeScanCommand, KeepsEnoughForWhatIsAskedFor) {
  const CommandResult result = surface("--largest-scan 1000 --faces 16000");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.standard_error, testing::Not(HasSubstr("thinned")));
}

TEST_F(LargeScanCommand, ADistanceCountsFromWhatWasGiven) {
  const CommandResult result = surface("--largest-scan 40000 --deviation 0.001");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.standard_error, HasSubstr("more than half of the distance"));
  EXPECT_THAT(result.standard_error, HasSubstr("--largest-scan "));
}

}  // namespace
}  // namespace scan2fea
