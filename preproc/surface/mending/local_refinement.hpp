// Brings a sound surface within a distance of the scan where it is not, by changing only what is around: the last step
// to a deviation that holds, which the edge lengths of the whole surface can only come near to.
//
// Bounds of the deviation (quality/deviation_bound.hpp) show the places that are too far; each gets a patch of a few
// rings (refinement_patch.hpp); all is bounded again, until nothing is too far or nothing helps.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/fit/reference_surface.hpp"
#include "quality/deviation_bound.hpp"

#include <cstddef>
#include <limits>
#include <vector>

namespace scan2fea {

struct LocalRefinementOptions {
  double limit = 0;  // largest deviation, two-sided, model units; above 0
  // See ShapeFitOptions.
  double fidelity_of_diagonal = 0.0012;
  // Smaller angles are not made, nor made smaller; in [0, 60). Higher leaves less room to come near.
  double least_angle_deg = 35;
  std::size_t most_vertices = std::numeric_limits<std::size_t>::max();  // inserted; each makes two triangles more
  // Of refine_worst: where more places are beyond the limit, only so many of the worst are mended. At least 1.
  std::size_t most_places = std::numeric_limits<std::size_t>::max();
  // Of refine_within: where more places are stuck, neither edges are made shorter there nor smaller angles allowed.
  std::size_t most_to_yield = std::numeric_limits<std::size_t>::max();
  // Of refine_within, each bounded; at least 1.
  int rounds = 40;
  // Of refine_within: no more is tried when so many places more were tried in vain than came nearer.
  std::size_t most_in_vain = std::numeric_limits<std::size_t>::max();
};

struct LocalRefinementResult {
  std::size_t patches = 0;   // that came nearer
  std::size_t inserted = 0;  // vertices
};

// Both want `mesh` closed, manifold and free of self-intersections, and so it is afterwards, with the same genus and
// components. The enclosed volume changes a little, by the places that are mended (see preserve_volume.hpp).
// They throw WrongUsage for options out of range, Cancelled. Deterministic for any number of threads.

// One round, where samples show that it is needed: `deviation`, per face of `mesh`, of a fit (see ShapeFitResult), and
// the scan's vertices, at most six a face. Needs little memory, however large the scan: no tree of it, but a pass over
// it for each set of places that are apart. Not guaranteed: that the limit is reached.
LocalRefinementResult refine_worst(SurfaceMesh& mesh, const ReferenceSurface& scan, std::vector<double> deviation,
                                   const LocalRefinementOptions& options, const Progress& progress = {});

struct BoundedRefinementResult {
  double largest_deviation = 0;  // an upper bound, two-sided, model units
  LocalRefinementResult changes;
};

// Rounds of bounding and mending until the limit holds for every point, or nothing helps: the result says how near it
// came. Where nothing does, edges are made shorter there, then smaller angles allowed.
// Not guaranteed: the fewest triangles. One bound of the whole surface, and each round a bound of what has changed.
BoundedRefinementResult refine_within(SurfaceMesh& mesh, const ReferenceSurface& scan,
                                      const LocalRefinementOptions& options, const Progress& progress = {});

// The same with features: vertices on the net's lines stay where they are, and new ones come between them. The net's
// patches of faces are emptied. `reference`: of scan.mesh.
BoundedRefinementResult refine_within(SurfaceMesh& mesh, FeatureNet& net, const ReferenceSurface& scan,
                                      const DeviationReference& reference, const LocalRefinementOptions& options,
                                      const Progress& progress = {});

}  // namespace scan2fea
