// How far a surface is from the scan around each place of the scan, for a sizing that answers to it.
#pragma once

#include "preproc/surface/fit/reference_surface.hpp"
#include "quality/deviation_bound.hpp"

#include <vector>

namespace scan2fea {

// Per vertex of the scan, the largest deviation (lower bounds; both sides) of the faces of `mesh` that are nearest to
// it or that it is nearest to, or the mean of what their corners see in their stars, if that is more: vertices answer
// for all faces around them, but not so far that one bad face shrinks two rings of others. `bound` is of `mesh` from
// the scan. O((n + m) log) searches of nearest triangles; parallel, deterministic.
std::vector<double> deviation_at_scan(const SurfaceMesh& mesh, const ReferenceSurface& scan,
                                      const DeviationBound& bound);

}  // namespace scan2fea
