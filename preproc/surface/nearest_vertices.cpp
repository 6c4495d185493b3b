#include "preproc/surface/nearest_vertices.hpp"

#include "preproc/surface/adjacency.hpp"

#include <nanoflann.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace scan2fea {
namespace {

// What nanoflann asks of a point cloud.
struct Cloud {
  const std::vector<Vec3>& points;
  const std::vector<std::uint32_t>& used;

  std::size_t kdtree_get_point_count() const { return used.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[used[i]][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3, std::uint32_t>;

constexpr std::size_t candidates = 8;

}  // namespace

std::vector<std::uint32_t> nearest_vertices(const std::vector<Vec3>& points, const std::vector<Vec3>& normals,
                                            const SurfaceMesh& among, double spacing) {
  std::vector<bool> is_used(among.vertices.size(), false);
  for (const Triangle& t : among.triangles) {
    for (const std::uint32_t v : t) is_used[v] = true;
  }
  std::vector<std::uint32_t> used;
  for (std::uint32_t v = 0; v < among.vertices.size(); ++v) {
    if (is_used[v]) used.push_back(v);
  }
  const std::vector<Vec3> vertex_normal = vertex_normals(among);
  const Cloud cloud{among.vertices, used};
  const Tree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10));

  std::vector<std::uint32_t> nearest(points.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 1024), [&](const auto& range) {
    std::array<std::uint32_t, candidates> index{};
    std::array<double, candidates> squared{};
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      tree.knnSearch(points[i].data(), 1, index.data(), squared.data());
      if (normals[i].dot(vertex_normal[used[index[0]]]) >= 0) {
        nearest[i] = used[index[0]];
        continue;
      }
      const std::size_t found = tree.knnSearch(points[i].data(), candidates, index.data(), squared.data());
      const auto badness = [&](std::size_t k) {
        const bool opposed = normals[i].dot(vertex_normal[used[index[k]]]) < 0;
        return squared[k] + (opposed ? spacing * spacing : 0.0);
      };
      std::size_t best = 0;
      for (std::size_t k = 1; k < found; ++k) {
        if (badness(k) < badness(best)) best = k;
      }
      nearest[i] = used[index[best]];
    }
  });
  return nearest;
}

}  // namespace scan2fea
