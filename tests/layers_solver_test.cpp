// The real CalculiX on a pipe with layers behind its bore, under pressure: Lame's stresses.
#include "export/inp.hpp"
#include "preproc/pipeline.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/calculix.hpp"
#include "tests/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

namespace scan2fea {
namespace {

constexpr double inner = 8, outer = 12, length = 12, pressure = 10;

PipelineResult pipe_with_layers(int order) {
  PipelineOptions options;
  options.simplify->size = FaceCount{1200};
  options.sets = {parse_selection("bore=cylinder(r=8+-0.3)", ""), parse_selection("low=plane(z<0.1)", ""),
                  parse_selection("high=plane(z>11.9)", "")};
  options.layers = {{.set = "bore", .heights = {.count = 5, .first = 0.15, .growth = 1.3}}};
  options.order = order;
  return run_pipeline(analytic::pipe(inner, outer, length, 96), options);
}

class LayersSolver : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Order, LayersSolver, testing::Values(1, 2));

// Both ends are held along the axis, so that the strain is plane; one node sideways, and another one against turning.
TEST_P(LayersSolver, FindsTheStressesOfAThickPipe) {
  if (!calculix::available()) GTEST_SKIP() << "ccx is not installed (Debian: calculix-ccx)";
  const PipelineResult result = pipe_with_layers(GetParam());
  const TetMesh& mesh = *result.volume_mesh;
  const TemporaryFolder folder;
  write_inp(mesh, folder / "part.inp");
  std::uint32_t right = 0, left = 0;
  for (std::uint32_t v = 0; v < mesh.nodes.size(); ++v) {
    if (mesh.nodes[v].x() > mesh.nodes[right].x()) right = v;
    if (mesh.nodes[v].x() < mesh.nodes[left].x()) left = v;
  }
  std::ostringstream deck;
  deck << "*INCLUDE, INPUT=part.inp\n*MATERIAL, NAME=M\n*ELASTIC\n210000, 0.3\n"
       << "*SOLID SECTION, ELSET=EALL, MATERIAL=M\n*STEP\n*STATIC\n*BOUNDARY\nLOW_NODES, 3, 3\nHIGH_NODES, 3, 3\n"
       << right + 1 << ", 1, 2\n"
       << left + 1 << ", 2, 2\n*DSLOAD\nBORE, P, " << pressure << "\n*EL PRINT, ELSET=EALL\nS\n*END STEP\n";
  write_text(folder / "deck.inp", deck.str());
  ASSERT_EQ(std::system(("cd '" + folder.path().string() + "' && ccx -i deck > ccx.log 2>&1").c_str()), 0)
      << contents(folder / "ccx.log");

  // Of each element the mean over its points of integration, which is the stress in its middle, or nearly so.
  std::map<std::size_t, std::pair<Eigen::Matrix3d, int>> stress;
  std::istringstream lines(contents(folder / "deck.dat"));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    std::size_t element = 0;
    int point = 0;
    std::array<double, 6> s{};
    if (!(fields >> element >> point >> s[0] >> s[1] >> s[2] >> s[3] >> s[4] >> s[5])) continue;
    auto& [sum, count] = stress.try_emplace(element, Eigen::Matrix3d::Zero(), 0).first->second;
    Eigen::Matrix3d tensor;
    tensor << s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2];
    sum += tensor;
    ++count;
  }
  ASSERT_EQ(stress.size(), mesh.tetrahedra.size());
  double squared = 0, hoop_squared = 0, count = 0;
  const double scale = pressure * inner * inner / (outer * outer - inner * inner);
  const auto layers = std::ranges::find(result.stages, "layers", &StageRecord::name);
  const double in_layers = layers->changes[2].second;
  ASSERT_EQ(layers->changes[2].first, "layer_tetrahedra");
  for (const auto& [element, of_points] : stress) {
    if (static_cast<double>(element) > in_layers) continue;
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t v : mesh.tetrahedra[element - 1]) middle += mesh.nodes[v] / 4;
    const double radius = middle.head<2>().norm();
    const Vec3 around = Vec3(-middle.y(), middle.x(), 0) / radius;
    const double hoop = around.dot(of_points.first / of_points.second * around);
    const double theory = scale * (1 + outer * outer / (radius * radius));
    squared += (hoop - theory) * (hoop - theory);
    hoop_squared += theory * theory;
    ++count;
  }
  EXPECT_EQ(count, in_layers);
  EXPECT_LT(std::sqrt(squared / hoop_squared), GetParam() == 1 ? 0.07 : 0.01);
}

}  // namespace
}  // namespace scan2fea
