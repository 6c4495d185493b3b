// Shorter edges where a mesh is farther from the scan than elsewhere, longer ones where it is nearer.
#pragma once

#include "preproc/surface/fit/reference_surface.hpp"

#include <vector>

namespace scan2fea {

// Per vertex of the scan, the factor for the edge length there: (local error / mean error)^-exponent, within
// [least, 1 / least]. The local error is the RMS distance of the scan to `mesh` over about two edges around, so that
// one bad facet does not count for a feature. `mesh` should be fitted (shape_fit.hpp), or lie with its vertices on the
// scan. O(n log n); parallel, the same for any number of threads.
std::vector<double> error_factors(const SurfaceMesh& mesh, const ReferenceSurface& scan, double exponent,
                                  double least = 0.5);

}  // namespace scan2fea
