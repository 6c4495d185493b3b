// Where a surface is too far from what it stands for.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "quality/deviation_bound.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

// The triangles where the surface is farther from its reference than this, or nearest to what of that is farther from
// it, by a bound of the two. Sorted. O(n log n).
std::vector<std::uint32_t> triangles_beyond(const SurfaceMesh& mesh, const DeviationBound& bound, double distance);

// Corners of the triangles where the surface is farther from its reference than this, or that from it, by a bound of
// the two; some more than once. O(n log n).
std::vector<std::uint32_t> vertices_beyond(const SurfaceMesh& mesh, const DeviationBound& bound, double distance);

}  // namespace scan2fea
