// Normals of scattered points, each of the side that the point lies on, and how noisy the points are.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/primitives/neighbours.hpp"

#include <vector>

namespace scan2fea {

struct PointNormals {
  std::vector<Vec3> normals;  // unit, one a point; zero where a point has fewer than three neighbours
  double noise = 0;           // standard deviation along normals, model units
  double spacing = 0;         // median distance of the sixth neighbour, model units
};

// Near a sharp edge the neighbours of a point lie on two surfaces, and a plane through all of them is neither. Each
// point takes the flattest plane that holds it, of those over a point and its seven nearest, then the slope of a
// quadric through those neighbours whose planes turn by less than 40 degrees from it. The noise is the median distance
// of points from quadrics that are fitted to their neighbours and leave them out, as Gaussian noise would have it; what
// such a quadric does not follow counts as noise.
// `outwards`: per point a direction that tells the two sides of the surface apart, such as the mean of its triangles'
// normals. `neighbours`: 16 to 24 a point. O(n). Not guaranteed: the side of points that lie on an edge itself.
PointNormals own_side_normals(const std::vector<Vec3>& points, const Neighbours& neighbours,
                              const std::vector<Vec3>& outwards);

}  // namespace scan2fea
