// A box of tetrahedra whose every number is known, for tests of exporters and solvers.
#pragma once

#include "preproc/mesh/tet_mesh.hpp"

#include <array>

namespace scan2fea::analytic {

// The box from the origin to `size`, cut into `cells` cubes of six tetrahedra each that share the cube's diagonal
// (Kuhn's subdivision), all positive and conforming. Order 2 has its mid-edge nodes on the middles of the edges.
// Nodes are numbered as TetMesh wants: boundary corners, interior corners, mid-edge nodes.
TetMesh tetrahedra_of_box(const Vec3& size, const std::array<int, 3>& cells, int order);

}  // namespace scan2fea::analytic
