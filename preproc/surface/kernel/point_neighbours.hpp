// The nearest points of a cloud: a k-d tree.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace scan2fea {

class PointNeighbours {
 public:
  // The points must outlive this. O(n log n).
  explicit PointNeighbours(const std::vector<Vec3>& points);
  ~PointNeighbours();
  PointNeighbours(const PointNeighbours&) = delete;
  PointNeighbours& operator=(const PointNeighbours&) = delete;

  struct Neighbour {
    std::uint32_t point;
    double distance;
  };
  // The nearest points, 64 at most, one of the cloud itself included, nearest first, ties by index; as many as `found`
  // has room for and the cloud has points. Returns the part that was filled. From any number of threads.
  std::span<Neighbour> nearest(const Vec3& p, std::span<Neighbour> found) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

// Per point the mean distance of its six nearest neighbours, as many as a triangulated surface has about a vertex.
// Parallel, the same for any number of threads. Precondition: two points.
std::vector<double> point_spacing(const std::vector<Vec3>& points, const PointNeighbours& neighbours);

}  // namespace scan2fea
