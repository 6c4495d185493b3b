// Second-order tetrahedra.
#pragma once

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

struct CurveOptions {
  // An element stays curved while its Jacobian is everywhere at least this share of its straight one, 0 to 1. Solvers
  // need it positive; near zero their stiffness is as ill-conditioned as a flat element's. On scans dihedral angles of
  // curved elements fall to 7 degrees at 0.2, stay above 12 at 0.4 and 18 at 0.6; the RMS distance is 1 to 10 % larger
  // at 0.4 and 3 to 28 % at 0.6, the more the coarser the mesh.
  double least_jacobian = 0.4;
  // A mid-edge node moves by at most this share of its edge's length: farther away, the nearest point of the scan is
  // that of another sheet.
  double largest_displacement = 0.25;
};

struct CurveResult {
  std::size_t curved = 0;           // boundary mid-edge nodes that lie on the scan
  std::size_t too_far = 0;          // that stayed straight because the scan is too far away
  std::size_t invalid = 0;          // that stayed straight because an element would have suffered
  double largest_displacement = 0;  // model units
  double least_jacobian = 0.2;        // over all elements, of the straight Jacobian: a lower bound
  double volume = 0;                // enclosed by the curved mesh
};

// Edges of the boundary that stand for lines of the scan, and these: the middle of a chord of a rim lies in the plane
// face inside of it, where the nearest point of the scan is.
struct ScanLines {
  std::vector<std::array<std::uint32_t, 2>> edges;     // corner nodes, the smaller one first; sorted
  std::vector<Vec3> points;                            // of the scan
  std::vector<std::array<std::uint32_t, 2>> segments;  // of points
};

// Moves the mid-edge nodes of the boundary to the nearest points of the scan, or of its lines, where all elements stay
// valid by the bound of min_jacobian_bound; the others stay in the middle of their edges. The mesh is of second order
// with straight edges and positive tetrahedra; corners stay, so they should lie on the scan themselves. O(n log m) for
// m scan triangles; deterministic. Throws nothing of its own.
CurveResult curve_mid_edge_nodes(TetMesh& mesh, const TriangleTree& scan, const CurveOptions& options = {},
                                 const ScanLines& lines = {});

}  // namespace scan2fea
