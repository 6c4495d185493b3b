#include "preproc/surface/features/feature_curves.hpp"

#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

namespace scan2fea {
namespace {

// Where a curve turns to and fro, what it turns from vertex to vertex adds up to more than this times what it turns
// between the ends of its reach. On an arc that is 2, at a corner 1.
constexpr double jagged_turning = 2.5;

struct Edge {
  std::uint32_t from;
  std::uint32_t to;
  bool border;
};

std::vector<Edge> collect_edges(const std::vector<FeatureEdge>& sharp, const std::vector<FeatureEdge>& border) {
  std::vector<Edge> edges;
  edges.reserve(sharp.size() + border.size());
  for (const auto& [a, b] : sharp) edges.push_back({a, b, false});
  for (const auto& [a, b] : border) edges.push_back({a, b, true});
  return edges;
}

// The edges at each vertex, ascending.
class EdgeStars {
 public:
  EdgeStars(std::size_t vertices, const std::vector<Edge>& edges) : first_(vertices + 1, 0) {
    for (const Edge& e : edges) {
      ++first_[e.from + 1];
      ++first_[e.to + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    edges_.resize(2 * edges.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < edges.size(); ++i) {
      edges_[next[edges[i].from]++] = i;
      edges_[next[edges[i].to]++] = i;
    }
  }

  std::span<const std::uint32_t> at(std::uint32_t v) const {
    return {edges_.data() + first_[v], first_[v + 1] - first_[v]};
  }

 private:
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> edges_;
};

// Follows edges from corner to corner, and then around the loops that have none.
class Tracer {
 public:
  Tracer(const std::vector<Edge>& edges, const EdgeStars& stars, const std::vector<char>& is_corner)
      : edges_(edges), stars_(stars), is_corner_(is_corner), used_(edges.size(), 0) {}

  std::vector<FeatureCurve> trace() {
    std::vector<FeatureCurve> curves;
    for (std::uint32_t i = 0; i < edges_.size(); ++i) {
      const Edge& e = edges_[i];
      if (!used_[i] && is_corner_[e.from]) curves.push_back(follow(e.from, i));
      if (!used_[i] && is_corner_[e.to]) curves.push_back(backwards(follow(e.to, i)));
    }
    for (std::uint32_t i = 0; i < edges_.size(); ++i)
      if (!used_[i]) curves.push_back(follow(edges_[i].from, i));
    return curves;
  }

 private:
  FeatureCurve follow(std::uint32_t start, std::uint32_t edge) {
    FeatureCurve curve{.vertices = {start}, .closed = false, .border = edges_[edge].border};
    std::uint32_t v = start;
    while (true) {
      used_[edge] = 1;
      v = edges_[edge].from == v ? edges_[edge].to : edges_[edge].from;
      if (v == start && !is_corner_[v]) {
        curve.closed = true;
        return curve;
      }
      curve.vertices.push_back(v);
      if (is_corner_[v]) return curve;
      const auto both = stars_.at(v);
      edge = both[0] == edge ? both[1] : both[0];
    }
  }

  static FeatureCurve backwards(FeatureCurve curve) {
    std::reverse(curve.vertices.begin(), curve.vertices.end());
    return curve;
  }

  const std::vector<Edge>& edges_;
  const EdgeStars& stars_;
  const std::vector<char>& is_corner_;
  std::vector<char> used_;
};

double turn_deg(const Vec3& before, const Vec3& after) {
  return angle_between(before, after) * (180 / std::numbers::pi);
}

// One traced curve, by arc length.
class TurnsOfCurve {
 public:
  TurnsOfCurve(const std::vector<Vec3>& points, const FeatureCurve& curve, const std::vector<double>& edge_length)
      : points_(points), curve_(curve), edge_length_(edge_length), arc_{0} {
    for (std::size_t i = 0; i + 1 < curve.vertices.size(); ++i)
      arc_.push_back(arc_.back() + (at(i + 1) - at(i)).norm());
    const std::size_t n = curve.vertices.size();
    total_ = arc_.back() + (curve.closed ? (at(0) - at(n - 1)).norm() : 0);
    for (std::size_t i = 0; i < n; ++i) {
      const bool end = !curve.closed && (i == 0 || i + 1 == n);
      turns_.push_back(end ? 0 : turn_deg(at(i) - at((i + n - 1) % n), at((i + 1) % n) - at(i)));
    }
  }

  // Vertices where it turns by more than the options allow, none nearer to another than the reach.
  std::vector<std::uint32_t> corners(const CornerOptions& options) const {
    struct Candidate {
      double turn;
      std::size_t index;
    };
    std::vector<Candidate> candidates;
    const std::size_t inner_first = curve_.closed ? 0 : 1;
    const std::size_t inner_last = curve_.vertices.size() - (curve_.closed ? 0 : 1);
    for (std::size_t i = inner_first; i < inner_last; ++i) {
      const double wide = turn_at(i, options.reach);
      if (wide <= options.turn_deg) continue;
      // A bend that half the reach does not see is spread out: a curve finer than the edges, and no corner.
      const bool sharp = turn_at(i, options.reach / 2) > 0.75 * wide;
      const bool jagged = turning_around(i, options.reach) > jagged_turning * wide;
      if (jagged ? turn_at(i, options.jagged_reach) > options.jagged_turn_deg : sharp) candidates.push_back({wide, i});
    }
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
      return a.turn != b.turn ? a.turn > b.turn : a.index < b.index;
    });
    std::vector<std::size_t> chosen;
    for (const Candidate& c : candidates) {
      const double distance = options.reach * edge_length_[curve_.vertices[c.index]];
      const bool clear = std::all_of(chosen.begin(), chosen.end(),
                                     [&](std::size_t other) { return arc_distance(c.index, other) > distance; });
      if (clear) chosen.push_back(c.index);
    }
    std::vector<std::uint32_t> vertices;
    for (const std::size_t i : chosen) vertices.push_back(curve_.vertices[i]);
    return vertices;
  }

 private:
  const Vec3& at(std::size_t i) const { return points_[curve_.vertices[i]]; }

  double arc_distance(std::size_t i, std::size_t j) const {
    const double d = std::abs(arc_[i] - arc_[j]);
    return curve_.closed ? std::min(d, total_ - d) : d;
  }

  // The point at this arc length; beyond the ends of an open curve, its ends.
  Vec3 point(double s) const {
    const std::size_t n = curve_.vertices.size();
    if (curve_.closed) {
      s -= total_ * std::floor(s / total_);
    } else if (s <= 0 || s >= total_) {
      return s <= 0 ? at(0) : at(n - 1);
    }
    const auto after = static_cast<std::size_t>(std::upper_bound(arc_.begin(), arc_.end(), s) - arc_.begin());
    const std::size_t i = after - 1;
    const double end = after < n ? arc_[after] : total_;
    const double t = end > arc_[i] ? std::min(1.0, (s - arc_[i]) / (end - arc_[i])) : 0;
    return (1 - t) * at(i) + t * at(after % n);
  }

  double turn_at(std::size_t i, double reach) const {
    const double h = reach * edge_length_[curve_.vertices[i]];
    return turn_deg(at(i) - point(arc_[i] - h), point(arc_[i] + h) - at(i));
  }

  // What it turns from vertex to vertex, added up over this reach to either side.
  double turning_around(std::size_t i, double reach) const {
    const std::size_t n = curve_.vertices.size();
    const double h = std::min(reach * edge_length_[curve_.vertices[i]], 0.49 * total_);
    double sum = turns_[i];
    for (std::size_t k = 1; k < n; ++k) {
      const std::size_t j = curve_.closed ? (i + k) % n : i + k;
      if (j >= n || arc_distance(i, j) > h) break;
      sum += turns_[j];
    }
    for (std::size_t k = 1; k < n; ++k) {
      if (!curve_.closed && k > i) break;
      const std::size_t j = (i + n - k) % n;
      if (arc_distance(i, j) > h) break;
      sum += turns_[j];
    }
    return sum;
  }

  const std::vector<Vec3>& points_;
  const FeatureCurve& curve_;
  const std::vector<double>& edge_length_;
  std::vector<double> arc_;    // at each vertex, from the first
  std::vector<double> turns_;  // at each vertex, degrees
  double total_;
};

}  // namespace

FeatureCurves trace_feature_curves(const std::vector<Vec3>& points, const std::vector<FeatureEdge>& sharp,
                                   const std::vector<FeatureEdge>& border, const std::vector<double>& edge_length,
                                   const CornerOptions& options) {
  const std::vector<Edge> edges = collect_edges(sharp, border);
  const EdgeStars stars(points.size(), edges);
  std::vector<char> is_corner(points.size(), 0);
  for (std::uint32_t v = 0; v < is_corner.size(); ++v) {
    const auto at = stars.at(v);
    // Where a crease goes on as a border, the curve changes its kind.
    is_corner[v] = !at.empty() && (at.size() != 2 || edges[at[0]].border != edges[at[1]].border);
  }
  for (const FeatureCurve& curve : Tracer(edges, stars, is_corner).trace())
    for (const std::uint32_t v : TurnsOfCurve(points, curve, edge_length).corners(options)) is_corner[v] = 1;

  FeatureCurves result{.curves = Tracer(edges, stars, is_corner).trace(), .corners = {}};
  for (std::uint32_t v = 0; v < is_corner.size(); ++v)
    if (is_corner[v]) result.corners.push_back(v);
  return result;
}

}  // namespace scan2fea
