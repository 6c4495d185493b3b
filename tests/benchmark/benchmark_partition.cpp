// benchmark_partition MESH PARTS...: a volume mesh in parts, a row of a table for each number of them. Seconds are
// those of `partition`, wall clock. Faces and nodes that several parts have, in per cent of those that there are.
#include "export/formats.hpp"
#include "export/partition.hpp"
#include "preproc/mesh/element_faces.hpp"
#include "preproc/mesh/error.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

namespace {

using namespace scan2fea;

void print_row(const TetMesh& mesh, std::size_t parts) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<std::uint32_t> part = partition(mesh.tetrahedra, parts);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  std::size_t cut = 0, inner = 0;
  const auto across = element_neighbours(mesh.tetrahedra);
  for (std::size_t t = 0; t < across.size(); ++t)
    for (const std::uint32_t other : across[t]) {
      inner += other != no_element;
      cut += other != no_element && part[other] != part[t];
    }
  TetMesh ordered = mesh;
  const std::vector<std::uint32_t> sizes = order_by_parts(ordered, parts);
  const auto [least, most] = std::ranges::minmax(sizes);
  const double mean = static_cast<double>(part.size()) / static_cast<double>(parts);
  const auto shared = static_cast<double>(shared_nodes(mesh.nodes.size(), parts_of(ordered, sizes)));
  std::printf("| %zu | %.2f | %.3f / %.3f | %.2f | %.2f |\n", parts, seconds.count(), least / mean, most / mean,
              100. * static_cast<double>(cut) / static_cast<double>(inner),
              100 * shared / static_cast<double>(mesh.nodes.size()));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: benchmark_partition MESH PARTS...\n");
    return 2;
  }
  try {
    const TetMesh mesh = read_volume(argv[1]);
    std::printf(
        "%zu tetrahedra\n\n| parts | seconds | smallest / largest part over the mean | faces cut, % | nodes shared, % "
        "|\n"
        "|---|---|---|---|---|\n",
        mesh.tetrahedra.size());
    for (int i = 2; i < argc; ++i) print_row(mesh, std::strtoull(argv[i], nullptr, 10));
  } catch (const Error& error) {
    std::fprintf(stderr, "benchmark_partition: %s\n", error.what());
    return error.exit_code();
  }
}
