// Second-order tetrahedra.
#pragma once

#include "preproc/mesh/tet_mesh.hpp"

namespace scan2fea {

// Adds a node in the middle of every edge, shared by all tetrahedra around it, in the order of `tetrahedron_edges`.
// The mesh is of first order; its corner nodes, tetrahedra and boundary stay as they are. O(n log n).
void add_mid_edge_nodes(TetMesh& mesh);

}  // namespace scan2fea
