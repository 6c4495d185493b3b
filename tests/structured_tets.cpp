#include "tests/structured_tets.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace scan2fea::analytic {
namespace {

using Cell = std::array<int, 3>;

void add_mid_edge_nodes(TetMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
  for (const Tetrahedron& corners : mesh.tetrahedra) {
    MidEdgeNodes nodes{};
    for (std::size_t e = 0; e < nodes.size(); ++e) {
      const auto a = corners[static_cast<std::size_t>(tetrahedron_edges[e][0])];
      const auto b = corners[static_cast<std::size_t>(tetrahedron_edges[e][1])];
      const auto [it, added] = middle.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.nodes.size()));
      if (added) mesh.nodes.push_back(0.5 * (mesh.nodes[a] + mesh.nodes[b]));
      nodes[e] = it->second;
    }
    mesh.mid_edge_nodes.push_back(nodes);
  }
}

}  // namespace

TetMesh tetrahedra_of_box(const Vec3& size, const std::array<int, 3>& cells, int order) {
  TetMesh mesh;
  std::map<Cell, std::uint32_t> index;
  for (const bool boundary : {true, false})
    for (int x = 0; x <= cells[0]; ++x)
      for (int y = 0; y <= cells[1]; ++y)
        for (int z = 0; z <= cells[2]; ++z) {
          const bool inside = x > 0 && x < cells[0] && y > 0 && y < cells[1] && z > 0 && z < cells[2];
          if (inside == boundary) continue;
          index[{x, y, z}] = static_cast<std::uint32_t>(mesh.nodes.size());
          mesh.nodes.emplace_back(size.x() * x / cells[0], size.y() * y / cells[1], size.z() * z / cells[2]);
        }

  for (int x = 0; x < cells[0]; ++x)
    for (int y = 0; y < cells[1]; ++y)
      for (int z = 0; z < cells[2]; ++z) {
        std::array<std::size_t, 3> axes{0, 1, 2};
        do {  // one tetrahedron for each way along the cube's edges from one end of the diagonal to the other
          Cell corner{x, y, z};
          Tetrahedron t{index.at(corner), 0, 0, 0};
          for (std::size_t k = 0; k < 3; ++k) {
            ++corner[axes[k]];
            t[k + 1] = index.at(corner);
          }
          const bool even = (axes[1] + 3 - axes[0]) % 3 == 1;
          if (!even) std::swap(t[1], t[2]);
          // Even permutations in turn, so that the box's faces are of all four face numbers.
          const std::array<Tetrahedron, 4> turned{
              {t, {t[1], t[0], t[3], t[2]}, {t[2], t[3], t[0], t[1]}, {t[3], t[2], t[1], t[0]}}};
          mesh.tetrahedra.push_back(turned[mesh.tetrahedra.size() % turned.size()]);
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
  mesh.boundary = find_boundary(mesh.tetrahedra);
  if (order == 2) add_mid_edge_nodes(mesh);
  return mesh;
}

}  // namespace scan2fea::analytic
