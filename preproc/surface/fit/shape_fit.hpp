// Moves the vertices of a mesh so that its triangles become equilateral and its surface lies on the scan, both at once.
//
// Minimises
//   E = sum over faces F(eta) + n / (A (q d)^2) * sum over samples w r^2,
// with F of shape_energy.hpp, n faces, A the scan's area, d its bounding-box diagonal, w the area that a scan sample
// stands for and r its distance to the mesh. Shape alone slides off the scan, fit alone makes needles; the dial between
// them is q: residuals of q d cost as much as F(eta) = 1. Each round locates all samples anew (locate.hpp), then a few
// Gauss-Seidel sweeps take one 3 x 3 Newton step per vertex, on samples condensed to moments (fit_moments.hpp).
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/fit/reference_surface.hpp"
#include "preproc/surface/fit/shape_fit_options.hpp"

namespace scan2fea {

// Connectivity stays. Precondition: a manifold mesh near the scan whose triangles have areas and are not inverted: eta
// does not see an inverted triangle. Throws WrongUsage for options out of range, InvalidInput for a mesh or scan
// without triangles, Cancelled. Deterministic for any number of threads. Not guaranteed: freedom from
// self-intersections and inverted triangles (see mend_surface.hpp), exact volume (see preserve_volume.hpp).
// Cost per round: O(samples) with a small constant (the samples are capped at 12 a face), a few ms per 10,000 faces
// and sweep.
ShapeFitResult optimise_shape_and_fit(SurfaceMesh& mesh, const ReferenceSurface& scan,
                                      const ShapeFitOptions& options = {}, const Progress& progress = {});

// The same with features: vertices on the net's lines stay on them, and samples of the scan belong to the faces of
// their own patch alone. `scan` is made from the FeatureScan that the net comes from. Places on the lines are renewed.
ShapeFitResult optimise_shape_and_fit(SurfaceMesh& mesh, FeatureNet& net, const ReferenceSurface& scan,
                                      const ShapeFitOptions& options = {}, const Progress& progress = {});

}  // namespace scan2fea
