#include "preproc/surface/features/match_features.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/cut_surface.hpp"
#include "preproc/surface/kernel/nearest.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <queue>

namespace scan2fea {
namespace {

struct Segment {
  Vec3 from;
  Vec3 to;

  double distance(const Vec3& p) const {
    const Vec3 d = to - from;
    const double dd = d.squaredNorm();
    const double t = dd > 0 ? std::clamp(d.dot(p - from) / dd, 0.0, 1.0) : 0;
    return (p - from - t * d).norm();
  }
};

// The way from one vertex to another by edges whose ends are no farther than `tolerance` from the line (Dijkstra);
// length counts more the farther it is. Empty where there is none.
std::vector<std::uint32_t> shortest_way(const SurfaceMesh& scan, const VertexStars& stars, const Segment& line,
                                        std::uint32_t from, std::uint32_t to, double tolerance) {
  struct Reached {
    double cost;
    std::uint32_t vertex;
    bool operator<(const Reached& other) const {
      return cost != other.cost ? cost > other.cost : vertex > other.vertex;
    }
  };
  struct Best {
    double cost;
    std::uint32_t before;
  };
  constexpr double penalty = 10;  // for what runs at the tolerance
  std::priority_queue<Reached> queue;
  std::map<std::uint32_t, Best> best;
  queue.push({0, from});
  best[from] = {0, from};
  while (!queue.empty()) {
    const Reached at = queue.top();
    queue.pop();
    if (at.vertex == to) break;
    if (at.cost > best.at(at.vertex).cost) continue;
    for (const std::uint32_t corner : stars.corners(at.vertex))
      for (const std::uint32_t w : scan.triangles[corner / 3]) {
        const double distance = line.distance(scan.vertices[w]);
        if (w == at.vertex || (w != to && distance > tolerance)) continue;
        const Vec3 middle = 0.5 * (scan.vertices[w] + scan.vertices[at.vertex]);
        const double off = (distance + line.distance(middle)) / tolerance;
        const double cost = at.cost + (scan.vertices[w] - scan.vertices[at.vertex]).norm() * (1 + penalty * off * off);
        const auto [known, added] = best.try_emplace(w, Best{cost, at.vertex});
        if (!added && cost >= known->second.cost) continue;
        known->second = {cost, at.vertex};
        queue.push({cost, w});
      }
  }
  if (!best.contains(to)) return {};
  std::vector<std::uint32_t> way{to};
  while (way.back() != from) way.push_back(best.at(way.back()).before);
  return way;
}

[[noreturn]] void fail(const SurfaceMesh& scan, const Vec3& place, double distance, double limit) {
  const double percent = 100 / bounding_box(scan.vertices).diagonal();
  throw InvalidInput({.what = "a feature line is not near edges of the scan",
                      .where = {},
                      .value = "distance " + error_text(percent * distance) + " % of its diagonal",
                      .limit = error_text(percent * limit) + " %",
                      .advice = "lines in the scan's coordinates and unit",
                      .at = place});
}

}  // namespace

std::vector<FeatureEdge> match_features(const SurfaceMesh& scan, const VertexStars& stars, const FeatureLines& lines,
                                        const MatchOptions& options) {
  if (lines.segments.empty()) return {};
  const double tolerance = options.farthest_of_diagonal * bounding_box(scan.vertices).diagonal();
  const std::vector<Vec3> no_normals(lines.points.size(), Vec3::Zero());
  const std::vector<std::uint32_t> nearest = nearest_vertices(lines.points, no_normals, scan, 0);
  std::vector<FeatureEdge> edges;
  for (const auto& [from, to] : lines.segments) {
    const Segment line{lines.points[from], lines.points[to]};
    for (const std::uint32_t point : {from, to}) {
      const double distance = (lines.points[point] - scan.vertices[nearest[point]]).norm();
      if (distance > tolerance) fail(scan, lines.points[point], distance, tolerance);
    }
    const auto way = shortest_way(scan, stars, line, nearest[from], nearest[to], tolerance);
    if (way.empty()) fail(scan, 0.5 * (line.from + line.to), std::numeric_limits<double>::infinity(), tolerance);
    for (std::size_t i = 0; i + 1 < way.size(); ++i) {
      const auto [low, high] = std::minmax(way[i], way[i + 1]);
      edges.push_back({low, high});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());

  const std::vector<FeatureEdge> border = boundary_edges(scan);
  std::erase_if(edges, [&](const FeatureEdge& e) { return std::binary_search(border.begin(), border.end(), e); });
  return edges;
}

}  // namespace scan2fea
