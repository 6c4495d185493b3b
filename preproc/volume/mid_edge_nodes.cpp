#include "preproc/volume/mid_edge_nodes.hpp"

#include <algorithm>
#include <tuple>

namespace scan2fea {
namespace {

struct Edge {
  std::uint32_t low, high;  // corner nodes
  std::uint32_t tetrahedron, local;

  bool same_ends(const Edge& other) const { return low == other.low && high == other.high; }
};

}  // namespace

void add_mid_edge_nodes(TetMesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(mesh.tetrahedra.size() * 6);
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t)
    for (std::uint32_t e = 0; e < 6; ++e) {
      const auto [a, b] = tetrahedron_edges[e];
      const std::uint32_t i = mesh.tetrahedra[t][static_cast<std::size_t>(a)];
      const std::uint32_t j = mesh.tetrahedra[t][static_cast<std::size_t>(b)];
      edges.push_back({std::min(i, j), std::max(i, j), t, e});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.tetrahedron) < std::tie(b.low, b.high, b.tetrahedron);
  });
  mesh.mid_edge_nodes.resize(mesh.tetrahedra.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i == 0 || !edges[i].same_ends(edges[i - 1]))
      mesh.nodes.push_back((mesh.nodes[edges[i].low] + mesh.nodes[edges[i].high]) / 2);
    mesh.mid_edge_nodes[edges[i].tetrahedron][edges[i].local] = static_cast<std::uint32_t>(mesh.nodes.size() - 1);
  }
}

}  // namespace scan2fea
