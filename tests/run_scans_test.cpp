// Real scans go through the whole chain: a closed one, one with holes and crossings, one with sharp edges.
#include "tests/run_command.hpp"
#include "tests/scans.hpp"
#include "tests/temporary_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace scan2fea {
namespace {

class RunScans : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Scan, RunScans, ::testing::Values("armadillo.off", "ChineseDragon-10kv.off", "fandisk.off"));

TEST_P(RunScans, BecomeSoundMeshes) {
  const TemporaryFolder folder;
  const std::string mesh = "'" + (folder / "part.inp").string() + "'";
  const CommandResult run =
      run_command("run '" + scan(GetParam()).string() + "' -o " + mesh + " --faces 6000 --order 2 --quiet --json -");
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  EXPECT_EQ(run.standard_error, "");

  const auto made = nlohmann::json::parse(run.standard_output);
  const auto& surface = made["surface"];
  EXPECT_NEAR(surface["faces"].get<double>(), 6000, 60);
  EXPECT_TRUE(surface["closed"].get<bool>());
  EXPECT_TRUE(surface["manifold"].get<bool>());
  EXPECT_EQ(surface["self_intersections"].get<int>(), 0);
  EXPECT_LE(surface["edge_ratio"]["mean"].get<double>(), 1.25);
  // That of the corners is the scan's; the curved elements' follows the scan where their nodes are put onto it.
  EXPECT_LE(std::abs(made["deviation"]["volume_difference_pct"].get<double>()), 0.2);
  EXPECT_EQ(made["volume_mesh"]["inverted"].get<int>(), 0);
  const double volume = surface["volume"].get<double>();
  EXPECT_NEAR(made["volume_mesh"]["volume"].get<double>(), volume, 1e-9 * volume);

  // What the file holds is what was measured before it was written.
  const CommandResult check = run_command("check " + mesh + " --quiet --json -");
  ASSERT_EQ(check.exit_code, 0) << check.standard_error;
  const auto read = nlohmann::json::parse(check.standard_output);
  EXPECT_EQ(read["surface"]["faces"], surface["faces"]);
  EXPECT_NEAR(read["surface"]["volume"].get<double>(), volume, 1e-9 * volume);
  for (const char* count : {"nodes", "tetrahedra", "order", "inverted"})
    EXPECT_EQ(read["volume_mesh"][count], made["volume_mesh"][count]) << count;
}

}  // namespace
}  // namespace scan2fea
