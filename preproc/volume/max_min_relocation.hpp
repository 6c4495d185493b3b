// Moving a vertex to where the worst element around it is best.
#pragma once

#include "preproc/volume/boundary_ways.hpp"
#include "preproc/volume/vertex_star.hpp"

namespace scan2fea {

// Steepest ascent of the star's least quality, non-smooth: the direction is the shortest vector in the convex hull of
// the gradients of the elements that are nearly worst (the active set). Source: Freitag, Jones and Plassmann, "An
// efficient parallel algorithm for mesh smoothing", 1995; Freitag and Ollivier-Gooch, "Tetrahedral mesh improvement
// using swapping and smoothing", 1997. Takes at most `steps`; `quality` is the star's at x and rises with every step.
// Returns whether x moved. Some 5 us a step.
bool relocate_max_min(const StarFaces& faces, Vec3& x, double& quality, int steps);

// The same of a node of the boundary, which goes where its ways lead.
bool slide_max_min(const StarFaces& faces, const BoundaryWays& ways, std::uint32_t node, Vec3& x, double& quality,
                   int steps);

}  // namespace scan2fea
