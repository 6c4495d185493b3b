// Moves vertices of a sound surface only as far as it stays sound: where a fit or a shift of the volume would drive
// sheets through one another, they stop before they meet.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/vertex_constraint.hpp"

#include <cstddef>
#include <vector>

namespace scan2fea {

struct ClearMoves {
  std::size_t held = 0;  // vertices that did not get all the way
};

// Each vertex in turn goes to its target, or half or a quarter of the way, if its faces then meet no others, turn by
// less than 60 degrees and do not become needles; `sweeps` times, since what was in the way may have moved on.
// Precondition: no self-intersections; the surface has none afterwards either. One target a vertex. Serial; O(log n) a
// move.
ClearMoves move_clear(SurfaceMesh& mesh, const std::vector<Vec3>& targets, int sweeps = 3);

}  // namespace scan2fea
