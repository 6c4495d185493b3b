// The last resort for a scan that nothing else makes a solid of: a surface wrapped around it.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/repair/repair_result.hpp"

namespace scan2fea {

// Replaces the triangles by the boundary of what a ball of a fiftieth of their bounding box's diagonal cannot reach
// from outside, at a distance of a six-hundredth of it: closed, manifold, free of crossings, whatever the triangles are
// like. Holes, gaps and dents narrower than the ball are closed, cavities that it cannot enter are filled, and a sheet
// becomes a solid twice as thick as the distance. Portaneri, Rouxel-Labbe, Hemmer, Cohen-Steiner, Alliez, "Alpha
// Wrapping with an Offset" (2022), by CGAL. Logs the distance. Throws NotMeshable where no
// face has an area. Seconds, and minutes for very large or ragged scans.
void wrap(SurfaceMesh& mesh, RepairResult& result);

}  // namespace scan2fea
