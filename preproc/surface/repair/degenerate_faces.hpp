// Faces of no area, mended by collapsing and flipping edges: taken out alone they would leave slits.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/repair/repair_result.hpp"

namespace scan2fea {

// A face is degenerate if its height over its longest edge is below 1e-8 of that edge. Where its shortest edge is as
// short, that edge is collapsed (its end with the lower index stays where it is); otherwise its longest edge is
// flipped, which gives the face part of its neighbour's area. Repeated until none is left, or none that topology lets
// go. No vertex moves. Precondition: manifold and oriented. O(n).
void mend_degenerate_faces(SurfaceMesh& mesh, RepairResult& result);

}  // namespace scan2fea
