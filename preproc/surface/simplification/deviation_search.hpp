// The search for a surface that is nowhere farther from the scan than asked for, with few triangles.
//
// The distance of linear triangles goes with the edge length squared, place by place: a few surfaces are made, the edge
// lengths renewed from how far each came from the scan there (bounds, not samples), until few places are too far; these
// get patches of their own (local_refinement.hpp).
#pragma once

#include "preproc/surface/simplification/surface_candidate.hpp"

#include <span>

namespace scan2fea {

// Edge length of the first surface, over the deviation.
inline constexpr double first_edge_over_deviation = 12;

// How far chords of the result may be from the scan's creases and borders, over the deviation: local refinement leaves
// them as they are.
inline constexpr double curves_over_deviation = 0.9;

// `wanted`: in model units. `most_triangles`: no surface gets more, but where patches need some. `longest`: edges
// allowed, per vertex of the scan, or nothing. The candidate's `largest_deviation` is a bound for all points. Throws
// NotMeshable where the deviation is required and was not reached, and what make_surface throws.
Candidate make_surface_within(const PreparedScanPointer& scan, const LargestDeviation& wanted, double most_triangles,
                              std::span<const double> longest, const SimplifyOptions& options,
                              const Progress& progress);

}  // namespace scan2fea
