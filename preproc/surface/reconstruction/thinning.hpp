// Fewer points that say the same.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace scan2fea {

struct ThinnedCloud {
  std::vector<std::uint32_t> kept;   // numbers of the points, neighbours in space mostly beside one another
  std::vector<std::uint32_t> count;  // how many points each stands for, itself included
  double cell = 0;  // edge length of the cells; each dropped point is within its diagonal of a kept one
};

// Of all points in a cell of a grid the one nearest to their mean. Cells are as large as they must be for at most
// `most` points to stay; none where that is all of them. About a microsecond a point.
ThinnedCloud thin_by_cells(const std::vector<Vec3>& points, std::size_t most);

// No two points nearer than `radius`: of points on overlapping scan lines one stays, in the order of the list, and
// moves along the normal of those within the radius, where they are five or more, to their plane, by no more than the
// radius.
struct MergedPoints {
  std::vector<Vec3> points;
  std::vector<std::uint32_t> kept;  // numbers in the list
};
MergedPoints merge_near(const std::vector<Vec3>& points, double radius);

}  // namespace scan2fea
