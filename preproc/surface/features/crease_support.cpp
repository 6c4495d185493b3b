#include "preproc/surface/features/crease_support.hpp"

#include "preproc/mesh/union_find.hpp"
#include "preproc/surface/kernel/components.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

namespace scan2fea {
namespace {

// The largest sum of the figures of a crease. The worst of some 400 networks of parts is at 0.19 (small holes in a
// shaft, coarsely sampled), the best long ones of organic scans at 0.25.
constexpr double most_of_crease = 0.2;

// Folds run out where parts' creases meet others or close: where a network has two free ends in less than half a
// diagonal, it must be twice as clean, and noise is no excuse.
constexpr double free_ends_per_diagonal = 4;
constexpr double most_where_running_out = 0.1;

// What noise adds to the figures, from fandisk, a cylinder, a cube, a coin and plates at 0.05 to 0.2 %: `tilt` is the
// standard deviation of an edge's angle over the angle, `shift` that of a vertex over the length of an edge. With a
// larger tilt a crease cannot be told from noise.
constexpr double spread_of_tilt = 0.8, unevenness_of_tilt = 1.3, drift_of_tilt = 0.65, zigzag_of_shift = 2.3;
constexpr double largest_tilt = 0.45;

// The drift compares the mean angles of stretches of so many edges, over which noise falls to half. Of what noise does
// not account for, parts with noise have up to 0.08, organic scans whose other figures are like noise's 0.1 to 0.3.
constexpr std::size_t stretch = 4;
constexpr double most_drift = 0.1;

// It must be known in this part of a network's length, or else the sum of the figures must be small: parts with many
// corners have too short chains for it.
constexpr double least_with_drift = 0.4;
constexpr double most_unchecked = 0.35;

// A triangle or two that lie folded over their neighbours have no more edges, and turn by more; their sides are single
// faces, of which anything is smooth. The sharp edge of a wedge is longer.
constexpr std::size_t most_edges_of_flap = 6;
constexpr double least_turn_of_flap = 0.75 * std::numbers::pi;
// Where a line of a part bends sharply, the face on one side of it does, too, and that edge is sharp as well. Few edges
// without an end, whose line bends sharply where no third one meets it, are a flap of some more triangles. At this turn
// and bend the face would bend by 40 degrees.
constexpr std::size_t most_edges_of_ring = 7;
constexpr double least_turn_of_ring = std::numbers::pi / 3, least_bend_of_ring = 0.25 * std::numbers::pi;

// Figures count up to this, so that some wild edges do not spoil a long crease.
constexpr double most_counted = 1;

struct EdgeFigures {
  std::array<std::uint32_t, 2> ends{};
  double length = 0;                       // model units
  double angle = 0, spread = 0, tilt = 0;  // radians
};

class EdgeMeasures {
 public:
  EdgeMeasures(const CreaseSurface& surface, std::span<const FeatureEdge> sharp)
      : s_(surface), sharp_(sharp), at_end_(surface.scan.vertices.size(), 0) {
    for (const FeatureEdge& e : sharp)
      for (const std::uint32_t v : e) at_end_[v] = 1;
  }

  std::vector<EdgeFigures> measure() const {
    std::vector<EdgeFigures> figures(sharp_.size());
    for (std::uint32_t f = 0; f < s_.scan.triangles.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t g = s_.neighbours[f][k];
        if (g == no_face || g < f) continue;
        const FeatureEdge edge = opposite(f, k);
        if (const auto i = index(edge)) figures[*i] = measure(edge, f, g);
      }
    return figures;
  }

 private:
  FeatureEdge opposite(std::uint32_t f, std::size_t k) const {
    const Triangle& t = s_.scan.triangles[f];
    return feature_edge(t[(k + 1) % 3], t[(k + 2) % 3]);
  }
  double length(const FeatureEdge& e) const { return (s_.scan.vertices[e[0]] - s_.scan.vertices[e[1]]).norm(); }
  double height(std::uint32_t f, double base) const { return area_vector(s_.scan, s_.scan.triangles[f]).norm() / base; }
  std::optional<std::size_t> index(const FeatureEdge& e) const {
    if (!at_end_[e[0]] || !at_end_[e[1]]) return {};
    const auto at = std::lower_bound(sharp_.begin(), sharp_.end(), e);
    return at != sharp_.end() && *at == e ? std::optional(static_cast<std::size_t>(at - sharp_.begin())) : std::nullopt;
  }

  EdgeFigures measure(const FeatureEdge& e, std::uint32_t f, std::uint32_t g) const {
    const Vec3 along = s_.scan.vertices[e[1]] - s_.scan.vertices[e[0]];
    const double base = along.norm();
    // Moving an apex by the noise changes the angle by that over the height; both ends of the edge about double this.
    const double tilt = s_.noise * std::sqrt(2.0) * std::hypot(1 / height(f, base), 1 / height(g, base));
    return {.ends = e,
            .length = base,
            .angle = angle_between(s_.normals[f], s_.normals[g]),
            .spread = (turn_beside(e, f, along / base) + turn_beside(e, g, along / base)) / 2,
            .tilt = tilt};
  }

  // How far the surface turns about the edge's direction at the other edges of a face beside it, those that are sharp
  // themselves aside. The facets of a cylinder turn about its axis, which a rim is across: they do not count.
  double turn_beside(const FeatureEdge& e, std::uint32_t f, const Vec3& along) const {
    double turn = 0, weight = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t g = s_.neighbours[f][k];
      const FeatureEdge edge = opposite(f, k);
      if (g == no_face || edge == e || index(edge)) continue;
      const Vec3 &m = s_.normals[f], &n = s_.normals[g];
      const double cosine = m.dot(n) - m.dot(along) * n.dot(along);
      turn += length(edge) * std::abs(std::atan2(m.cross(n).dot(along), cosine));
      weight += length(edge);
    }
    return weight > 0 ? turn / weight : 0;
  }

  const CreaseSurface& s_;
  std::span<const FeatureEdge> sharp_;
  std::vector<char> at_end_;
};

// A vertex where two sharp edges meet and no third.
struct Joint {
  std::array<std::uint32_t, 2> edges;
  Vec3 turn;  // of the line from the first edge to the second: its axis, as long as the angle
};

class CreaseNetworks {
 public:
  CreaseNetworks(const SurfaceMesh& scan, const std::vector<EdgeFigures>& edges) : edges_(edges), sets_(edges.size()) {
    std::map<std::uint32_t, std::vector<std::uint32_t>> stars;
    for (std::uint32_t i = 0; i < edges.size(); ++i)
      for (const std::uint32_t v : edges[i].ends) stars[v].push_back(i);
    for (const auto& [v, star] : stars) {
      for (const std::uint32_t e : star) sets_.unite(star.front(), e);
      if (star.size() == 1) ends_.push_back({v, star[0]});
      if (star.size() == 2) joints_.emplace(v, Joint{{star[0], star[1]}, turn_at(scan, v, star)});
    }
  }

  struct End {
    std::uint32_t vertex, edge;
  };

  std::uint32_t of(std::uint32_t edge) { return sets_.find(edge); }
  const std::map<std::uint32_t, Joint>& joints() const { return joints_; }
  const std::vector<End>& ends() const { return ends_; }

  // Of the turns at both ends of an edge, what the one takes back of the other.
  double zigzag(std::uint32_t edge) const {
    const auto first = joints_.find(edges_[edge].ends[0]), second = joints_.find(edges_[edge].ends[1]);
    if (first == joints_.end() || second == joints_.end()) return 0;
    const Vec3 before = first->second.edges[1] == edge ? first->second.turn : Vec3(-first->second.turn);
    const Vec3 after = second->second.edges[0] == edge ? second->second.turn : Vec3(-second->second.turn);
    return (before.norm() + after.norm() - (before + after).norm()) / 2;
  }

  // The edges from joint to joint in their order; a loop begins anywhere.
  std::vector<std::vector<std::uint32_t>> chains() const {
    std::vector<char> seen(edges_.size(), 0);
    std::vector<std::vector<std::uint32_t>> chains;
    for (std::uint32_t seed = 0; seed < edges_.size(); ++seed) {
      if (seen[seed]) continue;
      seen[seed] = 1;
      std::vector<std::uint32_t> chain = onwards(seed, edges_[seed].ends[0], seen);
      std::reverse(chain.begin(), chain.end());
      chain.push_back(seed);
      const std::vector<std::uint32_t> rest = onwards(seed, edges_[seed].ends[1], seen);
      chain.insert(chain.end(), rest.begin(), rest.end());
      chains.push_back(std::move(chain));
    }
    return chains;
  }

 private:
  std::uint32_t other_end(std::uint32_t e, std::uint32_t v) const {
    return edges_[e].ends[0] == v ? edges_[e].ends[1] : edges_[e].ends[0];
  }

  Vec3 turn_at(const SurfaceMesh& scan, std::uint32_t v, const std::vector<std::uint32_t>& star) const {
    const Vec3 in = scan.vertices[v] - scan.vertices[other_end(star[0], v)];
    const Vec3 out = scan.vertices[other_end(star[1], v)] - scan.vertices[v];
    const Vec3 axis = in.cross(out);
    return axis.isZero() ? Vec3(Vec3::Zero()) : Vec3(axis.normalized() * angle_between(in, out));
  }

  std::vector<std::uint32_t> onwards(std::uint32_t edge, std::uint32_t v, std::vector<char>& seen) const {
    std::vector<std::uint32_t> chain;
    for (auto joint = joints_.find(v); joint != joints_.end(); joint = joints_.find(v)) {
      const auto& [a, b] = joint->second.edges;
      edge = a == edge ? b : a;
      if (seen[edge]) break;
      seen[edge] = 1;
      chain.push_back(edge);
      v = other_end(edge, v);
    }
    return chain;
  }

  const std::vector<EdgeFigures>& edges_;
  UnionFind sets_;
  std::vector<End> ends_;
  std::map<std::uint32_t, Joint> joints_;
};

// Over lengths.
struct Mean {
  double sum = 0, weight = 0;
  void add(double value, double length) {
    sum += length * std::min(value, most_counted);
    weight += length;
  }
  double value() const { return weight > 0 ? sum / weight : 0; }
};

struct NetworkFigures {
  Mean spread, unevenness, zigzag, drift, tilt;
  double length = 0, angle = 0;  // the angle times the length, summed
  double bend = 0;               // of the line at its joints, summed
  std::size_t edges = 0, ends = 0, free_ends = 0, joints = 0;
  std::uint32_t vertex = 0;  // one of its own
  Vec3 place = Vec3::Zero();
};

double ratio(double part, double whole) {
  return whole > 0 ? part / whole : most_counted;
}

double change(double a, double b) {
  return ratio(2 * std::abs(a - b), a + b);
}

// What is left of a figure when independent noise is taken off it.
double beyond(double figure, double of_noise) {
  return std::sqrt(std::max(0.0, figure * figure - of_noise * of_noise));
}

bool is_flap(const NetworkFigures& net) {
  if (net.edges <= most_edges_of_flap && net.angle > least_turn_of_flap * net.length) return true;
  return net.edges <= most_edges_of_ring && net.ends == 0 && net.angle > least_turn_of_ring * net.length &&
         net.bend > least_bend_of_ring * static_cast<double>(net.joints);
}

bool is_crease(const NetworkFigures& net, double noise, double diagonal) {
  if (is_flap(net)) return false;
  const double spread = net.spread.value(), unevenness = net.unevenness.value(), zigzag = net.zigzag.value();
  const double sum = spread + unevenness + zigzag;
  if (static_cast<double>(net.free_ends) * diagonal > free_ends_per_diagonal * net.length)
    return sum <= most_where_running_out;
  if (sum <= most_of_crease) return true;
  const bool drift_is_known = net.drift.weight >= least_with_drift * net.length;
  if (sum > most_unchecked && (net.tilt.value() > largest_tilt || !drift_is_known)) return false;
  const double tilt = std::min(net.tilt.value(), largest_tilt);
  const double shift = noise * static_cast<double>(net.edges) / net.length;
  const double left = beyond(spread, spread_of_tilt * tilt) + beyond(unevenness, unevenness_of_tilt * tilt) +
                      beyond(zigzag, zigzag_of_shift * shift);
  return left <= most_of_crease && beyond(net.drift.value(), drift_of_tilt * tilt) <= most_drift;
}

CreaseFault fault_of(const NetworkFigures& net) {
  if (is_flap(net)) return CreaseFault::folded;
  const double spread = net.spread.value(), unevenness = net.unevenness.value(), zigzag = net.zigzag.value();
  if (spread >= std::max(unevenness, zigzag)) return CreaseFault::rounded;
  return unevenness >= zigzag ? CreaseFault::uneven : CreaseFault::zigzag;
}

std::vector<char> border_vertices(const CreaseSurface& surface) {
  std::vector<char> border(surface.scan.vertices.size(), 0);
  for (std::size_t f = 0; f < surface.neighbours.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      if (surface.neighbours[f][k] == no_face)
        for (const std::size_t j : {1U, 2U}) border[surface.scan.triangles[f][(k + j) % 3]] = 1;
  return border;
}

// The changes of the mean angle from stretch to stretch along a chain.
void add_drift(const std::vector<EdgeFigures>& edges, const std::vector<std::uint32_t>& chain, Mean& drift) {
  std::optional<double> last;
  for (std::size_t begin = 0; begin + stretch <= chain.size(); begin += stretch) {
    Mean angle{};
    for (std::size_t i = begin; i < begin + stretch; ++i) {
      angle.sum += edges[chain[i]].length * edges[chain[i]].angle;
      angle.weight += edges[chain[i]].length;
    }
    if (last) drift.add(change(*last, angle.value()), angle.weight);
    last = angle.value();
  }
}

std::map<std::uint32_t, NetworkFigures> network_figures(const CreaseSurface& surface,
                                                        const std::vector<EdgeFigures>& edges,
                                                        CreaseNetworks& networks) {
  std::map<std::uint32_t, NetworkFigures> figures;
  for (std::uint32_t i = 0; i < edges.size(); ++i) {
    const EdgeFigures& e = edges[i];
    NetworkFigures& net = figures[networks.of(i)];
    if (net.edges++ == 0) {
      net.vertex = e.ends[0];
      net.place = (surface.scan.vertices[e.ends[0]] + surface.scan.vertices[e.ends[1]]) / 2;
    }
    net.length += e.length;
    net.angle += e.length * e.angle;
    net.spread.add(ratio(e.spread, e.angle), e.length);
    net.tilt.add(ratio(e.tilt, e.angle), e.length);
    net.zigzag.add(networks.zigzag(i), e.length);
  }
  for (const auto& [v, joint] : networks.joints()) {
    const EdgeFigures &a = edges[joint.edges[0]], &b = edges[joint.edges[1]];
    NetworkFigures& net = figures[networks.of(joint.edges[0])];
    net.unevenness.add(change(a.angle, b.angle), a.length + b.length);
    net.bend += joint.turn.norm();
    ++net.joints;
  }
  for (const std::vector<std::uint32_t>& chain : networks.chains())
    add_drift(edges, chain, figures[networks.of(chain.front())].drift);
  const std::vector<char> border = border_vertices(surface);
  for (const auto& [vertex, edge] : networks.ends()) {
    NetworkFigures& net = figures[networks.of(edge)];
    ++net.ends;
    if (!border[vertex]) ++net.free_ends;
  }
  return figures;
}

}  // namespace

std::string describe(CreaseFault fault) {
  switch (fault) {
    case CreaseFault::rounded:
      return "the surface turns over several faces";
    case CreaseFault::uneven:
      return "their angle is uneven";
    case CreaseFault::zigzag:
      return "their line is jagged";
    case CreaseFault::folded:
      return "single triangles are folded over";
  }
  return {};
}

JudgedCreases judge_creases(const CreaseSurface& surface, std::span<const FeatureEdge> sharp) {
  JudgedCreases judged;
  if (sharp.empty()) return judged;
  const std::vector<EdgeFigures> edges = EdgeMeasures(surface, sharp).measure();
  CreaseNetworks networks(surface.scan, edges);
  const Components bodies = find_components(surface.scan);
  const std::vector<double> diagonal = diagonals(surface.scan, bodies);
  std::map<CreaseFault, UnsupportedCreases> dropped;
  std::map<CreaseFault, std::size_t> most_edges;
  std::vector<char> kept(edges.size(), 0);  // of the networks' names
  for (const auto& [network, figures] : network_figures(surface, edges, networks)) {
    kept[network] = is_crease(figures, surface.noise, diagonal[bodies.of_vertex[figures.vertex]]);
    if (kept[network]) continue;
    const CreaseFault fault = fault_of(figures);
    UnsupportedCreases& all = dropped.try_emplace(fault, UnsupportedCreases{.fault = fault}).first->second;
    ++all.networks;
    all.edges += figures.edges;
    if (std::size_t& most = most_edges[fault]; figures.edges > most) {
      most = figures.edges;
      all.place = figures.place;
    }
  }
  for (std::uint32_t i = 0; i < edges.size(); ++i)
    if (kept[networks.of(i)]) judged.kept.push_back(sharp[i]);
  for (const auto& [fault, all] : dropped) judged.dropped.push_back(all);
  return judged;
}

}  // namespace scan2fea
