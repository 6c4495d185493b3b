#include "quality/curved_surface.hpp"

#include "preproc/mesh/error.hpp"
#include "quality/deviation.hpp"
#include "quality/triangle_tree.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

namespace scan2fea {
namespace {

// A ball of tetrahedra around its centre, whose mid-edge nodes are on it.
TetMesh ball(int level, double radius) {
  const SurfaceMesh surface = analytic::sphere(radius, level);
  TetMesh mesh;
  mesh.nodes = surface.vertices;
  const auto centre = static_cast<std::uint32_t>(mesh.nodes.size());
  mesh.nodes.emplace_back(Vec3::Zero());
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  for (const Triangle& t : surface.triangles) {
    mesh.tetrahedra.push_back({t[0], t[2], t[1], centre});
    MidEdgeNodes& nodes = mesh.mid_edge_nodes.emplace_back();
    for (std::size_t e = 0; e < 6; ++e) {
      const std::uint32_t a = mesh.tetrahedra.back()[static_cast<std::size_t>(tetrahedron_edges[e][0])],
                          b = mesh.tetrahedra.back()[static_cast<std::size_t>(tetrahedron_edges[e][1])];
      const auto [it, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.nodes.size()));
      if (is_new) {
        Vec3 middle = 0.5 * (mesh.nodes[a] + mesh.nodes[b]);
        if (a != centre && b != centre) middle *= radius / middle.norm();
        mesh.nodes.push_back(middle);
      }
      nodes[e] = it->second;
    }
  }
  mesh.boundary = find_boundary(mesh.tetrahedra);
  return mesh;
}

TEST(CurvedSurface, PiecesAreWithinTheTolerance) {
  const TetMesh mesh = ball(1, 3);
  std::size_t before = 0;
  for (const double tolerance : {0.1, 0.01, 0.001}) {
    const FlatPieces pieces = flat_pieces(mesh, tolerance);
    EXPECT_GT(pieces.mesh.triangles.size(), before);
    before = pieces.mesh.triangles.size();
    for (std::uint32_t t = 0; t < pieces.mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = pieces.mesh.triangles[t];
      const std::vector<Vec3>& v = pieces.mesh.vertices;
      for (const auto& [r, s] : {std::pair(1.0 / 3, 1.0 / 3), {0.5, 0.5}, {0.5, 0.0}, {0.0, 0.5}, {0.2, 0.1}})
        EXPECT_LE((pieces.on_curve(t, r, s) - (r * v[a] + s * v[b] + (1 - r - s) * v[c])).norm(), tolerance);
      EXPECT_LE((pieces.on_curve(t, 1, 0) - v[a]).norm(), 1e-12);
      EXPECT_GT(area_vector(pieces.mesh, pieces.mesh.triangles[t]).dot(v[a]), 0) << "outwards";
    }
  }
}

TEST(CurvedSurface, OfStraightTrianglesAreThese) {
  TetMesh mesh = ball(1, 3);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    for (std::size_t e = 0; e < 6; ++e)
      mesh.nodes[mesh.mid_edge_nodes[t][e]] =
          0.5 * (mesh.nodes[mesh.tetrahedra[t][static_cast<std::size_t>(tetrahedron_edges[e][0])]] +
                 mesh.nodes[mesh.tetrahedra[t][static_cast<std::size_t>(tetrahedron_edges[e][1])]]);
  EXPECT_EQ(flat_pieces(mesh, 1e-9).mesh.triangles.size(), mesh.boundary.size());
}

TEST(CurvedSurface, DeviationIsThatOfTheCurves) {
  const SurfaceMesh reference = analytic::sphere(3, 6);
  const TetMesh mesh = ball(2, 3);
  const DeviationOptions options{.samples = 20'000, .seed = 1};
  const Deviation curved = measure_deviation(mesh, reference, options),
                  flat = measure_deviation(boundary_surface(mesh), reference, options),
                  fine = measure_deviation(flat_pieces(mesh, 1e-4).mesh, reference, options);
  EXPECT_LT(curved.rms_pct_diagonal, 0.1 * flat.rms_pct_diagonal);
  EXPECT_LT(curved.hausdorff, 0.1 * flat.hausdorff);
  EXPECT_NEAR(curved.from_mesh.hausdorff_pct_diagonal, fine.from_mesh.hausdorff_pct_diagonal, 0.005);
  EXPECT_LT(std::abs(curved.area_difference_pct), 0.2);
  EXPECT_LT(flat.area_difference_pct, -1);
  // Of the balls, by their volumes.
  const double truth = 100 * (total_volume(mesh) / enclosed_volume(reference) - 1);
  ASSERT_TRUE(curved.volume_difference_pct);
  EXPECT_NEAR(*curved.volume_difference_pct, truth, 1e-9);
  EXPECT_LT(std::abs(truth), 0.5);
  EXPECT_LT(*flat.volume_difference_pct, -3);
}

TEST(CurvedSurface, DeviationOfFirstOrderIsThatOfTheBoundary) {
  TetMesh mesh = ball(2, 3);
  mesh.mid_edge_nodes.clear();
  const SurfaceMesh reference = analytic::sphere(3.1, 3);
  const DeviationOptions options{.samples = 1000, .seed = 1};
  EXPECT_EQ(measure_deviation(mesh, reference, options).hausdorff,
            measure_deviation(boundary_surface(mesh), reference, options).hausdorff);
  EXPECT_THROW(measure_deviation(ball(1, 3), SurfaceMesh{}, options), InvalidInput);
}

}  // namespace
}  // namespace scan2fea
