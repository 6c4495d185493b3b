// Our tetrahedra against an exact solution: the error falls as the textbook says when edges halve.
//
// A cantilever of Poisson's ratio 0 under a shear force at its tip, spread over the end as a parabola, has a solution
// in polynomials of degree 3 that is exact in three dimensions (Timoshenko and Goodier, Theory of Elasticity, art. 21),
// with beam theory's deflection P L^3 / 3 E I plus shear. Displacements at the root are the exact ones, so nothing is
// singular, and the error of the displacements is of the elements' order plus one: 2 for linear, 3 for quadratic ones.
#include "export/inp.hpp"
#include "preproc/volume/mid_edge_nodes.hpp"
#include "preproc/volume/tetrahedralize.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/calculix.hpp"
#include "tests/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace scan2fea {
namespace {

const Vec3 size(4, 1, 1);
constexpr double young = 1000, force = 1;
constexpr double half = 0.5, inertia = 2 * half * half * half / 3;  // per unit of width

Vec3 exact(const Vec3& p) {
  const double x = p.x(), z = p.z() - half, length = size.x(), scale = force / (young * inertia);
  return scale *
         Vec3(z * (length * x - x * x / 2) + z * z * z / 3, 0, -(length * x * x / 2 - x * x * x / 6 + half * half * x));
}

// On the end face, downwards; its integral is the force.
double shear_traction(const Vec3& p) {
  const double z = p.z() - half;
  return -force / (2 * inertia) * (half * half - z * z);
}

// The traction's share of each node of the end face, by Dunavant's rule of degree 4, which is exact for it.
std::vector<calculix::AtNode> end_forces(const TetMesh& mesh) {
  constexpr std::array<std::array<double, 2>, 2> rule{
      {{0.445948490915965, 0.223381589678011}, {0.091576213509771, 0.109951743655322}}};
  std::vector<double> share(mesh.nodes.size(), 0);
  for (const BoundaryFace f : mesh.boundary) {
    const Triangle t = boundary_triangle(mesh, f);
    const std::array<Vec3, 3> p{mesh.nodes[t[0]], mesh.nodes[t[1]], mesh.nodes[t[2]]};
    if (p[0].x() < size.x() || p[1].x() < size.x() || p[2].x() < size.x()) continue;
    const double area = (p[1] - p[0]).cross(p[2] - p[0]).norm() / 2;
    // The node between each two corners.
    std::array<std::uint32_t, 3> middle{};
    for (std::size_t e = 0; mesh.order() == 2 && e < 6; ++e)
      for (std::size_t k = 0; k < 3; ++k) {
        const Tetrahedron& corners = mesh.tetrahedra[f.tetrahedron];
        const auto a = corners[static_cast<std::size_t>(tetrahedron_edges[e][0])];
        const auto b = corners[static_cast<std::size_t>(tetrahedron_edges[e][1])];
        if (std::minmax(a, b) == std::minmax(t[k], t[(k + 1) % 3])) middle[k] = mesh.mid_edge_nodes[f.tetrahedron][e];
      }
    for (const auto& [a, weight] : rule)
      for (std::size_t at = 0; at < 3; ++at) {
        std::array<double, 3> l{a, a, a};
        l[at] = 1 - 2 * a;
        const double load = weight * area * shear_traction(l[0] * p[0] + l[1] * p[1] + l[2] * p[2]);
        for (std::size_t k = 0; k < 3; ++k) {
          if (mesh.order() == 1) {
            share[t[k]] += load * l[k];
          } else {
            share[t[k]] += load * l[k] * (2 * l[k] - 1);
            share[middle[k]] += load * 4 * l[k] * l[(k + 1) % 3];
          }
        }
      }
  }
  std::vector<calculix::AtNode> forces;
  for (std::uint32_t n = 0; n < share.size(); ++n)
    if (share[n] != 0) forces.push_back({n, Vec3(0, 0, share[n])});
  return forces;
}

struct Outcome {
  double error;  // of the nodes' displacements, root mean square
  double tip;    // deflection over the exact one
};

Outcome solve_beam(double edge_length, int order) {
  TetMesh mesh = tetrahedralize(analytic::box(size, edge_length)).mesh;
  if (order == 2) add_mid_edge_nodes(mesh);
  const TemporaryFolder folder;
  write_inp(mesh, folder / "beam.inp");
  calculix::Analysis analysis{.mesh = folder / "beam.inp",
                              .clamped = {},
                              .material = {.young = young, .poisson = 0, .density = 1},
                              .gravity = Vec3::Zero(),
                              .displacements = {},
                              .forces = end_forces(mesh)};
  for (std::uint32_t n = 0; n < mesh.nodes.size(); ++n)
    if (mesh.nodes[n].x() == 0) analysis.displacements.push_back({n, exact(mesh.nodes[n])});
  const calculix::Solution solution = calculix::solve(analysis);
  double sum = 0, tip = 0, tip_exact = 0;
  for (std::uint32_t n = 0; n < mesh.nodes.size(); ++n) {
    sum += (solution.displacements[n] - exact(mesh.nodes[n])).squaredNorm();
    if (mesh.nodes[n].x() == size.x()) {
      tip += solution.displacements[n].z();
      tip_exact += exact(mesh.nodes[n]).z();
    }
  }
  return {std::sqrt(sum / static_cast<double>(mesh.nodes.size())), tip / tip_exact};
}

TEST(Convergence, SecondOrderElementsReachBeamTheoryAtThirdOrder) {
  if (!calculix::available()) GTEST_SKIP() << "ccx is not installed (Debian: calculix-ccx)";
  const Outcome coarse = solve_beam(0.25, 2), fine = solve_beam(0.125, 2);
  EXPECT_GE(std::log2(coarse.error / fine.error), 2.6) << coarse.error << ' ' << fine.error;
  EXPECT_NEAR(fine.tip, 1, 1e-4);
}

TEST(Convergence, FirstOrderElementsReachItAtSecondOrder) {
  if (!calculix::available()) GTEST_SKIP() << "ccx is not installed (Debian: calculix-ccx)";
  const Outcome coarse = solve_beam(0.25, 1), fine = solve_beam(0.125, 1);
  EXPECT_GE(std::log2(coarse.error / fine.error), 1.6) << coarse.error << ' ' << fine.error;
  EXPECT_NEAR(fine.tip, 1, 0.08);
}

}  // namespace
}  // namespace scan2fea
