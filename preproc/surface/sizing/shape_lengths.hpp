// The longest edges with which triangles can follow the shape of a body at each place: what a lattice needs where it
// gave way with the lengths that a number of triangles asked for.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <vector>

namespace scan2fea {

// Halves the edges of a scan to at most `edges` of these lengths, and gives them per vertex, between `shortest` and
// `longest` (model units); strips too narrow for the shortest edges are none. The smallest of:
//  - twice the thickness of the wall behind the triangles around it (quality/wall_thickness.hpp), where no crease parts
//    its sides;
//  - 1.3 times the way along the surface in which it turns by 45 degrees without a crease;
//  - 0.6 of the width of the strip that it lies in, where two creases run side by side within 30 degrees.
// Where all that asked for more than `most_triangles` triangles, the lengths are longer by one factor, beyond `longest`
// if need be.
// Edges stay longer where halving them would make more than 250,000 triangles, and four times as many as there were or
// as may be asked for. Vertices and triangles keep their numbers, new ones follow; `creases` are sorted, and halved
// with their edges. Precondition: manifold, turned outwards. O(n log n) and the faces within `longest`, for a few
// rounds; parallel.
std::vector<double> part_by_shape(SurfaceMesh& mesh, std::vector<FeatureEdge>& creases, double edges, double shortest,
                                  double longest, double most_triangles);

// Whether a surface is a part's, made of plane, cylindrical and other smooth faces, and not a scan's of a free form: a
// third of the length of its edges bends by less than half a degree, or by what a crease does. Of the surfaces of
// libcgal-demo parts have 0.38 and more, free forms at most 0.29. Linear.
bool is_part(const SurfaceMesh& mesh);

}  // namespace scan2fea
