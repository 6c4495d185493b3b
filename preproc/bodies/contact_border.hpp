// The borders of a contact on both of its bodies, made one.
#pragma once

#include "preproc/bodies/split_surface.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

// Edges of which just one of the listed triangles that they have is marked, sorted. Both are per triangle.
std::vector<FeatureEdge> border_of_marked(const SurfaceMesh& mesh, const std::vector<bool>& listed,
                                          const std::vector<bool>& marked);

// Splits the edges of both borders so that each of `second` becomes one of `first` or is to vanish. Per vertex of
// `second` the vertex of `first` that it is from now on, or no_image. Throws NotMeshable where the borders are farther
// apart than a few times the tolerance, or than the length of edges to which they were found (`resolution`), or do not
// go the same way.
inline constexpr std::uint32_t no_image = ~std::uint32_t{0};
std::vector<std::uint32_t> match_borders(SplitSurface& first, std::vector<FeatureEdge> border_of_first,
                                         SplitSurface& second, const std::vector<FeatureEdge>& border_of_second,
                                         double tolerance, double resolution);

}  // namespace scan2fea
