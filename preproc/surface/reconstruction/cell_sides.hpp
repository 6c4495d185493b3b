// Which tetrahedra a part's shapes say to be inside, and which outside: fronts go astray where points are few, but a
// hole that is known by some points is empty all along, and beyond a face there is nothing.
#pragma once

#include "preproc/surface/primitives/find_primitives.hpp"
#include "preproc/surface/reconstruction/delaunay.hpp"

#include <vector>

namespace scan2fea {

enum class CellSide : char { unknown, inside, outside };

// Of each tetrahedron of `points`, of whose shapes `found` tells. Outside is what lies in a hole (hole_voids.hpp), and
// what a hole's axis runs through. Else a centre is held against the shapes of its corners: inside where it is behind
// all of them, outside where before all; where it is behind one and before another, the edge between them tells:
// outside where each has the corners of the other behind it, inside where before it. Unknown: a corner without a shape,
// a centre within twice the noise. O(cells).
std::vector<CellSide> sides_by_shapes(const std::vector<Vec3>& points, const DelaunayCells& cells,
                                      const Primitives& found);

}  // namespace scan2fea
