// What is wrong with layers: elements that turn over, triangles that are squeezed, surfaces that meet.
#pragma once

#include "preproc/layers/layer_columns.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

// Per triangle of `surface`, whether columns are too high behind it, or for it beside them. `outer` is the surface
// where vertices beside the layers have made room, `inner` the one at the columns' ends. An element must have a tenth
// of what it has in an upright wedge; a triangle keep a quarter of its smallest angle and turn by less than 45 degrees;
// and where that holds all over, none of the inner ones may meet. O(n log n).
std::vector<bool> find_high_columns(const SurfaceMesh& surface, const SurfaceMesh& outer, const SurfaceMesh& inner,
                                    const LayeredTriangles& layered, const LayerColumns& columns);

// Vertices of triangles behind which an element has a dihedral angle below this, some more than once. O(n).
std::vector<std::uint32_t> find_flat_layers(const SurfaceMesh& outer, const LayeredTriangles& layered,
                                            const LayerColumns& columns, double least_deg);

}  // namespace scan2fea
