// Large plane faces cut into triangles that are no needles.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

namespace scan2fea {

// Where a plane face has many vertices on its border, as where another surface gives them, its triangles are needles
// that reach across it, and halving these makes as many needles more. Here edges within planes (to `rounding`, model
// units) are flipped to be Delaunay's and those longer than `longest` halved, until none is. Vertices and border stay,
// new ones follow. About O(n log n) for n triangles of the result.
SurfaceMesh with_even_planes(const SurfaceMesh& mesh, double longest, double rounding);

}  // namespace scan2fea
