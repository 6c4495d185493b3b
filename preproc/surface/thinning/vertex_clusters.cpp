#include "preproc/surface/thinning/vertex_clusters.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/splitmix64.hpp"
#include "preproc/surface/thinning/distance_bound.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>

namespace scan2fea {
namespace {

constexpr std::uint32_t unnumbered = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t known_vertices = 1U << 16;

std::optional<double> volume_within(const std::vector<Facet>& facets, const std::vector<Vec3>& vertices) {
  if (facets.empty()) return 0;
  const Vec3& apex = vertices[facets.front().corners[0]];
  double volume = 0;
  std::uint64_t border = 0;  // the edges' hashes, as often as the faces go along them: 0 where there is no border
  const auto go_along = [&](std::uint32_t from, std::uint32_t to, std::int32_t times) {
    border += static_cast<std::uint64_t>(std::int64_t{times}) * splitmix64((std::uint64_t{from} << 32U) | to);
  };
  for (const Facet& facet : facets) {
    const auto& [a, b, c] = facet.corners;
    volume += facet.turns * (vertices[a] - apex).dot((vertices[b] - apex).cross(vertices[c] - apex)) / 6;
    go_along(a, b, facet.turns);
    go_along(b, c, facet.turns);
    go_along(a, c, -facet.turns);
  }
  if (border != 0) return {};
  return volume;
}

// Of the facets, in the order of the given triangles; of the vertices those that facets use, in theirs.
ThinnedSurface surface_of(std::vector<Facet> facets, const std::vector<Vec3>& vertices) {
  std::erase_if(facets, [](const Facet& facet) { return facet.turns == 0; });
  std::ranges::sort(facets, {}, &Facet::first);
  std::vector<std::uint32_t> number(vertices.size(), unnumbered);
  for (const Facet& facet : facets)
    for (const std::uint32_t c : facet.corners) number[c] = 0;
  ThinnedSurface thinned;
  thinned.volume = volume_within(facets, vertices);
  for (std::uint32_t c = 0; c < vertices.size(); ++c) {
    if (number[c] == unnumbered) continue;
    number[c] = static_cast<std::uint32_t>(thinned.mesh.vertices.size());
    thinned.mesh.vertices.push_back(vertices[c]);
  }
  thinned.mesh.triangles.reserve(facets.size());
  thinned.origin.reserve(facets.size());
  for (const Facet& facet : facets) {
    Triangle t{number[facet.corners[0]], number[facet.corners[1]], number[facet.corners[2]]};
    if (facet.turns < 0) std::swap(t[1], t[2]);
    thinned.mesh.triangles.push_back(t);
    thinned.origin.push_back(facet.first);
  }
  return thinned;
}

}  // namespace

VertexClusters::VertexClusters(ClusterSeeds seeds) : seeds_(std::move(seeds)), clusters_(seeds_.count()) {}

void VertexClusters::add(const SurfaceMesh& block) {
  known_.assign(known_vertices, {unnumbered, unnumbered});
  const double cell = seeds_.cell();
  for (const Triangle& t : block.triangles) {
    if (given_ == std::numeric_limits<std::uint32_t>::max())
      throw InvalidInput({"too many triangles", {}, {}, std::to_string(given_), "parts of the scan"});
    std::array<Corner, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) corners[k] = corner_at(block.vertices[t[k]], t[k]);
    gather(corners, area_vector(block, t) / (cell * cell));
    add_image(corners);
    ++given_;
  }
  constexpr std::size_t smallest_to_compact = 1U << 20;  // and twice what was left: see FacetChain::add
  if (edges_.size() >= std::max(smallest_to_compact, 2 * edges_when_compact_)) compact_edges();
}

VertexClusters::Corner VertexClusters::corner_at(const Vec3& p, std::uint32_t vertex) {
  const Vec3 in_cells = seeds_.in_cells(p);
  Known& known = known_[vertex % known_vertices];
  if (known.vertex != vertex) known = {vertex, seeds_.nearest(in_cells)};
  return {known.cluster, (in_cells - seeds_.seed(known.cluster)).cast<float>()};
}

// The triangle's plane, to the clusters of its corners.
void VertexClusters::gather(const std::array<Corner, 3>& corners, const Vec3& area_vector) {
  const Eigen::Vector3f n = area_vector.normalized().cast<float>();  // zero where that is
  const auto area = static_cast<float>(area_vector.norm() / 2);
  for (const Corner& corner : corners) {
    Cluster& cluster = clusters_[corner.cluster];
    const Eigen::Vector3f weighted = area * n;
    const std::array<float, 6> plane{weighted.x() * n.x(), weighted.x() * n.y(), weighted.x() * n.z(),
                                     weighted.y() * n.y(), weighted.y() * n.z(), weighted.z() * n.z()};
    for (std::size_t i = 0; i < plane.size(); ++i) cluster.planes[i] += plane[i];
    const float height = n.dot(corner.from_seed);
    cluster.pull += weighted * height;
    cluster.squares += area * height * height;
    cluster.sum += corner.from_seed;
    cluster.low = cluster.low.cwiseMin(corner.from_seed);
    cluster.high = cluster.high.cwiseMax(corner.from_seed);
    ++cluster.corners;
  }
}

void VertexClusters::add_image(const std::array<Corner, 3>& corners) {
  const std::uint32_t a = corners[0].cluster, b = corners[1].cluster, c = corners[2].cluster;
  if (a != b && b != c && c != a) {
    facets_.add({a, b, c}, given_);
  } else if (a != b || b != c) {
    const auto [low, high] = std::minmax({a, b, c});
    edges_.push_back({low, high});
  }
}

void VertexClusters::compact_edges() {
  std::ranges::sort(edges_);
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  edges_when_compact_ = edges_.size();
}

// The place nearest to all planes, not far from the seed; but drawn to the mean of the corners by the share of the
// mean's squared distances from the planes that the place has, too. That is nothing on the crease of a clean scan, and
// nearly all where normals are those of noise, which would throw the place about.
Eigen::Vector3f VertexClusters::place(const Cluster& cluster) {
  Eigen::Vector3f mean = cluster.sum / static_cast<float>(cluster.corners);
  const auto& q = cluster.planes;
  const float trace = q[0] + q[3] + q[5];
  if (!(trace > 0)) return mean;
  Eigen::Matrix3f a;
  a << q[0], q[1], q[2], q[1], q[3], q[4], q[2], q[4], q[5];
  const auto squared_distances = [&](const Eigen::Vector3f& x) {
    return std::max(0.0F, cluster.squares - 2 * cluster.pull.dot(x) + x.dot(a * x));
  };
  constexpr float least_stiffness = 1e-3F;  // of a direction that planes leave open
  Eigen::Matrix3f stiff = a;
  stiff.diagonal().array() += least_stiffness * trace;
  const Eigen::Vector3f nearest =
      stiff.ldlt().solve(cluster.pull + least_stiffness * trace * mean).cwiseMax(-1).cwiseMin(1);
  const float of_mean = squared_distances(mean), of_nearest = squared_distances(nearest);
  if (of_nearest >= of_mean) return mean;
  return nearest + of_nearest / of_mean * (mean - nearest);
}

// How far the farthest of the cluster's corners can be from its vertex, in units of cells.
float VertexClusters::reach(const Cluster& cluster, const Eigen::Vector3f& place) {
  constexpr float rounded = 1 + 1e-6F;  // coordinates are, to the 24th bit
  return rounded * (cluster.high - place).cwiseMax(place - cluster.low).norm();
}

// Those that are no part of the thinned surface; edges and points as triangles that name a corner again.
std::vector<Triangle> VertexClusters::lost_images(const std::vector<Facet>& facets) const {
  std::vector<bool> used(clusters_.size(), false);
  std::vector<Edge> sides;
  std::vector<Triangle> lost;
  for (const Facet& facet : facets) {
    const auto& [a, b, c] = facet.corners;
    if (facet.turns == 0) {
      lost.push_back(facet.corners);
      continue;
    }
    used[a] = used[b] = used[c] = true;
    sides.insert(sides.end(), {{a, b}, {b, c}, {a, c}});
  }
  std::ranges::sort(sides);
  for (const Edge& edge : edges_)
    if (!std::ranges::binary_search(sides, edge)) lost.push_back({edge[0], edge[1], edge[1]});
  for (std::uint32_t c = 0; c < used.size(); ++c)
    if (!used[c]) lost.push_back({c, c, c});
  return lost;
}

// Each given triangle has an image: the triangle, edge or point of its clusters' vertices, no point of which is farther
// from that of the triangle with the same barycentric coordinates than the farthest corner is from its cluster's
// vertex, and vice versa. Where an image is no part of the surface, its own distance from that is added.
ThinnedSurface VertexClusters::surface() && {
  facets_.straighten();
  compact_edges();
  std::vector<Vec3> vertices;
  std::vector<double> reaches;  // model units
  vertices.reserve(clusters_.size());
  reaches.reserve(clusters_.size());
  for (std::uint32_t c = 0; c < clusters_.size(); ++c) {
    const Eigen::Vector3f from_seed = clusters_[c].corners > 0 ? place(clusters_[c]) : Eigen::Vector3f::Zero();
    vertices.push_back(seeds_.in_model(seeds_.seed(c) + from_seed.cast<double>()));
    reaches.push_back(seeds_.cell() * static_cast<double>(reach(clusters_[c], from_seed)));
  }
  const double resolution = seeds_.cell() / 8;
  std::vector<Facet> facets = facets_.take();
  const std::vector<Triangle> lost = lost_images(facets);
  *this = VertexClusters(ClusterSeeds({}, 1));

  ThinnedSurface thinned = surface_of(std::move(facets), vertices);
  if (thinned.mesh.triangles.empty()) return thinned;
  const auto farthest = std::ranges::max_element(reaches);
  thinned.largest_distance = *farthest;
  thinned.farthest = vertices[static_cast<std::size_t>(farthest - reaches.begin())];
  if (lost.empty()) return thinned;
  const TriangleTree tree(thinned.mesh);
  for (const Triangle& t : lost) {
    const double moved = std::max({reaches[t[0]], reaches[t[1]], reaches[t[2]]});
    const double bound = moved + bound_of_distance({vertices[t[0]], vertices[t[1]], vertices[t[2]]}, tree,
                                                   thinned.largest_distance - moved, resolution);
    if (bound <= thinned.largest_distance) continue;
    thinned.largest_distance = bound;
    thinned.farthest = vertices[t[0]];
  }
  return thinned;
}

}  // namespace scan2fea
