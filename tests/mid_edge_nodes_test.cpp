#include "preproc/volume/mid_edge_nodes.hpp"

#include "preproc/volume/tetrahedralize.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <set>

namespace scan2fea {
namespace {

TEST(MidEdgeNodes, OneNodePerEdgeInTheMiddleOfIt) {
  const TetMesh corners = tetrahedralize(analytic::box({2, 1, 1}, 0.5)).mesh;
  TetMesh mesh = corners;
  add_mid_edge_nodes(mesh);
  ASSERT_EQ(mesh.order(), 2);
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    for (std::size_t e = 0; e < 6; ++e) {
      const auto a = mesh.tetrahedra[t][static_cast<std::size_t>(tetrahedron_edges[e][0])];
      const auto b = mesh.tetrahedra[t][static_cast<std::size_t>(tetrahedron_edges[e][1])];
      edges.insert(std::minmax(a, b));
      EXPECT_EQ(mesh.nodes[mesh.mid_edge_nodes[t][e]], (mesh.nodes[a] + mesh.nodes[b]) / 2);
    }
  EXPECT_EQ(mesh.nodes.size(), corners.nodes.size() + edges.size());
  EXPECT_EQ(mesh.tetrahedra, corners.tetrahedra);
}

}  // namespace
}  // namespace scan2fea
