// subdivide IN OUT LEVELS [NOISE]: Loop's subdivision of a closed surface, four times the triangles a level, to have
// large scans of a real shape for tests/benchmark/scale_table; NOISE: of each coordinate, a normal deviate in per cent
// of the diagonal.
#include "preproc/mesh/read_surface.hpp"
#include "preproc/mesh/write_surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <numbers>
#include <random>
#include <vector>

namespace {

using namespace scan2fea;

struct HalfEdge {
  std::uint64_t key;     // its two vertices, the smaller one in the upper half
  std::uint32_t corner;  // 3 f + k, from the k-th vertex of f to the next
};

SurfaceMesh subdivided(const SurfaceMesh& mesh) {
  std::vector<HalfEdge> halves;
  halves.reserve(3 * mesh.triangles.size());
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(mesh.triangles[f][k], mesh.triangles[f][(k + 1) % 3]);
      halves.push_back({(std::uint64_t{low} << 32) | high, 3 * f + k});
    }
  std::sort(halves.begin(), halves.end(),
            [](const HalfEdge& a, const HalfEdge& b) { return a.key != b.key ? a.key < b.key : a.corner < b.corner; });

  const std::size_t n = mesh.vertices.size();
  SurfaceMesh fine;
  fine.vertices.resize(n);
  std::vector<Vec3> sum(n, Vec3::Zero());
  std::vector<double> valence(n, 0);
  std::vector<std::uint32_t> middle(3 * mesh.triangles.size());
  for (std::size_t i = 0; i < halves.size(); i += 2) {
    if (i + 1 == halves.size() || halves[i + 1].key != halves[i].key) throw std::runtime_error("not a closed surface");
    const auto a = static_cast<std::uint32_t>(halves[i].key >> 32), b = static_cast<std::uint32_t>(halves[i].key);
    Vec3 apexes = Vec3::Zero();
    for (std::size_t side = 0; side < 2; ++side) {
      const std::uint32_t corner = halves[i + side].corner;
      apexes += mesh.vertices[mesh.triangles[corner / 3][(corner + 2) % 3]];
      middle[corner] = static_cast<std::uint32_t>(fine.vertices.size());
    }
    fine.vertices.push_back(0.375 * (mesh.vertices[a] + mesh.vertices[b]) + 0.125 * apexes);
    sum[a] += mesh.vertices[b];
    sum[b] += mesh.vertices[a];
    ++valence[a];
    ++valence[b];
  }
  for (std::size_t v = 0; v < n; ++v) {
    const double c = 0.375 + 0.25 * std::cos(2 * std::numbers::pi / std::max(1.0, valence[v]));
    const double beta = (0.625 - c * c) / std::max(1.0, valence[v]);
    fine.vertices[v] = (1 - valence[v] * beta) * mesh.vertices[v] + beta * sum[v];
  }
  fine.triangles.reserve(4 * mesh.triangles.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    const std::uint32_t ab = middle[3 * f], bc = middle[3 * f + 1], ca = middle[3 * f + 2];
    fine.triangles.insert(fine.triangles.end(), {Triangle{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
  }
  return fine;
}

void add_noise(SurfaceMesh& mesh, double percent) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, percent / 100 * bounding_box(mesh.vertices).diagonal());
  for (Vec3& p : mesh.vertices)
    for (double& coordinate : p) coordinate += noise(random);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4 && argc != 5) {
    std::fprintf(stderr, "subdivide IN OUT LEVELS [NOISE]\n");
    return 2;
  }
  try {
    SurfaceMesh mesh = read_surface(argv[1]);
    for (int level = std::atoi(argv[3]); level > 0; --level) mesh = subdivided(mesh);
    if (argc == 5 && std::atof(argv[4]) > 0) add_noise(mesh, std::atof(argv[4]));
    write_surface(mesh, argv[2]);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "subdivide: %s\n", e.what());
    return 1;
  }
}
