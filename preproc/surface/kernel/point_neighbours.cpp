#include "preproc/surface/kernel/point_neighbours.hpp"

#include "preproc/surface/kernel/parallel_blocks.hpp"

#include <nanoflann.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace scan2fea {
namespace {

// What nanoflann asks of a point cloud.
struct Cloud {
  const std::vector<Vec3>& points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][static_cast<Eigen::Index>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using KdTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3, std::uint32_t>;

}  // namespace

struct PointNeighbours::Tree {
  explicit Tree(const std::vector<Vec3>& points)
      : cloud{points}, index(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10)) {}

  Cloud cloud;
  KdTree index;
};

PointNeighbours::PointNeighbours(const std::vector<Vec3>& points) : tree_(std::make_unique<Tree>(points)) {}
PointNeighbours::~PointNeighbours() = default;

std::span<PointNeighbours::Neighbour> PointNeighbours::nearest(const Vec3& p, std::span<Neighbour> found) const {
  constexpr std::size_t most = 64;
  std::array<std::uint32_t, most> index{};
  std::array<double, most> squared{};
  const std::size_t count =
      tree_->index.knnSearch(p.data(), std::min(found.size(), most), index.data(), squared.data());
  for (std::size_t k = 0; k < count; ++k) found[k] = {index[k], std::sqrt(squared[k])};
  std::ranges::sort(found.first(count), [](const Neighbour& a, const Neighbour& b) {
    return a.distance < b.distance || (a.distance == b.distance && a.point < b.point);
  });
  return found.first(count);
}

std::vector<double> point_spacing(const std::vector<Vec3>& points, const PointNeighbours& neighbours) {
  constexpr std::size_t ring = 6;
  std::vector<double> spacing(points.size());
  for_each_block(points.size(), [&](std::size_t first, std::size_t last) {
    std::array<PointNeighbours::Neighbour, ring + 1> found;
    for (std::size_t i = first; i < last; ++i) {
      double sum = 0;
      const auto near = neighbours.nearest(points[i], found);
      for (const auto& n : near) sum += n.distance;
      spacing[i] = sum / static_cast<double>(near.size() - 1);
    }
  });
  return spacing;
}

}  // namespace scan2fea
