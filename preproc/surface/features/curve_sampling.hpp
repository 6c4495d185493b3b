// Where the vertices of the result lie on feature curves.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/features/feature_curves.hpp"

#include <vector>

namespace scan2fea {

struct CurveSamplingOptions {
  // Distance of a curve from the chords between its samples that is to be kept, model units, above 0. Spacing gives way
  // to it: it is met but for what the spacing's own cost outweighs, and where the curve is finer than a twelfth of the
  // wanted edge length.
  double tolerance = 0;
};

// Per curve its samples' parameters in ascending order: i + t is t of the way from the curve's i-th vertex to the next.
// Open curves have both their ends, 0 and size - 1; those of closed curves are in [0, size). Spaced by `edge_length`
// (wanted, per vertex of the scan, model units) as well as the tolerance allows: by dynamic programming over the
// vertices and points between them, a step of length l over a deviation dev costing
// (l / h - 1)^2 + 10 max(0, dev / tolerance - 0.5)^2.
// The chords make a simplicial complex: loops have at least three samples, also those with one corner, and of the
// curves between the same two corners all but one have at least one between.
// O(n) per curve of n vertices and pieces of h/6; serial, deterministic.
std::vector<std::vector<double>> sample_curves(const SurfaceMesh& scan, const FeatureCurves& features,
                                               const std::vector<double>& edge_length,
                                               const CurveSamplingOptions& options);

// The place of a parameter.
Vec3 curve_point(const SurfaceMesh& scan, const FeatureCurve& curve, double parameter);

}  // namespace scan2fea
