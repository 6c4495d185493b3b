// Removes self-intersections of a surface where they are, and leaves the rest alone.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/repair/repair_result.hpp"

namespace scan2fea {

struct IntersectionRemoval {
  std::size_t remaining = 0;  // pairs that no round mended; 0 as a rule
  double area_cut = 0;        // of the faces of the input that are gone
};

// Solids that overlap are united (see crossing_union.hpp), vertices that only touch drawn apart, parts of one solid
// that pass through each other united, folds smoothed (see fold_smoothing.hpp) and, where that did not part them,
// united. What still intersects is cut out with a ring of neighbours and filled, in rounds: whatever intersects
// afterwards is cut with a wider ring, and every other time filled by the plainest patch. Islands that a cut leaves,
// smaller than the cut itself, go with it. The result is manifold unless intersections remain; it may have more shells
// than before, some of them within others. Of a surface with borders, which stay borders, nothing is united, and a cut
// that reaches a border is not filled. Precondition: manifold. Costs one search for intersections for a sound surface,
// and a local search a round.
IntersectionRemoval remove_intersections(SurfaceMesh& mesh, RepairResult& result, const Progress& progress);

}  // namespace scan2fea
