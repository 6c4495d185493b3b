// The nearest points of a cloud that lie on the same side of a wall, where normals or scanners tell sides.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/point_neighbours.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

class SidedNeighbours {
 public:
  // `outwards`: of each point a direction out of the material, of unit length, zero where unknown; or none at all, and
  // all points are of one side. Both must outlive this. O(n log n).
  SidedNeighbours(const std::vector<Vec3>& points, const std::vector<Vec3>& outwards)
      : points_(points), outwards_(outwards), all_(points) {}

  using Neighbour = PointNeighbours::Neighbour;
  // Of a place and the direction out of it, as PointNeighbours has them; of the 64 nearest those that do not look the
  // other way.
  std::span<Neighbour> nearest(const Vec3& p, const Vec3& outwards, std::span<Neighbour> found) const;
  // Of a point of the cloud.
  std::span<Neighbour> nearest(std::size_t point, std::span<Neighbour> found) const {
    return nearest(points_[point], outwards_.empty() ? Vec3(Vec3::Zero()) : outwards_[point], found);
  }

 private:
  const std::vector<Vec3>& points_;
  const std::vector<Vec3>& outwards_;
  PointNeighbours all_;
};

// As point_spacing, of the neighbours of the same side.
std::vector<double> sided_spacing(const std::vector<Vec3>& points, const std::vector<Vec3>& outwards);

}  // namespace scan2fea
