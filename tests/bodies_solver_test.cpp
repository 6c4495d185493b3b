// The real CalculiX on meshes of bodies that touch: forces go through the faces that they share.
#include "export/inp.hpp"
#include "preproc/bodies_pipeline.hpp"
#include "preproc/mesh/error.hpp"
#include "tests/calculix.hpp"
#include "tests/temporary_folder.hpp"
#include "tests/touching_bodies.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

namespace scan2fea {
namespace {

using analytic::moved;

SurfaceMesh box(const Vec3& size, double edge, const Vec3& at) {
  return moved(analytic::box(size, edge), at);
}

PipelineOptions with_sets(std::initializer_list<const char*> expressions, int order) {
  PipelineOptions options;
  options.order = order;
  for (const char* text : expressions) options.sets.push_back(parse_selection(text, "mm"));
  return options;
}

class BodiesSolver : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (!calculix::available()) GTEST_SKIP() << "ccx is not installed";
  }

  std::string run(const TetMesh& mesh, const std::string& deck) {
    write_inp(mesh, folder_ / "part.inp");
    write_text(folder_ / "deck.inp", "*INCLUDE, INPUT=part.inp\n" + deck);
    const int status = std::system(("cd '" + folder_.path().string() + "' && ccx -i deck > ccx.log 2>&1").c_str());
    EXPECT_EQ(status, 0) << contents(folder_ / "ccx.log");
    return contents(folder_ / "deck.dat");
  }

  TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Order, BodiesSolver, testing::Values(1, 2));

// Rows of whole and floating numbers behind a heading.
std::vector<std::vector<double>> rows_behind(const std::string& printed, const std::string& heading) {
  std::vector<std::vector<double>> rows;
  const std::size_t at = printed.find(heading);
  if (at == std::string::npos) return rows;
  std::istringstream lines(printed.substr(printed.find('\n', at)));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    std::vector<double> row;
    for (double value = 0; fields >> value;) row.push_back(value);
    if (row.empty() && !rows.empty() && line.find_first_not_of(" \t\r") != std::string::npos) break;
    if (!row.empty()) rows.push_back(std::move(row));
  }
  return rows;
}

Vec3 total_force(const std::string& printed) {
  const auto rows = rows_behind(printed, "total force");
  return rows.empty() ? Vec3::Zero() : Vec3(rows[0][0], rows[0][1], rows[0][2]);
}

// A linear displacement at every node: no force is left at nodes inside, those between the bodies among them.
TEST_P(BodiesSolver, PatchTestAcrossAFlatInterfaceIsExact) {
  const std::vector<Body> bodies{{"BASE", box({10, 8, 4}, 2, {0, 0, 0})}, {"TOP", box({5, 4, 6}, 1.3, {3, 2, 4})}};
  const PipelineResult result = run_pipeline_of_bodies(bodies, {}, with_sets({}, GetParam()));
  const TetMesh& mesh = *result.volume_mesh;
  std::ostringstream deck;
  deck << "*MATERIAL, NAME=M\n*ELASTIC\n210000, 0.3\n*SOLID SECTION, ELSET=BASE, MATERIAL=M\n"
          "*SOLID SECTION, ELSET=TOP, MATERIAL=M\n*STEP\n*STATIC\n*BOUNDARY\n";
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const Vec3& p = mesh.nodes[n];
    const Vec3 u(1e-3 * p.x() + 2e-3 * p.y(), -3e-3 * p.z(), 1e-3 * p.x() - 1e-3 * p.y());
    for (int k = 0; k < 3; ++k) {
      char value[32];
      std::snprintf(value, sizeof value, "%.12E", u[k]);
      deck << n + 1 << ", " << k + 1 << ", " << k + 1 << ", " << value << "\n";
    }
  }
  deck << "*NODE PRINT, NSET=NALL\nRF\n*END STEP\n";
  std::vector<bool> on_boundary(mesh.nodes.size(), false), between(mesh.nodes.size(), false);
  std::vector<std::uint32_t> outer(mesh.outer_faces());
  for (std::uint32_t f = 0; f < outer.size(); ++f) outer[f] = f;
  for (const std::uint32_t n : nodes_of_faces(mesh, outer)) on_boundary[n] = true;
  for (const std::uint32_t n : nodes_of_faces(mesh, mesh.face_sets[0].members)) between[n] = !on_boundary[n];
  EXPECT_GT(std::count(between.begin(), between.end(), true), 3);
  double largest = 0, inside = 0;
  const auto rows = rows_behind(run(mesh, deck.str()), "forces");
  ASSERT_EQ(rows.size(), mesh.nodes.size());
  for (const auto& row : rows) {
    const auto node = static_cast<std::size_t>(row[0]) - 1;
    double& most = on_boundary[node] ? largest : inside;
    most = std::max(most, Vec3(row[1], row[2], row[3]).norm());
  }
  EXPECT_GT(largest, 1);
  EXPECT_LE(inside, 1e-10 * largest);
}

// Two blocks in a row under tension, of different stiffness and without lateral contraction: the stress is the same
// everywhere, and each gives way by its own stiffness.
TEST_P(BodiesSolver, TensionGoesThroughTwoMaterials) {
  const std::vector<Body> bodies{{"A", box({4, 3, 2}, 1, {0, 0, 0})}, {"B", box({5, 3, 2}, 0.7, {4, 0, 0})}};
  const PipelineResult result =
      run_pipeline_of_bodies(bodies, {}, with_sets({"fixed=plane(x<0.01)", "pulled=plane(x>8.99)"}, GetParam()));
  const std::string printed =
      run(*result.volume_mesh,
          "*MATERIAL, NAME=HARD\n*ELASTIC\n200000, 0\n*MATERIAL, NAME=SOFT\n*ELASTIC\n50000, 0\n"
          "*SOLID SECTION, ELSET=A, MATERIAL=HARD\n*SOLID SECTION, ELSET=B, MATERIAL=SOFT\n"
          "*STEP\n*STATIC\n*BOUNDARY\nFIXED_NODES, 1, 3\n*DSLOAD\nPULLED, P, -100\n"
          "*NODE PRINT, NSET=FIXED_NODES, TOTALS=ONLY\nRF\n*NODE PRINT, NSET=PULLED_NODES\nU\n"
          "*EL PRINT, ELSET=EALL\nS\n*END STEP\n");
  EXPECT_LE((total_force(printed) - Vec3(-600, 0, 0)).norm(), 1e-3);
  const double expected = 100. * 4 / 200000 + 100. * 5 / 50000;
  const auto displacements = rows_behind(printed, "displacements");
  ASSERT_FALSE(displacements.empty());
  for (const auto& row : displacements) EXPECT_NEAR(row[1], expected, 1e-5 * expected);
  const auto stresses = rows_behind(printed, "stresses");
  ASSERT_GE(stresses.size(), result.volume_mesh->tetrahedra.size());
  for (const auto& row : stresses) {
    EXPECT_NEAR(row[2], 100, 1e-3);
    for (std::size_t k = 3; k < 8; ++k) EXPECT_NEAR(row[k], 0, 1e-3);
  }
}

// The bracket is held at its sides and the pin pushed along the bore: all of the load comes through the bore's wall.
TEST_P(BodiesSolver, ABracketCarriesItsPin) {
  const std::vector<Body> bodies{{"BRACKET", analytic::bored_block({30, 20, 10}, 5, 128, 4)},
                                 {"PIN", moved(analytic::cylinder(5, 24, 120, 8), {0, 0, -7})}};
  const PipelineResult result = run_pipeline_of_bodies(
      bodies, {}, with_sets({"fixed=plane(x<-14.99) or plane(x>14.99)", "pushed=plane(z>16.99)"}, GetParam()));
  const TetMesh& mesh = *result.volume_mesh;
  double area = 0;
  const std::size_t pushed = find_set(mesh.face_sets, "pushed");
  for (const std::uint32_t f : mesh.face_sets[pushed].members) area += face_area(mesh, mesh.boundary[f]);
  const std::string printed =
      run(mesh,
          "*MATERIAL, NAME=M\n*ELASTIC\n210000, 0.3\n*SOLID SECTION, ELSET=BRACKET, MATERIAL=M\n"
          "*SOLID SECTION, ELSET=PIN, MATERIAL=M\n*STEP\n*STATIC\n*BOUNDARY\nFIXED_NODES, 1, 3\n"
          "*DSLOAD\nPUSHED, P, 10\n*NODE PRINT, NSET=FIXED_NODES, TOTALS=ONLY\nRF\n"
          "*NODE PRINT, NSET=PUSHED_NODES\nU\n*NODE PRINT, NSET=INTERFACE_BRACKET_PIN_NODES\nU\n*END STEP\n");
  const Vec3 reaction = total_force(printed);
  EXPECT_NEAR(reaction.z(), 10 * area, 2e-3 * 10 * area);
  EXPECT_LE(std::hypot(reaction.x(), reaction.y()), 1e-3 * 10 * area);
  // The pin's free end is 7 long, and is shortened by p L / E at the least; the plate bends a little.
  for (const auto& row : rows_behind(printed, "displacements")) {
    EXPECT_LT(row[3], -10. * 7 / 210000 * 0.9);
    EXPECT_GT(row[3], -10. * 7 / 210000 * 5);
  }
}

}  // namespace
}  // namespace scan2fea
