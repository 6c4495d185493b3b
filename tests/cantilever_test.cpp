// The whole chain against beam theory: a noisy scan of a known box goes through the command, the mesh through
// CalculiX, and the tip sinks as Timoshenko says.
//
// The supports are chosen so that beam theory is the truth, and the tolerance is left to the mesh:
// - Poisson's ratio is 0. A clamped end holds the section's shape as well as its place; with a Poisson's ratio of 0.3
//   that alone stiffens a box of these proportions by nearly 2 %, which theory knows nothing of. With 0, a structured
//   mesh of the exact box agrees with Timoshenko to 0.02 %.
// - The load is the box's own weight, which needs no surface to act on and is right if the volume is.
// - Length over height is 5, where shear is 3.2 % of the deflection: bending alone would fail the test.
// The deflection goes with the inverse square of the height (weight h, stiffness h^3), so 2 % of it is 1 % of the
// height, 0.2 mm, or half a per cent of the length: a mesh that shrinks, rounds the ends away or swells does not pass.
#include "export/formats.hpp"
#include "export/inp.hpp"
#include "preproc/mesh/write_surface.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/calculix.hpp"
#include "tests/run_command.hpp"
#include "tests/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

const Vec3 size(100, 24, 20);
constexpr calculix::Material material{.young = 210000, .poisson = 0, .density = 7.85e-9};  // mm, N, t
constexpr double gravity = 9810;

// Points every 0.5 to 1.5 mm, as a scanner's lines swell and shrink along its way, and noise of 0.03 % of the diagonal.
SurfaceMesh noisy_scan() {
  SurfaceMesh scan = analytic::box(size, 1.0);
  for (Vec3& p : scan.vertices)
    for (int k = 0; k < 3; ++k) {
      const double wave_length = size[k] / std::round(size[k] / 10);  // fits the side, whose ends stay where they are
      p[k] += 0.5 * wave_length / (2 * std::numbers::pi) * std::sin(2 * std::numbers::pi * p[k] / wave_length);
    }
  return analytic::noisy(std::move(scan), 3e-4 * size.norm(), 1);
}

double timoshenko_tip() {
  const double area = size.y() * size.z();
  const double load = material.density * gravity * area;  // by length
  const double inertia = size.y() * std::pow(size.z(), 3) / 12;
  const double shear_modulus = material.young / 2 / (1 + material.poisson);
  const double k = 10 * (1 + material.poisson) / (12 + 11 * material.poisson);  // Cowper, rectangle
  return load * std::pow(size.x(), 4) / (8 * material.young * inertia) +
         load * std::pow(size.x(), 2) / (2 * k * shear_modulus * area);
}

TEST(Cantilever, OfANoisyScanBendsAsTimoshenkoSays) {
  if (!calculix::available()) GTEST_SKIP() << "ccx is not installed (Debian: calculix-ccx)";
  const TemporaryFolder folder;
  write_surface(noisy_scan(), folder / "scan.ply");
  const CommandResult run = run_command("run '" + (folder / "scan.ply").string() + "' -o '" +
                                        (folder / "beam.inp").string() + "' --edge-length 2 --order 2 --unit mm");
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;

  const TetMesh mesh = read_volume(folder / "beam.inp");
  EXPECT_EQ(mesh.order(), 2);
  // The end faces are where the nodes are: noise and rounded edges keep them within a fraction of the mesh's edges.
  constexpr double at_the_end = 0.4;
  std::vector<std::uint32_t> clamped, tip;
  for (std::uint32_t n = 0; n < mesh.nodes.size(); ++n) {
    if (mesh.nodes[n].x() < at_the_end) clamped.push_back(n);
    if (mesh.nodes[n].x() > size.x() - at_the_end) tip.push_back(n);
  }
  ASSERT_GT(clamped.size(), 100U);
  ASSERT_GT(tip.size(), 100U);

  const calculix::Solution solution = calculix::solve(
      {.mesh = folder / "beam.inp", .clamped = clamped, .material = material, .gravity = Vec3(0, 0, -gravity)});
  double sunk = 0;
  for (const std::uint32_t n : tip) sunk -= solution.displacements[n].z() / static_cast<double>(tip.size());
  const double theory = timoshenko_tip();
  RecordProperty("per_cent_off_theory", std::to_string(100 * (sunk / theory - 1)));
  EXPECT_NEAR(sunk, theory, 0.02 * theory) << "per cent off: " << 100 * (sunk / theory - 1);
}

}  // namespace
}  // namespace scan2fea
