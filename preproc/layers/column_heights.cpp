#include "preproc/layers/column_heights.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "quality/wall_thickness.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <utility>

namespace scan2fea {
namespace {

// Of a wall, that the layers behind one side may take where the other side has layers, too, or has none.
constexpr double share_of_both = 0.4, share_of_one = 0.8;
constexpr double steps = 16;
constexpr double steepest = 0.6;  // of the last layer's end over the surface
constexpr double lower = 0.7;

double longest_edge(const SurfaceMesh& surface, const Triangle& t) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    longest = std::max(longest, (surface.vertices[t[k]] - surface.vertices[t[(k + 1) % 3]]).norm());
  return longest;
}

}  // namespace

void require_high_layers(const SurfaceMesh& surface, const LayeredTriangles& layered, double flattest, double unit) {
  double worst = 1, edge = 0;
  std::size_t at = 0;
  for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
    if (layered.of_triangle[f] == no_layers) continue;
    const double longest = longest_edge(surface, surface.triangles[f]);
    const double share = layered.heights[layered.of_triangle[f]].first / (flattest * longest);
    if (share >= worst) continue;
    worst = share;
    edge = longest;
    at = f;
  }
  if (worst == 1) return;
  edge *= unit;
  const double first = worst * flattest * edge;
  throw NotMeshable({.what = "a first layer is too flat for any solver",
                     .where = {},
                     .value = error_text(first) + " behind an edge of " + error_text(edge),
                     .limit = error_text(flattest) + " of the edge",
                     .advice = "a first layer of " + error_text(1.01 * flattest * edge, 3) +
                               ", or smaller triangles (--edge-length " + error_text(0.5 * first / flattest, 3) + ")",
                     .at = centroid(surface, surface.triangles[at])});
}

ColumnHeights::ColumnHeights(const SurfaceMesh& surface, const TriangleTree& tree, const VertexStars& stars,
                             const LayeredTriangles& layered, const LayerDirections& directions, double flattest)
    : surface_(surface), stars_(stars), layered_(layered), asked_(surface.vertices.size(), 0), lowest_(asked_) {
  for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
    if (layered.of_triangle[f] == no_layers) continue;
    const Triangle& t = surface.triangles[f];
    const LayerHeights& layers = layered.heights[layered.of_triangle[f]];
    const double flat = flattest * longest_edge(surface, t) / layers.share(1);
    for (const std::uint32_t v : t) {
      asked_[v] = layers.total();
      lowest_[v] = std::max(lowest_[v], flat);
    }
  }
  room_ = asked_;
  for (std::size_t v = 0; v < room_.size(); ++v) has_way_.push_back(!directions.inwards[v].isZero());
  keep_walls(tree);
  settle();
}

void ColumnHeights::keep_walls(const TriangleTree& tree) {
  const std::vector<Vec3> normals = face_normals(surface_);
  for (std::size_t f = 0; f < surface_.triangles.size(); ++f) {
    const std::uint32_t layers = layered_.of_triangle[f];
    if (layers == no_layers) continue;
    const Triangle& t = surface_.triangles[f];
    const double deepest = layered_.heights[layers].total() / share_of_both;
    const std::optional<Wall> wall = find_wall(surface_, tree, centroid(surface_, t), normals[f], {.deepest = deepest});
    if (!wall) continue;
    const bool is_both = layered_.of_triangle[wall->opposite] != no_layers;
    // In steps, since a surface that is nearly plane behind the layers would have flat elements on it.
    const double step = layered_.heights[layers].total() / steps;
    const double most = step * std::floor((is_both ? share_of_both : share_of_one) * wall->thickness / step);
    for (const std::uint32_t v : t) room_[v] = std::min(room_[v], most);
  }
}

// What tapers off may become too low.
void ColumnHeights::settle() {
  height_ = room_;
  for (std::size_t v = 0; v < height_.size(); ++v)
    if (!has_way_[v]) height_[v] = 0;
  do taper();
  while (drop_lowest());
}

bool ColumnHeights::drop_lowest() {
  bool any = false;
  for (std::size_t v = 0; v < height_.size(); ++v) {
    if (height_[v] == 0 || height_[v] >= lowest_[v]) continue;
    height_[v] = 0;
    any = true;
  }
  return any;
}

// From the lowest on, as shortest ways are found.
void ColumnHeights::taper() {
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (std::uint32_t v = 0; v < height_.size(); ++v)
    if (asked_[v] > 0 && height_[v] < asked_[v]) queue.push({height_[v], v});
  while (!queue.empty()) {
    const auto [height, v] = queue.top();
    queue.pop();
    if (height > height_[v]) continue;
    for (const std::uint32_t corner : stars_.corners(v)) {
      if (layered_.of_triangle[corner / 3] == no_layers) continue;
      for (const std::uint32_t w : surface_.triangles[corner / 3]) {
        const double most = height + steepest * (surface_.vertices[w] - surface_.vertices[v]).norm();
        if (height_[w] <= most) continue;
        height_[w] = most;
        queue.push({most, w});
      }
    }
  }
}

bool ColumnHeights::lower_at(const std::vector<std::vector<std::uint32_t>>& groups) {
  const std::vector<double> before = height_;
  bool any = false;
  for (const std::vector<std::uint32_t>& group : groups) {
    double highest = 0;
    for (const std::uint32_t v : group) highest = std::max(highest, before[v]);
    any = any || highest > 0;
    for (const std::uint32_t v : group) room_[v] = std::min(room_[v], lower * highest);
  }
  settle();
  return any;
}

void ColumnHeights::drop(const std::vector<std::uint32_t>& vertices) {
  for (const std::uint32_t v : vertices) room_[v] = 0;
  settle();
}

}  // namespace scan2fea
