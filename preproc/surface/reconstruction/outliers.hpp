// Points that no surface through their neighbours holds.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <vector>

namespace scan2fea {

struct OutlierSearch {
  std::vector<bool> is_outlier;  // of each point; none where there are too few points to tell
  bool has_outliers = false;     // whether there are so many far ones that near ones are likely, too
  double noise = 0;              // the typical distance of a point from the flattest plane that holds it
};

// Each point is held against planes that are fitted to seven neighbours of one of its own neighbours, itself left out,
// and that reach as far as it: on a smooth surface, a crease or a corner one of them passes by. What is farther from
// all of them than 0.28 of the spacing about it, and than five times the noise, is an outlier, and so is what is
// isolated: five spacings away from the fourth neighbour of its own; but not where two of its neighbours are, too. Done
// twice, the second time with planes of what the first has left. Precondition: no two points in one place. About 50 us
// a point; parallel, the same for any number of threads. Not guaranteed: outliers that are nearer to the surface than a
// third of the spacing, or that lie in its continuation, stay; and points of details that are finer than the spacing
// go. `outwards` tells points of the two sides of a wall apart (sided_neighbours.hpp).
OutlierSearch find_outliers(const std::vector<Vec3>& points, const std::vector<Vec3>& outwards = {});

}  // namespace scan2fea
