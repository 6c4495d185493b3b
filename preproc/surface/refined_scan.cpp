#include "preproc/surface/refined_scan.hpp"

#include "preproc/surface/spatial_order.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace scan2fea {
namespace {

// More vertices than this times the old ones: the new ones, at the end, are then ordered anew.
constexpr double most_growth = 1.3;

using EdgeKey = std::uint64_t;  // its two vertices, the smaller one in the upper half

EdgeKey edge_key(std::uint32_t a, std::uint32_t b) {
  const auto [low, high] = std::minmax(a, b);
  return (EdgeKey{low} << 32) | high;
}

// One pass over the triangles that the last pass made. Returns those that this pass made.
class Halving {
 public:
  Halving(SurfaceMesh& mesh, std::vector<double>& edge_length, double limit)
      : mesh_(mesh), edge_length_(edge_length), limit_(limit) {}

  std::vector<std::uint32_t> pass(const std::vector<std::uint32_t>& active) {
    collect_long_edges(active);
    first_middle_ = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (const EdgeKey key : long_) {
      const auto a = static_cast<std::size_t>(key >> 32), b = static_cast<std::size_t>(key & 0xffffffffU);
      mesh_.vertices.push_back(0.5 * (mesh_.vertices[a] + mesh_.vertices[b]));
      edge_length_.push_back(0.5 * (edge_length_[a] + edge_length_[b]));
    }
    std::vector<std::uint32_t> made;
    if (!long_.empty())
      for (const std::uint32_t f : active) split(f, made);
    return made;
  }

 private:
  bool is_long(std::uint32_t a, std::uint32_t b) const {
    const double most = limit_ * 0.5 * (edge_length_[a] + edge_length_[b]);
    return (mesh_.vertices[a] - mesh_.vertices[b]).squaredNorm() > most * most;
  }

  void collect_long_edges(const std::vector<std::uint32_t>& active) {
    long_.clear();
    for (const std::uint32_t f : active) {
      const Triangle& t = mesh_.triangles[f];
      for (std::size_t k = 0; k < 3; ++k)
        if (is_long(t[k], t[(k + 1) % 3])) long_.push_back(edge_key(t[k], t[(k + 1) % 3]));
    }
    std::sort(long_.begin(), long_.end());
    long_.erase(std::unique(long_.begin(), long_.end()), long_.end());
  }

  std::uint32_t middle(std::uint32_t a, std::uint32_t b) const {
    const auto at = std::lower_bound(long_.begin(), long_.end(), edge_key(a, b));
    return first_middle_ + static_cast<std::uint32_t>(at - long_.begin());
  }

  void put(std::uint32_t f, const Triangle& t, std::vector<std::uint32_t>& made) {
    mesh_.triangles[f] = t;
    made.push_back(f);
  }
  void add(const Triangle& t, std::vector<std::uint32_t>& made) {
    mesh_.triangles.push_back(t);
    made.push_back(static_cast<std::uint32_t>(mesh_.triangles.size() - 1));
  }

  void split(std::uint32_t f, std::vector<std::uint32_t>& made) {
    Triangle t = mesh_.triangles[f];
    std::array<bool, 3> halved{};
    for (std::size_t k = 0; k < 3; ++k) halved[k] = is_long(t[k], t[(k + 1) % 3]);
    const auto count = halved[0] + halved[1] + halved[2];
    if (count == 0) return;
    // Turn the triangle until its first edge is halved and, of two, the second one too.
    while (!halved[0] || (count == 2 && !halved[1])) {
      std::rotate(t.begin(), t.begin() + 1, t.end());
      std::rotate(halved.begin(), halved.begin() + 1, halved.end());
    }
    const auto [a, b, c] = t;
    const std::uint32_t ab = middle(a, b);
    if (count == 1) {
      put(f, {a, ab, c}, made);
      add({ab, b, c}, made);
      return;
    }
    const std::uint32_t bc = middle(b, c);
    put(f, {ab, b, bc}, made);
    if (count == 3) {
      const std::uint32_t ca = middle(c, a);
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
  std::vector<double>& edge_length_;
  double limit_;
  std::vector<EdgeKey> long_;
  std::uint32_t first_middle_ = 0;
};

}  // namespace

RefinedScan refine_scan(SurfaceMesh scan, const SizingField& sizing, double limit, int passes) {
  const std::size_t scan_vertices = scan.vertices.size();
  RefinedScan result{.mesh = std::move(scan), .edge_length = sizing.edge_length, .scan_vertex_at = {}};
  Halving halving(result.mesh, result.edge_length, limit);
  std::vector<std::uint32_t> active(result.mesh.triangles.size());
  for (std::uint32_t f = 0; f < active.size(); ++f) active[f] = f;
  for (int i = 0; i < passes && !active.empty(); ++i) active = halving.pass(active);

  result.scan_vertex_at.resize(scan_vertices);
  std::iota(result.scan_vertex_at.begin(), result.scan_vertex_at.end(), 0U);
  if (static_cast<double>(result.mesh.vertices.size()) > most_growth * static_cast<double>(scan_vertices)) {
    const std::vector<std::uint32_t> place = order_along_curve(result.mesh);
    std::vector<double> edge_length(place.size());
    for (std::size_t v = 0; v < place.size(); ++v) edge_length[place[v]] = result.edge_length[v];
    result.edge_length = std::move(edge_length);
    result.scan_vertex_at.assign(place.begin(), place.begin() + static_cast<std::ptrdiff_t>(scan_vertices));
  }
  return result;
}

}  // namespace scan2fea
