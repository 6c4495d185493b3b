#include "preproc/surface/kernel/nearest.hpp"

#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/parallel_blocks.hpp"
#include "quality/triangle_tree.hpp"

#include <nanoflann.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace scan2fea {
namespace {

// What nanoflann asks of a point cloud.
struct PointsUsed {
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

using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointsUsed>, PointsUsed, 3, std::uint32_t>;

constexpr std::size_t candidates = 8;
// Cosine between normals; the two sides of a crease that ends inside a patch are on the same one.
constexpr double same_side_of_slit = 0.94;

// The vertices that a triangle uses, in order.
std::vector<std::uint32_t> used_vertices(const SurfaceMesh& mesh) {
  std::vector<bool> is_used(mesh.vertices.size(), false);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) is_used[v] = true;
  }
  std::vector<std::uint32_t> used;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if (is_used[v]) used.push_back(v);
  }
  return used;
}

// For the points listed, the nearest of the vertices listed.
void find_nearest(const std::vector<Vec3>& points, const std::vector<Vec3>& normals,
                  const std::vector<std::uint32_t>& which, const std::vector<Vec3>& vertices,
                  const std::vector<Vec3>& vertex_normal, const std::vector<std::uint32_t>& used,
                  double least_agreement, double spacing, std::vector<std::uint32_t>& nearest) {
  const PointsUsed cloud{vertices, used};
  const Tree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10));
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, which.size(), 1024), [&](const auto& range) {
    std::array<std::uint32_t, candidates> index{};
    std::array<double, candidates> squared{};
    for (std::size_t k = range.begin(); k < range.end(); ++k) {
      const std::uint32_t i = which[k];
      tree.knnSearch(points[i].data(), 1, index.data(), squared.data());
      if (normals[i].dot(vertex_normal[used[index[0]]]) >= least_agreement) {
        nearest[i] = used[index[0]];
        continue;
      }
      const std::size_t found = tree.knnSearch(points[i].data(), candidates, index.data(), squared.data());
      const auto badness = [&](std::size_t c) {
        const bool opposed = normals[i].dot(vertex_normal[used[index[c]]]) < least_agreement;
        return squared[c] + (opposed ? spacing * spacing : 0.0);
      };
      std::size_t best = 0;
      for (std::size_t c = 1; c < found; ++c) {
        if (badness(c) < badness(best)) best = c;
      }
      nearest[i] = used[index[best]];
    }
  });
}

}  // namespace

std::vector<std::uint32_t> nearest_vertices(const std::vector<Vec3>& points, const std::vector<Vec3>& normals,
                                            const SurfaceMesh& among, double spacing) {
  std::vector<std::uint32_t> all(points.size()), nearest(points.size());
  std::iota(all.begin(), all.end(), 0U);
  find_nearest(points, normals, all, among.vertices, vertex_normals(among), used_vertices(among), 0, spacing, nearest);
  return nearest;
}

std::vector<std::uint32_t> nearest_vertices_of_patch(const std::vector<Vec3>& points, const std::vector<Vec3>& normals,
                                                     const std::vector<std::uint32_t>& patch_of_point,
                                                     const SurfaceMesh& among,
                                                     const std::vector<std::uint32_t>& patch_of_vertex,
                                                     double spacing) {
  const std::size_t patches =
      1 + std::size_t{std::max(*std::max_element(patch_of_point.begin(), patch_of_point.end()),
                               *std::max_element(patch_of_vertex.begin(), patch_of_vertex.end()))};
  const std::vector<std::uint32_t> used = used_vertices(among);
  std::vector<std::vector<std::uint32_t>> points_of(patches), vertices_of(patches);
  for (std::uint32_t i = 0; i < points.size(); ++i) points_of[patch_of_point[i]].push_back(i);
  for (const std::uint32_t v : used) vertices_of[patch_of_vertex[v]].push_back(v);
  const std::vector<Vec3> normals_among = vertex_normals(among);
  std::vector<std::uint32_t> nearest(points.size());
  for (std::size_t p = 0; p < patches; ++p) {
    if (points_of[p].empty()) continue;
    find_nearest(points, normals, points_of[p], among.vertices, normals_among,
                 vertices_of[p].empty() ? used : vertices_of[p], same_side_of_slit, spacing, nearest);
  }
  return nearest;
}

std::vector<std::uint32_t> nearest_faces(const std::vector<Vec3>& points, const SurfaceMesh& mesh) {
  const TriangleTree tree(mesh);
  std::vector<std::uint32_t> faces(points.size());
  for_each_block(points.size(), [&](std::size_t first, std::size_t last) {
    std::uint32_t hint = tree.leaf_order().front();
    for (std::size_t i = first; i < last; ++i) faces[i] = hint = tree.closest(points[i], hint).triangle;
  });
  return faces;
}

}  // namespace scan2fea
