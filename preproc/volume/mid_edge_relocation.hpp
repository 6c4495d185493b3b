// Moving mid-edge nodes inside a mesh, so that curved sides of its elements do no harm.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/tet_mesh.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

// How good a curved element is: the least of its scaled Jacobian over 0.25, the sine of its smallest dihedral angle
// over that of 15 degrees, and 1 + cos of its largest over that of 155 degrees; so 1 is good enough for a solver.
// (Straight elements are better: they come out of the optimisation with 24 to 132 degrees.)
double curved_quality(const TetMesh& mesh, std::size_t tetrahedron);

// Nodes of edges of these elements that are not `held` go to where the worst element around the edge is best, by at
// most a quarter of the edge: a search along shrinking steps, by turns until no element is below `wanted` or none
// gains. The mesh is of second order. Ends when there is no time
// for improvements. Throws Cancelled. Deterministic; some 0.2 ms a node.
void relocate_mid_edge_nodes(TetMesh& mesh, const std::vector<std::uint32_t>& poor, const std::vector<bool>& held,
                             double wanted, const Progress& progress = {});

}  // namespace scan2fea
