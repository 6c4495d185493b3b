// Vertices beside layers give way to them.
#pragma once

#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/volume/boundary_ways.hpp"

#include <vector>

namespace scan2fea {

// `pushed`: the moves of the vertices of layered triangles, which `is_layered` marks. The others follow those near by,
// as a membrane would, along their ways and their `lines` (sorted), up to four times the largest push from there. Per
// vertex its place; those marked stay. Deterministic; linear in the vertices that move, a few hundred times.
std::vector<Vec3> make_room(const SurfaceMesh& surface, const VertexStars& stars, const std::vector<bool>& is_layered,
                            const std::vector<Vec3>& pushed, const std::vector<FeatureEdge>& lines,
                            const BoundaryWays& ways);

}  // namespace scan2fea
