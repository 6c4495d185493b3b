#include "tests/calculix.hpp"

#include "tests/temporary_folder.hpp"

#include <cstdlib>
#include <sstream>
#include <stdexcept>

namespace scan2fea::calculix {
namespace {

void write_deck(const Analysis& analysis, const std::filesystem::path& file) {
  std::ofstream deck(file);
  deck.precision(12);
  // What is held: its total reaction is printed.
  deck << "*HEADING\ntest\n*INCLUDE, INPUT=" << analysis.mesh.filename().string() << "\n*NSET, NSET=HELD\n";
  for (const std::uint32_t n : analysis.clamped) deck << n + 1 << "\n";
  for (const AtNode& d : analysis.displacements) deck << d.node + 1 << "\n";
  deck << "*MATERIAL, NAME=M\n*ELASTIC\n"
       << analysis.material.young << ", " << analysis.material.poisson << "\n*DENSITY\n"
       << analysis.material.density << "\n*SOLID SECTION, ELSET=EALL, MATERIAL=M\n*STEP\n*STATIC\n*BOUNDARY\n";
  for (const std::uint32_t n : analysis.clamped) deck << n + 1 << ", 1, 3\n";
  for (const AtNode& d : analysis.displacements)
    for (int k = 0; k < 3; ++k) deck << d.node + 1 << ", " << k + 1 << ", " << k + 1 << ", " << d.value[k] << "\n";
  if (const double magnitude = analysis.gravity.norm(); magnitude > 0) {
    const Vec3 direction = analysis.gravity / magnitude;
    deck << "*DLOAD\nEALL, GRAV, " << magnitude << ", " << direction.x() << ", " << direction.y() << ", "
         << direction.z() << "\n";
  }
  if (!analysis.forces.empty()) deck << "*CLOAD\n";
  for (const AtNode& f : analysis.forces)
    for (int k = 0; k < 3; ++k)
      if (f.value[k] != 0) deck << f.node + 1 << ", " << k + 1 << ", " << f.value[k] << "\n";
  deck << "*NODE PRINT, NSET=NALL\nU\n*NODE PRINT, NSET=HELD, TOTALS=ONLY\nRF\n*END STEP\n";
}

// Blocks of the .dat file: a title that begins with a word, a blank line, rows of numbers.
Solution read_results(const std::filesystem::path& file) {
  std::ifstream stream(file);
  Solution solution;
  bool has_force = false;
  enum class Block { none, displacements, force } block = Block::none;
  for (std::string line; std::getline(stream, line);) {
    if (line.find("displacements") != std::string::npos) block = Block::displacements;
    if (line.find("total force") != std::string::npos) block = Block::force;
    std::istringstream fields(line);
    std::size_t node = 0;
    Vec3 v;
    if (block == Block::displacements && fields >> node >> v[0] >> v[1] >> v[2]) {
      if (solution.displacements.size() < node) solution.displacements.resize(node, Vec3::Zero());
      solution.displacements[node - 1] = v;
    } else if (block == Block::force && fields >> v[0] >> v[1] >> v[2]) {
      solution.clamped_force = v;
      has_force = true;
    }
  }
  if (solution.displacements.empty() || !has_force) throw std::runtime_error("CalculiX printed no results");
  return solution;
}

double determinant_of_columns(const Vec3& a, const Vec3& b, const Vec3& c) {
  return a.dot(b.cross(c));
}

}  // namespace

bool available() {
  return std::system("command -v ccx > /dev/null 2>&1") == 0;
}

Solution solve(const Analysis& analysis) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink(std::filesystem::absolute(analysis.mesh), folder / analysis.mesh.filename().string());
  write_deck(analysis, folder / "deck.inp");
  const std::string command = "cd '" + folder.path().string() + "' && ccx -i deck > ccx.log 2>&1";
  const int status = std::system(command.c_str());
  const std::string log = contents(folder / "ccx.log");
  if (status != 0 || log.find("*ERROR") != std::string::npos || log.find("Job finished") == std::string::npos)
    throw std::runtime_error("CalculiX failed:\n" + log.substr(log.size() > 2000 ? log.size() - 2000 : 0));
  return read_results(folder / "deck.dat");
}

std::vector<double> node_volumes(const TetMesh& mesh) {
  std::vector<double> volumes(mesh.nodes.size(), 0.0);
  // Barycentric coordinates of the points of the rule of degree 2, each of weight 1/24.
  constexpr double a = 0.138196601125010515;
  constexpr double b = 1 - 3 * a;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const Tetrahedron& corners = mesh.tetrahedra[t];
    if (mesh.order() == 1) {
      const Vec3& p = mesh.nodes[corners[0]];
      const double volume =
          determinant_of_columns(mesh.nodes[corners[1]] - p, mesh.nodes[corners[2]] - p, mesh.nodes[corners[3]] - p) /
          6;
      for (const std::uint32_t n : corners) volumes[n] += volume / 4;
      continue;
    }
    for (std::size_t point = 0; point < 4; ++point) {
      std::array<double, 4> l{a, a, a, a};
      l[point] = b;
      // Derivatives by the four barycentric coordinates, of which those by 2, 3, 4 less that by 1 are the map's
      // columns.
      std::array<Vec3, 4> derivative{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
      for (std::size_t i = 0; i < 4; ++i) derivative[i] += (4 * l[i] - 1) * mesh.nodes[corners[i]];
      for (std::size_t e = 0; e < 6; ++e) {
        const auto i = static_cast<std::size_t>(tetrahedron_edges[e][0]);
        const auto j = static_cast<std::size_t>(tetrahedron_edges[e][1]);
        const Vec3& p = mesh.nodes[mesh.mid_edge_nodes[t][e]];
        derivative[i] += 4 * l[j] * p;
        derivative[j] += 4 * l[i] * p;
      }
      const double weight = determinant_of_columns(derivative[1] - derivative[0], derivative[2] - derivative[0],
                                                   derivative[3] - derivative[0]) /
                            24;
      for (std::size_t i = 0; i < 4; ++i) volumes[corners[i]] += weight * l[i] * (2 * l[i] - 1);
      for (std::size_t e = 0; e < 6; ++e)
        volumes[mesh.mid_edge_nodes[t][e]] += weight * 4 * l[static_cast<std::size_t>(tetrahedron_edges[e][0])] *
                                              l[static_cast<std::size_t>(tetrahedron_edges[e][1])];
    }
  }
  return volumes;
}

}  // namespace scan2fea::calculix
