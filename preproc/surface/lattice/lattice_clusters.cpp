#include "preproc/surface/lattice/lattice_clusters.hpp"

#include "preproc/surface/kernel/parallel_blocks.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace scan2fea {
namespace {

constexpr std::uint32_t no_anchor = std::numeric_limits<std::uint32_t>::max();
// Lattice points that may become one are at most this far apart, in edge lengths: neighbouring points of the lattice
// are 1 apart, and a little more than half of that allows for the disagreement of the two ends.
constexpr double farthest_join = 0.6;
// Clusters of less than this part of a cell are not a lattice point's, but leftovers between such.
constexpr double smallest_cluster = 0.3;
// A cell of a lattice of edge length 1: there are two triangles a point.
constexpr double cell_area = 2 * equilateral_area;

}  // namespace

LatticeClusters::LatticeClusters(const FieldGraph& field_graph, const OrientationField& orientation,
                                 const PositionField& position)
    : graph_(&field_graph.levels.front()),
      sets_(graph_->size()),
      next_(graph_->size()),
      points_(graph_->size()),
      counts_(graph_->size(), 1.0),
      lengths_(graph_->size()),
      cells_(graph_->size()),
      is_anchored_(graph_->size(), false) {
  const GraphLevel& graph = *graph_;
  const std::vector<Complex>& directions = orientation.directions;
  const Complex sixth = std::polar(1.0, M_PI / 3);
  for_each_block(graph.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      next_[i] = static_cast<std::uint32_t>(i);
      lengths_[i] = std::exp(graph.log_length[i]);
      const auto [u, v] = position.offsets[i];
      const Complex to_point = -lengths_[i] * directions[i] * (static_cast<double>(u) + static_cast<double>(v) * sixth);
      points_[i] = graph.positions[i] + TangentFrame(graph.normals[i]).vector(to_point);
      cells_[i] = graph.areas[i] / (cell_area * lengths_[i] * lengths_[i]);
    }
  });
  join_anchored(field_graph.anchors);
  for (const Join& join : joins_by_residual(position)) join_if_near(join);
  dissolve_small();
}

template <class Visit>
void LatticeClusters::for_each_neighbour_set(std::uint32_t root, const Visit& visit) {
  std::uint32_t i = root;
  do {
    for (std::uint32_t e = graph_->first[i]; e < graph_->first[i + 1]; ++e) {
      const std::uint32_t other = find(graph_->neighbours[e]);
      if (other != root) visit(other);
    }
    i = next_[i];
  } while (i != root);
}

bool LatticeClusters::dissolve(std::uint32_t root) {
  if (is_anchored_[root]) return false;
  std::uint32_t nearest = no_anchor;
  double nearest_distance = std::numeric_limits<double>::infinity();
  const Vec3 here = point(root);
  for_each_neighbour_set(root, [&](std::uint32_t other) {
    const double distance = (point(other) - here).squaredNorm();
    if (distance < nearest_distance || (distance == nearest_distance && other < nearest)) {
      nearest = other;
      nearest_distance = distance;
    }
  });
  if (nearest == no_anchor) return false;
  // The receiver keeps its place.
  const Vec3 sum = points_[nearest];
  const double count = counts_[nearest];
  const std::uint32_t joint = merge(root, nearest);
  points_[joint] = sum;
  counts_[joint] = count;
  return true;
}

// All nodes of a sample, on whatever side of a feature, are one set at its place.
void LatticeClusters::join_anchored(const std::vector<Vec3>& anchors) {
  if (anchors.empty()) return;
  std::vector<std::uint32_t> first(anchors.size(), no_anchor);
  for (std::uint32_t i = 0; i < graph_->size(); ++i) {
    const std::uint32_t sample = graph_->anchor[i];
    if (sample == no_sample) continue;
    if (first[sample] == no_anchor) first[sample] = i;
    const std::uint32_t root = first[sample] == i ? i : merge(find(first[sample]), i);
    points_[root] = anchors[sample];
    is_anchored_[root] = true;
  }
}

// Edges whose ends share a lattice point, by ascending disagreement about where it is.
std::vector<LatticeClusters::Join> LatticeClusters::joins_by_residual(const PositionField& position) const {
  const GraphLevel& graph = *graph_;
  constexpr std::size_t buckets = no_shared_point;
  const std::vector<std::uint16_t>& residual = position.residuals;
  std::array<std::size_t, buckets + 1> start{};
  for (const std::uint16_t r : residual)
    if (r != no_shared_point) ++start[r + 1U];
  for (std::size_t b = 0; b < buckets; ++b) start[b + 1] += start[b];
  std::vector<Join> joins(start[buckets]);
  for (std::uint32_t i = 0; i < graph.size(); ++i)
    for (std::uint32_t e = graph.first[i]; e < graph.first[i + 1]; ++e)
      if (residual[e] != no_shared_point) joins[start[residual[e]]++] = {graph.neighbours[e], i};
  return joins;
}

void LatticeClusters::join_if_near(const Join& join) {
  const std::uint32_t a = find(join.a), b = find(join.b);
  if (a == b || (is_anchored_[a] && is_anchored_[b])) return;
  const double most = farthest_join * 0.5 * (lengths_[a] + lengths_[b]);
  if ((point(a) - point(b)).squaredNorm() > most * most) return;
  const bool is_anchored = is_anchored_[a] || is_anchored_[b];
  const std::uint32_t anchored = is_anchored_[a] ? a : b;
  const Vec3 sum = is_anchored ? points_[anchored] : Vec3(points_[a] + points_[b]);
  const double count = is_anchored ? counts_[anchored] : counts_[a] + counts_[b];
  const std::uint32_t root = merge(a, b);
  points_[root] = sum;
  counts_[root] = count;
}

void LatticeClusters::dissolve_small() {
  std::vector<std::uint32_t> small;
  for (std::uint32_t i = 0; i < graph_->size(); ++i)
    if (find(i) == i && cells(i) < smallest_cluster) small.push_back(i);
  std::stable_sort(small.begin(), small.end(), [&](std::uint32_t a, std::uint32_t b) { return cells(a) < cells(b); });
  for (const std::uint32_t root : small)
    if (find(root) == root && cells(root) < smallest_cluster) dissolve(root);
}

std::uint32_t LatticeClusters::merge(std::uint32_t a, std::uint32_t b) {
  std::swap(next_[a], next_[b]);  // two rings become one
  const double cells = cells_[a] + cells_[b];
  const bool is_anchored = is_anchored_[a] || is_anchored_[b];
  const std::uint32_t root = sets_.unite(a, b);
  cells_[root] = cells;
  is_anchored_[root] = is_anchored;
  return root;
}

SurfaceMesh welded_scan(const SurfaceMesh& cut, const std::vector<std::uint32_t>& welded) {
  SurfaceMesh mesh;
  mesh.vertices.resize(*std::max_element(welded.begin(), welded.end()) + std::size_t{1});
  for (std::size_t i = 0; i < welded.size(); ++i) mesh.vertices[welded[i]] = cut.vertices[i];
  mesh.triangles = cut.triangles;
  for (Triangle& t : mesh.triangles) t = {welded[t[0]], welded[t[1]], welded[t[2]]};
  return mesh;
}

}  // namespace scan2fea
