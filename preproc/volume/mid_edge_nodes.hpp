// Second-order tetrahedra.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/tet_mesh.hpp"
#include "quality/triangle_tree.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace scan2fea {

// Adds a node in the middle of every edge, shared by all tetrahedra around it, in the order of `tetrahedron_edges`.
// The mesh is of first order; its corner nodes, tetrahedra and boundary stay as they are. O(n log n).
void add_mid_edge_nodes(TetMesh& mesh);

// Where the nodes of edges are to be.
struct EdgePlaces {
  std::vector<std::array<std::uint32_t, 2>> edges;  // corner nodes, the smaller one first; sorted
  std::vector<Vec3> places;
};

// Of all edges of the boundary, the nearest points of the scan to their middles; the middle itself where the scan is
// farther than a quarter of the edge: there it is that of another sheet. O(n log m) for m scan triangles.
EdgePlaces nearest_on_scan(const TetMesh& mesh, const TriangleTree& scan);

// Puts the nodes of edges to their places. Returns the node of each place. The mesh is of second order and has each of
// these edges.
std::vector<std::uint32_t> place_mid_edge_nodes(TetMesh& mesh, const EdgePlaces& to);

struct CurveResult {
  std::size_t tetrahedra = 0, nodes = 0;
  std::size_t curved = 0;            // of these nodes, that are not in their middles
  std::size_t eased = 0;             // that are less far from them than they were to be, since elements suffered
  double largest_displacement = 0;   // from the middle, model units
  double least_scaled_jacobian = 1;  // a lower bound
  double volume = 0;                 // enclosed by the curved mesh
};

// Puts the nodes of edges to their places, or as far towards them as the elements stay good: then `to` has where they
// are. The mesh is of second order with positive tetrahedra. Without time for improvements more nodes are eased. The
// first `flat_tetrahedra` are meant to be flat: they are good as long as they keep half of the scaled Jacobian that
// they have with straight edges. Throws Cancelled. Deterministic, near linear.
CurveResult curve_mid_edge_nodes(TetMesh& mesh, EdgePlaces& to, const Progress& progress = {},
                                 std::size_t flat_tetrahedra = 0);

}  // namespace scan2fea
