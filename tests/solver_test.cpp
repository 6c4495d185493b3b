// The real CalculiX reads what write_inp writes, and balances the weight of it.
#include "export/formats.hpp"
#include "export/inp.hpp"
#include "export/smallest_determinant.hpp"
#include "tests/calculix.hpp"
#include "tests/structured_tets.hpp"
#include "tests/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace scan2fea {
namespace {

constexpr calculix::Material steel{.young = 210000, .poisson = 0.3, .density = 7.85e-9};  // mm, N, t
const Vec3 gravity(0, 0, -9810);

class Solver : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (!calculix::available()) GTEST_SKIP() << "ccx is not installed (Debian: calculix-ccx)";
  }
  TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Order, Solver, testing::Values(1, 2));

std::vector<std::uint32_t> nodes_at_the_left_end(const TetMesh& mesh) {
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t n = 0; n < mesh.nodes.size(); ++n)
    if (mesh.nodes[n].x() == 0) nodes.push_back(n);
  return nodes;
}

TEST_P(Solver, ReactionsAndOwnShareOfTheClampedNodesAreTheWeight) {
  const TetMesh mesh = analytic::tetrahedra_of_box({40, 10, 10}, {8, 2, 2}, GetParam());
  write_inp(mesh, folder_ / "beam.inp");
  const std::vector<std::uint32_t> clamped = nodes_at_the_left_end(mesh);
  const calculix::Solution solution =
      calculix::solve({.mesh = folder_ / "beam.inp", .clamped = clamped, .material = steel, .gravity = gravity});

  const std::vector<double> volumes = calculix::node_volumes(mesh);
  EXPECT_NEAR(std::accumulate(volumes.begin(), volumes.end(), 0.0), 4000, 1e-9);
  double clamped_volume = 0;
  for (const std::uint32_t n : clamped) clamped_volume += volumes[n];
  const Vec3 weight = 4000 * steel.density * gravity;
  const Vec3 reaction = solution.clamped_force - clamped_volume * steel.density * gravity;
  EXPECT_LE((reaction + weight).norm(), 1e-4 * weight.norm());
}

TEST_P(Solver, ABeamBendsAsTimoshenkoSays) {
  const Vec3 size(80, 10, 10);
  const TetMesh mesh = analytic::tetrahedra_of_box(size, {16, 2, 2}, GetParam());
  write_inp(mesh, folder_ / "beam.inp");
  const calculix::Solution solution = calculix::solve(
      {.mesh = folder_ / "beam.inp", .clamped = nodes_at_the_left_end(mesh), .material = steel, .gravity = gravity});
  ASSERT_EQ(solution.displacements.size(), mesh.nodes.size());
  double tip = 0;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    if (mesh.nodes[n] == Vec3(80, 5, 5)) tip = -solution.displacements[n].z();
  // q L^4 / 8 E I + q L^2 / 2 k G A, with the shear coefficient k = 10 (1 + nu) / (12 + 11 nu) of a rectangle.
  const double area = size.y() * size.z();
  const double load = steel.density * gravity.norm() * area;
  const double inertia = size.y() * std::pow(size.z(), 3) / 12;
  const double shear_modulus = steel.young / 2 / (1 + steel.poisson);
  const double k = 10 * (1 + steel.poisson) / (12 + 11 * steel.poisson);
  const double theory = load * std::pow(size.x(), 4) / (8 * steel.young * inertia) +
                        load * std::pow(size.x(), 2) / (2 * k * shear_modulus * area);
  if (GetParam() == 2) {
    EXPECT_NEAR(tip, theory, 0.02 * theory);
  } else {  // linear tetrahedra are much too stiff in bending
    EXPECT_GT(tip, 0.1 * theory);
    EXPECT_LT(tip, 0.9 * theory);
  }
}

TEST_P(Solver, RefusesTheElementsThatTheWriterWarnsOf) {
  for (const double determinant : {0.9e-20, 1.1e-20}) {
    // A cube of side s makes tetrahedra of determinant s^3.
    const double side = std::cbrt(determinant);
    const TetMesh mesh = analytic::tetrahedra_of_box({4 * side, side, side}, {4, 1, 1}, GetParam());
    const auto warnings = write_volume(mesh, folder_ / "small.inp");
    const calculix::Analysis analysis{
        .mesh = folder_ / "small.inp", .clamped = nodes_at_the_left_end(mesh), .material = steel, .gravity = gravity};
    if (determinant < calculix_smallest_determinant) {
      EXPECT_EQ(warnings.size(), 1U);
      EXPECT_THROW(calculix::solve(analysis), std::runtime_error);
    } else {
      EXPECT_TRUE(warnings.empty()) << warnings.front();
      EXPECT_NO_THROW(calculix::solve(analysis));
    }
  }
}

}  // namespace
}  // namespace scan2fea
