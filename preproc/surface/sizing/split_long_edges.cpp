#include "preproc/surface/sizing/split_long_edges.hpp"

#include "preproc/surface/kernel/spatial_order.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace scan2fea {
namespace {

// More vertices than this times the old ones: the new ones, at the end, are then ordered anew.
constexpr double most_growth_of_scan = 1.3;

using EdgeKey = std::uint64_t;  // its two vertices, the smaller one in the upper half

EdgeKey edge_key(std::uint32_t a, std::uint32_t b) {
  const auto [low, high] = std::minmax(a, b);
  return (EdgeKey{low} << 32) | high;
}

// Parts triangles at new vertices on their edges.
class EdgeSplitter {
 public:
  EdgeSplitter(SurfaceMesh& mesh, std::vector<FeatureEdge>& features) : mesh_(mesh), features_(features) {}

  // `keys`: sorted; the vertex on each is in `vertices`. Returns the triangles that were made of `active`.
  std::vector<std::uint32_t> split(const std::vector<EdgeKey>& keys, std::vector<std::uint32_t> vertices,
                                   const std::vector<std::uint32_t>& active) {
    keys_ = &keys;
    vertices_ = std::move(vertices);
    std::vector<std::uint32_t> made;
    if (keys.empty()) return made;
    at_end_.assign(mesh_.vertices.size(), false);
    for (const EdgeKey key : keys) at_end_[key >> 32] = at_end_[key & 0xffffffffU] = true;
    for (const std::uint32_t f : active) split_triangle(f, made);
    const std::size_t features = features_.size();
    for (std::size_t i = 0; i < features; ++i) {
      const auto [a, b] = features_[i];
      const std::uint32_t m = vertex_on(a, b);
      if (m == none) continue;
      features_[i] = feature_edge(a, m);
      features_.push_back(feature_edge(m, b));
    }
    return made;
  }

 private:
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  std::uint32_t vertex_on(std::uint32_t a, std::uint32_t b) const {
    if (!at_end_[a] || !at_end_[b]) return none;  // most edges: the search is for the others
    const EdgeKey key = edge_key(a, b);
    const auto at = std::lower_bound(keys_->begin(), keys_->end(), key);
    return at == keys_->end() || *at != key ? none : vertices_[static_cast<std::size_t>(at - keys_->begin())];
  }

  void put(std::uint32_t f, const Triangle& t, std::vector<std::uint32_t>& made) {
    mesh_.triangles[f] = t;
    made.push_back(f);
  }
  void add(const Triangle& t, std::vector<std::uint32_t>& made) {
    mesh_.triangles.push_back(t);
    made.push_back(static_cast<std::uint32_t>(mesh_.triangles.size() - 1));
  }

  void split_triangle(std::uint32_t f, std::vector<std::uint32_t>& made) {
    Triangle t = mesh_.triangles[f];
    Triangle on{vertex_on(t[0], t[1]), vertex_on(t[1], t[2]), vertex_on(t[2], t[0])};
    const auto count = 3 - std::count(on.begin(), on.end(), none);
    if (count == 0) return;
    // Turn the triangle until its first edge is split and, of two, the second one too.
    while (on[0] == none || (count == 2 && on[1] == none)) {
      std::rotate(t.begin(), t.begin() + 1, t.end());
      std::rotate(on.begin(), on.begin() + 1, on.end());
    }
    const auto [a, b, c] = t;
    const auto [ab, bc, ca] = on;
    if (count == 1) {
      put(f, {a, ab, c}, made);
      add({ab, b, c}, made);
      return;
    }
    put(f, {ab, b, bc}, made);
    if (count == 3) {
      add({a, ab, ca}, made);
      add({c, ca, bc}, made);
      add({ab, bc, ca}, made);
      return;
    }
    const std::vector<Vec3>& x = mesh_.vertices;
    if ((x[ab] - x[c]).squaredNorm() < (x[bc] - x[a]).squaredNorm()) {
      add({a, ab, c}, made);
      add({ab, bc, c}, made);
    } else {
      add({a, ab, bc}, made);
      add({a, bc, c}, made);
    }
  }

  SurfaceMesh& mesh_;
  std::vector<FeatureEdge>& features_;
  std::vector<bool> at_end_;  // of a split edge
  const std::vector<EdgeKey>* keys_ = nullptr;
  std::vector<std::uint32_t> vertices_;
};

std::vector<EdgeKey> long_edges(const SurfaceMesh& mesh, const std::vector<double>& edge_length,
                                const std::vector<FeatureEdge>& features, double limit, double feature_limit,
                                const std::vector<std::uint32_t>& active) {
  const auto is_long = [&](std::uint32_t a, std::uint32_t b, double part) {
    const double most = part * 0.5 * (edge_length[a] + edge_length[b]);
    return (mesh.vertices[a] - mesh.vertices[b]).squaredNorm() > most * most;
  };
  std::vector<EdgeKey> found;
  for (const std::uint32_t f : active) {
    const Triangle& t = mesh.triangles[f];
    for (std::size_t k = 0; k < 3; ++k)
      if (is_long(t[k], t[(k + 1) % 3], limit)) found.push_back(edge_key(t[k], t[(k + 1) % 3]));
  }
  for (const auto& [a, b] : features)
    if (is_long(a, b, feature_limit)) found.push_back(edge_key(a, b));
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::vector<std::uint32_t> consecutive(std::size_t first, std::size_t count) {
  std::vector<std::uint32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), static_cast<std::uint32_t>(first));
  return numbers;
}

}  // namespace

void halve_long_edges(SurfaceMesh& mesh, std::vector<double>& edge_length, std::vector<FeatureEdge>& features,
                      double limit, double feature_limit, int passes) {
  EdgeSplitter splitter(mesh, features);
  std::vector<std::uint32_t> active = consecutive(0, mesh.triangles.size());
  for (int pass = 0; pass < passes && !active.empty(); ++pass) {
    const std::vector<EdgeKey> keys = long_edges(mesh, edge_length, features, limit, feature_limit, active);
    const std::size_t first = mesh.vertices.size();
    for (const EdgeKey key : keys) {
      const auto a = static_cast<std::size_t>(key >> 32), b = static_cast<std::size_t>(key & 0xffffffffU);
      mesh.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
      edge_length.push_back(0.5 * (edge_length[a] + edge_length[b]));
    }
    active = splitter.split(keys, consecutive(first, keys.size()), active);
  }
}

void split_edges(SurfaceMesh& mesh, std::vector<double>& edge_length, std::vector<FeatureEdge>& features,
                 const std::vector<EdgeSplit>& splits) {
  std::vector<std::pair<EdgeKey, std::uint32_t>> entries;
  for (const auto& [edge, part] : splits) {
    const auto [a, b] = edge;
    entries.emplace_back(edge_key(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
    mesh.vertices.push_back((1 - part) * mesh.vertices[a] + part * mesh.vertices[b]);
    edge_length.push_back((1 - part) * edge_length[a] + part * edge_length[b]);
  }
  std::sort(entries.begin(), entries.end());
  std::vector<EdgeKey> keys;
  std::vector<std::uint32_t> vertices;
  for (const auto& [key, vertex] : entries) {
    keys.push_back(key);
    vertices.push_back(vertex);
  }
  EdgeSplitter(mesh, features).split(keys, std::move(vertices), consecutive(0, mesh.triangles.size()));
}

std::vector<std::uint32_t> order_along_curve(SurfaceMesh& mesh, std::vector<double>& edge_length) {
  std::vector<std::uint32_t> place = order_along_curve(mesh);
  std::vector<double> ordered(place.size());
  for (std::size_t v = 0; v < place.size(); ++v) ordered[place[v]] = edge_length[v];
  edge_length = std::move(ordered);
  return place;
}

RefinedScan refine_scan(SurfaceMesh scan, const SizingField& sizing, double limit, int passes) {
  const std::size_t scan_vertices = scan.vertices.size();
  RefinedScan result{.mesh = std::move(scan), .edge_length = sizing.edge_length, .scan_vertex_at = {}};
  std::vector<FeatureEdge> no_features;
  halve_long_edges(result.mesh, result.edge_length, no_features, limit, limit, passes);
  result.scan_vertex_at = consecutive(0, scan_vertices);
  if (static_cast<double>(result.mesh.vertices.size()) > most_growth_of_scan * static_cast<double>(scan_vertices)) {
    std::vector<std::uint32_t> place = order_along_curve(result.mesh, result.edge_length);
    place.resize(scan_vertices);
    result.scan_vertex_at = std::move(place);
  }
  return result;
}

}  // namespace scan2fea
