// Where a surface is too far from what it stands for.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "quality/deviation_bound.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

// Corners of the triangles where the surface is farther from its reference than this, or that from it, by a bound of
// the two; some more than once. O(n log n).
std::vector<std::uint32_t> vertices_beyond(const SurfaceMesh& mesh, const DeviationBound& bound, double distance);

}  // namespace scan2fea
