#include "preproc/surface/features/feature_chains.hpp"

#include "preproc/surface/kernel/adjacency.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace scan2fea {
namespace {

constexpr std::uint32_t no_edge = no_face;
constexpr double straight_cosine = 0.70710678118654752;  // a continuation turns by at most 45°

}  // namespace

CreaseChains::CreaseChains(const SurfaceMesh& scan, const std::vector<Triangle>& neighbours,
                           std::vector<CreaseEdge> edges)
    : scan_(scan),
      edges_(std::move(edges)),
      first_(scan.vertices.size() + 1, 0),
      marked_(edges_.size(), 0),
      degree_(scan.vertices.size(), 0),
      on_border_(scan.vertices.size(), 0) {
  for (std::size_t f = 0; f < neighbours.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      if (neighbours[f][k] == no_face)
        on_border_[scan.triangles[f][(k + 1) % 3]] = on_border_[scan.triangles[f][(k + 2) % 3]] = 1;
  for (const CreaseEdge& e : edges_)
    for (const std::uint32_t v : e.ends) ++first_[v + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  star_.resize(2 * edges_.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t i = 0; i < edges_.size(); ++i)
    for (const std::uint32_t v : edges_[i].ends) star_[next[v]++] = i;
  length_.reserve(edges_.size());
  for (const CreaseEdge& e : edges_) length_.push_back((scan.vertices[e.ends[0]] - scan.vertices[e.ends[1]]).norm());
}

void CreaseChains::set(std::uint32_t edge, bool marked) {
  if (marked_[edge] == static_cast<char>(marked)) return;
  marked_[edge] = marked;
  for (const std::uint32_t v : edges_[edge].ends) degree_[v] += marked ? 1U : ~0U;
}

void CreaseChains::mark_above(double angle_deg) {
  for (std::uint32_t i = 0; i < edges_.size(); ++i)
    if (edges_[i].angle_deg > angle_deg) set(i, true);
}

std::uint32_t CreaseChains::marked_edge_at(std::uint32_t v, std::uint32_t except) const {
  for (const std::uint32_t e : at(v))
    if (marked_[e] && e != except) return e;
  return no_edge;
}

void CreaseChains::extend_from(std::uint32_t v, double angle_deg) {
  while (degree_[v] == 1 && !on_border_[v]) {
    const std::uint32_t last = marked_edge_at(v, no_edge);
    const Vec3 direction = (scan_.vertices[v] - scan_.vertices[other_end(last, v)]).normalized();
    std::uint32_t best = no_edge;
    double best_score = 0;
    for (const std::uint32_t e : at(v)) {
      if (marked_[e] || edges_[e].continuation_angle_deg <= angle_deg) continue;
      const Vec3 onwards = (scan_.vertices[other_end(e, v)] - scan_.vertices[v]).normalized();
      const double cosine = direction.dot(onwards);
      if (cosine < straight_cosine) continue;
      const double score = cosine * edges_[e].continuation_angle_deg;
      if (score > best_score) {
        best_score = score;
        best = e;
      }
    }
    if (best == no_edge) return;
    set(best, true);
    v = other_end(best, v);
  }
}

void CreaseChains::continue_ends(double angle_deg) {
  std::vector<std::uint32_t> ends;
  for (std::uint32_t v = 0; v < degree_.size(); ++v)
    if (degree_[v] == 1 && !on_border_[v]) ends.push_back(v);
  for (const std::uint32_t v : ends) extend_from(v, angle_deg);
}

void CreaseChains::drop_free_ends(double shortest) {
  // Dropping one chain of a fork joins the other two, so the shortest goes first.
  struct Spur {
    double length;
    std::uint32_t end;
    std::vector<std::uint32_t> edges;
  };
  const auto spur_from = [&](std::uint32_t end) {
    Spur spur{0, end, {}};
    std::uint32_t v = end, edge = no_edge;
    do {
      edge = marked_edge_at(v, edge);
      spur.edges.push_back(edge);
      spur.length += length_[edge];
      v = other_end(edge, v);
    } while (degree_[v] == 2 && !on_border_[v]);
    return spur;
  };
  while (true) {
    std::vector<Spur> spurs;
    for (std::uint32_t v = 0; v < degree_.size(); ++v)
      if (degree_[v] == 1 && !on_border_[v])
        if (Spur spur = spur_from(v); spur.length < shortest) spurs.push_back(std::move(spur));
    if (spurs.empty()) return;
    std::sort(spurs.begin(), spurs.end(),
              [](const Spur& a, const Spur& b) { return a.length != b.length ? a.length < b.length : a.end < b.end; });
    // Only those go that share no fork with one dropped before in this round.
    std::vector<std::uint32_t> forks;
    for (const Spur& spur : spurs) {
      const FeatureEdge& last = edges_[spur.edges.back()].ends;
      const bool touched = std::any_of(last.begin(), last.end(), [&](std::uint32_t v) {
        return std::find(forks.begin(), forks.end(), v) != forks.end();
      });
      if (touched) continue;
      for (const std::uint32_t v : last) forks.push_back(v);
      for (const std::uint32_t e : spur.edges) set(e, false);
    }
  }
}

void CreaseChains::drop_small_nets(double shortest, double sharp_deg) {
  std::vector<char> seen(edges_.size(), 0);
  for (std::uint32_t seed = 0; seed < edges_.size(); ++seed) {
    if (!marked_[seed] || seen[seed]) continue;
    std::vector<std::uint32_t> net{seed};
    seen[seed] = 1;
    double length = 0, angles = 0;
    for (std::size_t i = 0; i < net.size(); ++i) {
      length += length_[net[i]];
      angles += edges_[net[i]].angle_deg;
      for (const std::uint32_t v : edges_[net[i]].ends)
        for (const std::uint32_t e : at(v))
          if (marked_[e] && !seen[e]) {
            seen[e] = 1;
            net.push_back(e);
          }
    }
    if (length < shortest && angles < sharp_deg * static_cast<double>(net.size()))
      for (const std::uint32_t e : net) set(e, false);
  }
}

std::vector<FeatureEdge> CreaseChains::marked() const {
  std::vector<FeatureEdge> result;
  for (std::uint32_t i = 0; i < edges_.size(); ++i)
    if (marked_[i]) result.push_back(edges_[i].ends);
  return result;
}

}  // namespace scan2fea
