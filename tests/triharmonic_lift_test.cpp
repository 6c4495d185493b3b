#include "preproc/surface/enrichment/triharmonic_lift.hpp"

#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace scan2fea {
namespace {

// A bent sheet of which each third vertex in both directions was measured, the others flattened between them.
struct Patch {
  explicit Patch(double (*height)(double, double)) : mesh(analytic::sheet(12, 12, 1)), height_of(height) {
    for (Vec3& p : mesh.points) p[2] = height(p[0], p[1]);
    free.assign(mesh.points.size(), false);
    measured.assign(mesh.points.size(), false);
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      const Vec3& p = mesh.points[v];
      const bool kept = std::lround(p[0]) % 3 == 0 && std::lround(p[1]) % 3 == 0;
      if (mesh.is_border_vertex(static_cast<std::uint32_t>(v))) continue;
      (kept ? measured : free)[v] = true;
      if (!kept) mesh.points[v][2] += 0.2;
    }
  }

  double rms() const {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      if (!free[v] && !measured[v]) continue;
      sum += std::pow(mesh.points[v][2] - height_of(mesh.points[v][0], mesh.points[v][1]), 2);
      ++count;
    }
    return std::sqrt(sum / static_cast<double>(count));
  }

  HalfedgeMesh mesh;
  double (*height_of)(double, double);
  std::vector<bool> free, measured;
};

TEST(TriharmonicLift, FindsASmoothSurfaceThroughItsPoints) {
  for (const auto height : {+[](double x, double y) { return 0.02 * x * x - 0.01 * x * y + 0.03 * y; },
                            +[](double x, double y) { return std::sin(0.5 * x) * std::cos(0.4 * y); }}) {
    Patch patch(height);
    const std::vector<Vec3> before = patch.mesh.points;
    const double flat = patch.rms();
    triharmonic_lift(patch.mesh, patch.free, patch.measured, {});
    EXPECT_LT(patch.rms(), 0.35 * flat);
    for (std::size_t v = 0; v < before.size(); ++v)
      if (!patch.free[v]) {
        EXPECT_EQ(patch.mesh.points[v], before[v]);
      }
  }
}

TEST(TriharmonicLift, HoldsNoisyPointsSoftly) {
  Patch patch(+[](double, double) { return 0.0; });
  for (std::size_t v = 0; v < patch.mesh.points.size(); ++v)
    if (patch.measured[v]) patch.mesh.points[v][2] = v % 2 == 0 ? 0.1 : -0.1;
  triharmonic_lift(patch.mesh, patch.free, patch.measured, {.hold = 0.1, .solves = 2, .creases = {}});
  EXPECT_LT(patch.rms(), 0.06);
}

TEST(TriharmonicLift, CreasesStayAndPartTheSides) {
  // A roof.
  Patch patch(+[](double x, double) { return 0.5 * (6 - std::abs(x - 6)); });
  std::vector<bool> creases(patch.mesh.points.size(), false);
  for (std::size_t v = 0; v < creases.size(); ++v) {
    if (std::abs(patch.mesh.points[v][0] - 6) > 1e-9) continue;
    creases[v] = true;
    patch.mesh.points[v][2] = 3;
  }
  triharmonic_lift(patch.mesh, patch.free, patch.measured, {.hold = 0, .solves = 2, .creases = creases});
  EXPECT_LT(patch.rms(), 0.02);
}

TEST(TriharmonicLift, WithNothingFreeDoesNothing) {
  Patch patch(+[](double, double) { return 0.0; });
  const std::vector<Vec3> before = patch.mesh.points;
  triharmonic_lift(patch.mesh, std::vector<bool>(before.size(), false), patch.measured, {});
  for (std::size_t v = 0; v < before.size(); ++v) EXPECT_EQ(patch.mesh.points[v], before[v]);
}

}  // namespace
}  // namespace scan2fea
