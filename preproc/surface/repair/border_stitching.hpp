// Borders that all but meet, joined: what is left of a surface whose faces were tessellated one by one, whose corners
// were rounded apart, or whose corners lie on the edges of their neighbours (T-junctions).
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/repair/repair_result.hpp"

namespace scan2fea {

// Corners on a border that lie within a tolerance of one another become the one that comes first, and an edge on a
// border that passes others within the tolerance is split at each of them: no vertex moves farther than the tolerance.
//
// The tolerance is the gaps' own. They come in groups, each of one cause (the step of a 32-bit float, the digits of a
// text file, the seam of a boolean operation): a group ends where the next wider gap is four times as wide. Of the
// tolerances at which groups end the one is taken that leaves the least length of borders, and of those that leave the
// same the smallest: a surface with a hole gets the tolerance at which its seams close and its hole does not change.
// Which gaps count at all is told in border_gaps.hpp. Logs each vertex that was joined and each edge that was split.
//
// O(n) for each group of gaps, of which there are about fifteen at the most, besides finding the gaps.
void stitch_borders(SurfaceMesh& mesh, RepairResult& result);

}  // namespace scan2fea
