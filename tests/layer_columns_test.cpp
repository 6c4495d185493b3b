// Where layers grow to, and the wedges between their columns.
#include "preproc/layers/layer_columns.hpp"

#include "preproc/layers/layer_directions.hpp"
#include "preproc/mesh/element_faces.hpp"
#include "preproc/mesh/numbers.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace scan2fea {
namespace {

LayerDirections directions_of(const SurfaceMesh& surface, const std::function<bool(const Vec3& normal)>& is_layered) {
  const VertexStars stars(surface);
  std::vector<bool> layered;
  for (const Triangle& t : surface.triangles) layered.push_back(is_layered(area_vector(surface, t).normalized()));
  return layer_directions(surface, stars, face_neighbours(surface, stars), layered);
}

// A wedge over (0, 0), (1, 0), (0, 1), whose sloping side is at this angle to its top, which is at z = 1.
SurfaceMesh prism(double side_deg) {
  const double under = 1 / std::tan(side_deg / degrees);  // how far the foot of that side is moved
  SurfaceMesh mesh;
  mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {under, 0, -1}, {4, 0, -1}, {4, 4, -1}, {under, 4, -1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 7, 6}, {4, 6, 5}, {0, 4, 5}, {0, 5, 1},
                    {1, 5, 6}, {1, 6, 2}, {2, 6, 7}, {2, 7, 3}, {3, 7, 4}, {3, 4, 0}};
  return mesh;
}

bool is_top(const Vec3& normal) {
  return normal.z() > 0.99;
}

TEST(LayerDirections, AtACornerAreOneAwayFromEachOfItsFaces) {
  const SurfaceMesh cube = analytic::box({1, 1, 1}, 0.25);
  const LayerDirections directions = directions_of(cube, [](const Vec3&) { return true; });
  for (std::size_t v = 0; v < cube.vertices.size(); ++v)
    for (int axis = 0; axis < 3; ++axis) {
      const double at = cube.vertices[v][axis];
      if (at == 0 || at == 1) {
        EXPECT_NEAR(directions.inwards[v][axis], 1 - 2 * at, 1e-12);
      }
      EXPECT_FALSE(directions.is_beside[v]);
    }
}

TEST(LayerDirections, AlongAFaceBesideLieInIt) {
  for (const double side : {45.0, 60.0, 90.0, 120.0}) {
    const SurfaceMesh mesh = prism(side);
    const LayerDirections directions = directions_of(mesh, is_top);
    const Vec3 along = Vec3(1 / std::tan(side / degrees), 0, -1);
    for (const std::size_t v : {0U, 3U}) {
      EXPECT_TRUE(directions.is_beside[v]);
      EXPECT_LT((directions.inwards[v] - along).norm(), 1e-12) << side;
    }
    for (std::size_t v = 4; v < 8; ++v) EXPECT_TRUE(directions.inwards[v].isZero()) << "not of the top";
  }
}

TEST(LayerDirections, AreNoneBesideAFaceThatGoesOnOrComesBack) {
  for (const double side : {20.0, 160.0}) {
    const LayerDirections directions = directions_of(prism(side), is_top);
    EXPECT_TRUE(directions.inwards[0].isZero()) << side;
    EXPECT_LT((directions.inwards[1] - Vec3(0, 0, -1)).norm(), 1e-12) << "the other side is upright";
  }
}

// The floor of a pocket: its walls rise, and the body goes on below them.
TEST(LayerDirections, AreNoneBesideAFaceThatRises) {
  SurfaceMesh pocket = analytic::reversed(analytic::box({1, 1, 1}, 0.25));
  const LayerDirections directions = directions_of(pocket, is_top);  // at z = 0, seen from inside the box
  std::size_t none = 0, down = 0;
  for (std::size_t v = 0; v < pocket.vertices.size(); ++v) {
    const Vec3& p = pocket.vertices[v];
    if (p.z() != 0) continue;
    const bool is_rim = p.x() == 0 || p.x() == 1 || p.y() == 0 || p.y() == 1;
    EXPECT_NEAR(directions.inwards[v].z(), is_rim ? 0 : -1, 1e-12);
    ++(is_rim ? none : down);
  }
  EXPECT_EQ(none, 16U);
  EXPECT_EQ(down, 9U);
}

// Three wedges of all orders of their corners, with columns at all corners, and at fewer.
TEST(LayerElements, ArePositiveAndFitHoweverTrianglesAreNumbered) {
  std::array<std::uint32_t, 4> order{0, 1, 2, 3};
  do {
    for (unsigned without = 0; without < 16; ++without) {
      // A square of two triangles.
      const std::array<Vec3, 4> corners{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
      SurfaceMesh square;
      square.vertices.resize(4);
      for (std::size_t k = 0; k < 4; ++k) square.vertices[order[k]] = corners[k];
      square.triangles = {{order[0], order[1], order[2]}, {order[0], order[2], order[3]}};
      LayerColumns columns(4);
      double volume = 0;  // under two layers of 0.1 and 0.2, which are zero at corners without a column
      for (std::uint32_t v = 0; v < 4; ++v) {
        if ((without >> v & 1U) != 0) continue;
        columns.first[v] = static_cast<std::uint32_t>(columns.nodes.size());
        columns.count[v] = 2;
        for (const double depth : {0.1, 0.3}) columns.nodes.push_back(square.vertices[v] - Vec3(0, 0, depth));
        for (const Triangle& t : square.triangles) volume += std::ranges::count(t, v) > 0 ? 0.3 / 6 : 0;
      }
      const LayeredTriangles layered{{{.count = 2, .first = 0.1, .growth = 2}}, {0, 0}};
      TetMesh mesh;
      mesh.tetrahedra = layer_elements(square, layered, columns).tetrahedra;
      mesh.nodes = square.vertices;
      mesh.nodes.insert(mesh.nodes.end(), columns.nodes.begin(), columns.nodes.end());
      double sum = 0;
      for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        EXPECT_GT(volume_of(mesh, t), 0);
        sum += volume_of(mesh, t);
      }
      EXPECT_NEAR(sum, volume, 1e-12);
      // Faces between the wedges belong to two elements: what is left bounds the slab, above, below and at its sides.
      double area = 0;
      for (const BoundaryFace& face : find_element_faces(mesh.tetrahedra).boundary) {
        const Triangle t = boundary_triangle(mesh, face);
        const Vec3 normal = (mesh.nodes[t[1]] - mesh.nodes[t[0]]).cross(mesh.nodes[t[2]] - mesh.nodes[t[0]]);
        const Vec3 middle = (mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]]) / 3;
        const bool is_side = (middle.head<2>() - Eigen::Vector2d(0.5, 0.5)).cwiseAbs().maxCoeff() > 0.5 - 1e-9;
        if (!is_side) area += std::abs(normal.z()) / 2;
      }
      if (without == 0) {
        EXPECT_NEAR(area, 2, 1e-12);
      }
    }
  } while (std::ranges::next_permutation(order).found);
}

}  // namespace
}  // namespace scan2fea
