// The inside of closed polygons in the plane x = 0.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <span>
#include <vector>

namespace scan2fea {

// Triangles between the ends of `outline`, whose edges close polygons: what an odd number of them surrounds, so that
// polygons within polygons are holes; seen from x < 0 counter-clockwise. By CGAL's constrained Delaunay triangulation.
// Throws NotMeshable, with the place, where edges cross. O(n log n).
std::vector<Triangle> fill_outline(const std::vector<Vec3>& vertices, std::span<const FeatureEdge> outline);

}  // namespace scan2fea
