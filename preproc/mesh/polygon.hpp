// Cuts the polygons of surface files into triangles.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <span>

namespace scan2fea {

// Appends corners.size() - 2 triangles that keep the polygon's orientation. Ears are cut off, the one with the shortest
// diagonal first, among those that turn the polygon's way about its mean normal and hold none of its other corners: a
// convex quad is split along its shorter diagonal, a concave polygon stays simple. Where no ear qualifies (the polygon
// crosses itself, or is degenerate) the shortest diagonal is taken, and the repair deals with the result.
// Polygons of more than 1000 corners, which are convex caps in practice, become a fan.
// Corners are valid indices into mesh.vertices, three or more. O(n^2) for convex polygons of n corners.
void append_polygon(SurfaceMesh& mesh, std::span<const std::uint32_t> corners);

}  // namespace scan2fea
