// What the collapse is told, and what it tells. [1] is in the list of sources in README.md.
#pragma once

#include "preproc/surface/placement/star_objective.hpp"

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace scan2fea {

// The predictor: which edge goes next.
enum class CollapseCost {
  bending_energy,  // integral of the squared curvature over the star that the contraction would leave
  quadric_error,   // squared distance of the midpoint to the planes of all faces merged so far
  edge_length,     // shortest edge first: the most even triangles
  sized_length,    // shortest edge relative to the wanted edge length first, with a mild penalty on valence
};

// From the tangent plane back to the surface.
enum class CollapseLifting {
  keep_volume,    // to the height at which the star encloses the volume that it did before (Lindstrom and Turk, 1998)
  closest_point,  // on the surface as it was given
  shepard,        // that of [1]: Shepard interpolation of the star's own vertices; flattens a little each time
};

// "bending-energy", "quadric-error", "edge-length", "sized-length".
std::string_view name_of(CollapseCost cost);
std::optional<CollapseCost> collapse_cost_named(std::string_view name);

struct CollapseOptions {
  // Number of faces to end with, at least 4. Met exactly, but for the parity of closed surfaces, where a contraction
  // takes two faces: the first count that is not above the target.
  std::size_t target_faces = 0;

  CollapseCost cost = CollapseCost::bending_energy;

  // The corrector; nothing leaves the kept vertex at the (lifted) midpoint.
  std::optional<StarObjective> objective = StarObjective::entropy_weighted;

  // keep_volume halves the RMS distance to the scan: points on the scan span chords inside of convex parts.
  CollapseLifting lifting = CollapseLifting::keep_volume;

  // Largest angle by which one contraction may turn a face's normal, in degrees, 10 to 85. Larger lets edges fold over;
  // smaller keeps contractions from rounding coarse curvature off. Candidates that break it are put back later.
  double largest_normal_turn_deg = 50;

  // Refuse contractions after which faces would meet: a surface free of self-intersections then stays so. Such tests
  // take about as long as all the rest.
  bool keep_clear = false;

  // For sized_length only: the wanted edge length at each vertex, model units, > 0.
  std::vector<double> sizing = {};
};

struct CollapseResult {
  std::size_t faces_before = 0;
  std::size_t faces_after = 0;
  std::size_t collapses = 0;
  std::size_t refused = 0;     // candidates that broke a condition when their turn came
  bool reached_target = true;  // false: no contraction was left that keeps topology and orientation
};

}  // namespace scan2fea
