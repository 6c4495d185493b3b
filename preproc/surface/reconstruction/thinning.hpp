// Fewer points that say the same.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace scan2fea {

struct ThinnedCloud {
  std::vector<std::uint32_t> kept;     // numbers of the points, neighbours in space mostly beside one another
  std::vector<std::uint32_t> members;  // numbers of all points, those of a cell one after the other
  std::vector<std::size_t> first;      // of each cell in `members`, and the end
  double cell = 0;  // edge length of the cells; each dropped point is within its diagonal of a kept one

  std::size_t count(std::size_t kept_point) const { return first[kept_point + 1] - first[kept_point]; }
};

// Of all points in a cell of a grid the one nearest to their mean. Cells are as large as they must be for at most
// `most` points to stay; none where that is all of them. About a microsecond a point.
ThinnedCloud thin_by_cells(const std::vector<Vec3>& points, std::size_t most);

// No two points nearer than `radius` of one side (`outwards`, sided_neighbours.hpp): of those on overlapping scan lines
// one stays, the first of the list.
enum class MergeTo {
  plane,  // it moves along the normal of those within the radius, where they are five or more, to their plane
  mean,   // it moves to their mean: where noise is as large as the radius there is no plane
};
struct MergedPoints {
  std::vector<Vec3> points;
  std::vector<std::uint32_t> stayed;  // which of the given points each was
};
MergedPoints merge_near(const std::vector<Vec3>& points, const std::vector<Vec3>& outwards, double radius,
                        MergeTo place);

// How thick the cloud is, seen from near by: the median of the RMS distance of eight neighbouring points from their
// plane over their reach, which is the distance of the farthest from their mean. A surface has less than 0.1, points
// all about in space have 0.3; and the median of the reach.
struct Roughness {
  double relative = 0;
  double reach = 0;
};
Roughness measure_roughness(const std::vector<Vec3>& points, const std::vector<Vec3>& outwards);

}  // namespace scan2fea
