#include "preproc/surface/simplification/error_sizing.hpp"

#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

namespace scan2fea {
namespace {

// A sphere meshed finely above the equator and coarsely below: the error is below.
TEST(ErrorFactors, AskForShorterEdgesWhereTheMeshIsFarFromTheScan) {
  const SurfaceMesh fine = analytic::sphere(1, 5);
  const ReferenceSurface scan(fine);
  SurfaceMesh mesh = analytic::sphere(1, 3);
  for (Vec3& p : mesh.vertices) {
    if (p.z() < -0.5) p *= 0.97;
  }
  const std::vector<double> factors = error_factors(mesh, scan, 0.5);
  for (std::size_t v = 0; v < factors.size(); ++v) {
    const double z = fine.vertices[v].z();
    if (z < -0.8) {
      EXPECT_LT(factors[v], 1);
    } else if (z > 0.5) {
      EXPECT_GT(factors[v], 1);
    }
  }
}

}  // namespace
}  // namespace scan2fea
