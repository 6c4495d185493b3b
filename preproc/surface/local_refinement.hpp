// Brings a sound surface within a distance of the scan where it is not, by changing only what is around: the last step
// to a deviation that holds, which the edge lengths of the whole surface can only come near to.
//
// Bounds of the deviation (quality/deviation_bound.hpp) show the places that are too far; each gets a patch of a few
// rings (refinement_patch.hpp); all is bounded again, until nothing is too far or nothing helps.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/surface/reference_surface.hpp"

#include <cstddef>
#include <limits>

namespace scan2fea {

struct LocalRefinementOptions {
  double limit = 0;  // largest deviation, two-sided, model units; above 0
  // See ShapeFitOptions.
  double fidelity_of_diagonal = 0.0012;
  // Smaller angles are not made, nor made smaller; in [0, 60). Higher leaves less room to come near.
  double least_angle_deg = 35;
  std::size_t most_vertices = std::numeric_limits<std::size_t>::max();  // inserted; each makes two triangles more
  // Of bounding and mending; each costs a bound of the whole surface. At least 1; to know that the limit is reached, 2.
  int rounds = 10;
};

struct LocalRefinementResult {
  // An upper bound, two-sided, model units. Where it is above the limit, a round of mending has followed that was not
  // bounded any more.
  double deviation_before_last_round = 0;
  std::size_t patches = 0;   // that came nearer
  std::size_t inserted = 0;  // vertices
};

// Precondition: `mesh` is closed, manifold and free of self-intersections, and so it is afterwards, with the same genus
// and components. The enclosed volume changes a little, by the places that are mended (see preserve_volume.hpp).
// Throws WrongUsage for options out of range, Cancelled. Deterministic for any number of threads.
// Not guaranteed: that the limit is reached (the result says how near it came), and the fewest triangles.
LocalRefinementResult refine_within(SurfaceMesh& mesh, const ReferenceSurface& scan,
                                    const LocalRefinementOptions& options, const Progress& progress = {});

}  // namespace scan2fea
