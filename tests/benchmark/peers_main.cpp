// benchmark_peers PEER INPUT OUTPUT FACES EDGE_LENGTH: one tool of the field as a whole process: read, work, write.
#include "tests/benchmark/peers.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <map>

int main(int argc, char** argv) {
  using namespace scan2fea::benchmark;
  const std::map<std::string, std::function<void(const PeerJob&)>> peers{
      {"cgal-isotropic", cgal_isotropic_remeshing}, {"cgal-features", cgal_feature_remeshing},
      {"cgal-quadric", cgal_garland_heckbert},      {"cgal-lindstrom-turk", cgal_lindstrom_turk},
      {"openmesh-quadric", openmesh_quadric},       {"openmesh-progressive", openmesh_progressive},
      {"meshoptimizer", meshoptimizer_simplify}};
  if (argc != 6 || peers.count(argv[1]) == 0) {
    std::fprintf(stderr, "usage: benchmark_peers PEER INPUT OUTPUT FACES EDGE_LENGTH; PEER is one of:");
    for (const auto& peer : peers) std::fprintf(stderr, " %s", peer.first.c_str());
    std::fprintf(stderr, "\n");
    return 2;
  }
  try {
    peers.at(argv[1])({argv[2], argv[3], std::strtoul(argv[4], nullptr, 10), std::strtod(argv[5], nullptr)});
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: %s\n", argv[1], e.what());
    return 1;
  }
  return 0;
}
