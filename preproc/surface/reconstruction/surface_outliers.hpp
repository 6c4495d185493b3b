// A second look at outliers, along a first surface through the points: it tells which of them are neighbours and which
// lie on the other side of a wall, and what shapes a part is made of.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/primitives/find_primitives.hpp"

#include <vector>

namespace scan2fea {

// Of each of `points`, whose first are the vertices of `surface`, used or not, whether it is an outlier. The others,
// which the surface does not know, are held against what is about the vertex that is nearest to them.
// On a part, whose `shapes` are those of the vertices, a point is sound within 3.5 times the noise of a shape that a
// neighbour lies on; but where neighbours, too, lie on no shape, and where there are none, it is held against a quadric
// through its neighbours that outliers do not pull, itself left out: by the noise, and by how far its neighbours are
// from theirs, since quadrics follow no crease. About 30 us a point; parallel, the same for any number of threads.
// Precondition: a triangle. Not guaranteed: outliers within four times the noise of the surface stay.
std::vector<bool> find_surface_outliers(const SurfaceMesh& surface, const Primitives& shapes,
                                        const std::vector<Vec3>& points);

}  // namespace scan2fea
