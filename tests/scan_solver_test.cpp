// The project's first promise: a real scan in, a mesh that a real solver solves out.
#include "export/formats.hpp"
#include "export/inp.hpp"
#include "tests/calculix.hpp"
#include "tests/run_command.hpp"
#include "tests/scans.hpp"
#include "tests/temporary_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <numeric>

namespace scan2fea {
namespace {

TEST(ScanSolver, ReactionsAreTheWeight) {
  if (!calculix::available()) GTEST_SKIP() << "ccx is not installed (Debian: calculix-ccx)";
  constexpr double wanted_faces = 6000;
  const TemporaryFolder folder;
  const CommandResult run = run_command("run '" + scan("camel.off").string() + "' -o '" +
                                        (folder / "camel.inp").string() + "' --faces 6000 --order 2 --json -");
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;

  const auto figures = nlohmann::json::parse(run.standard_output);
  const auto& surface = figures["surface"];
  EXPECT_NEAR(surface["faces"].get<double>(), wanted_faces, 0.01 * wanted_faces);
  EXPECT_LE(surface["edge_ratio"]["mean"].get<double>(), 1.25);
  EXPECT_EQ(surface["self_intersections"].get<int>(), 0);
  EXPECT_LE(std::abs(figures["deviation"]["volume_difference_pct"].get<double>()), 0.1);
  EXPECT_EQ(figures["volume_mesh"]["inverted"].get<int>(), 0);

  // The camel stands on its feet: the lowest hundredth of its height, along y, is clamped.
  const TetMesh mesh = read_volume(folder / "camel.inp");
  EXPECT_NEAR(static_cast<double>(mesh.boundary.size()), wanted_faces, 0.01 * wanted_faces);
  const BoundingBox box = bounding_box(mesh.nodes);
  std::vector<std::uint32_t> clamped;
  for (std::uint32_t n = 0; n < mesh.nodes.size(); ++n)
    if (mesh.nodes[n].y() < box.low.y() + 0.01 * (box.high.y() - box.low.y())) clamped.push_back(n);
  ASSERT_GE(clamped.size(), 3U);

  // The scan has no unit; this material makes a camel of about a metre height out of rubber.
  const calculix::Material material{.young = 1e7, .poisson = 0.3, .density = 1000};
  const Vec3 gravity(0, -9.81, 0);
  const calculix::Solution solution =
      calculix::solve({.mesh = folder / "camel.inp", .clamped = clamped, .material = material, .gravity = gravity});

  const std::vector<double> volumes = calculix::node_volumes(mesh);
  const double volume = std::accumulate(volumes.begin(), volumes.end(), 0.0);
  double clamped_volume = 0;
  for (const std::uint32_t n : clamped) clamped_volume += volumes[n];
  const Vec3 weight = volume * material.density * gravity;
  const Vec3 reaction = solution.clamped_force - clamped_volume * material.density * gravity;
  RecordProperty("relative_error", std::to_string((reaction + weight).norm() / weight.norm()));
  EXPECT_LE((reaction + weight).norm(), 1e-4 * weight.norm());
}

}  // namespace
}  // namespace scan2fea
