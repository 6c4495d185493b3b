#include "preproc/surface/reconstruction/pinches.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace scan2fea {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;
using Cells = std::vector<std::uint32_t>;

class Pinches {
 public:
  Pinches(const DelaunayCells& cells, std::vector<bool>& is_inside) : cells_(cells), is_inside_(is_inside) {}

  // Each with a cell that has it.
  std::map<Edge, std::uint32_t> find() const {
    std::map<Edge, std::pair<std::size_t, std::uint32_t>> edges;
    for (std::uint32_t cell = 0; cell < cells_.corners.size(); ++cell) {
      if (!is_inside_[cell]) continue;
      for (std::size_t k = 0; k < 4; ++k) {
        if (is_inside_[cells_.neighbours[cell][k]]) continue;
        const Triangle t = cells_.facet(cell, k);
        for (std::size_t i = 0; i < 3; ++i) {
          auto& [count, of] = edges[std::minmax({t[i], t[(i + 1) % 3]})];
          ++count;
          of = cell;
        }
      }
    }
    std::map<Edge, std::uint32_t> pinched;
    for (const auto& [edge, entry] : edges)
      if (entry.first > 2) pinched.emplace(edge, entry.second);
    return pinched;
  }

  // Whether the edge is none afterwards.
  bool open(const Edge& edge, std::uint32_t cell, const CutCosts& costs) {
    const std::vector<Cells> runs = runs_about(cells_.around(cell, edge.first, edge.second));
    if (runs.size() <= 2) return true;
    const Cells* best = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const Cells& run : runs) {
      if (std::ranges::any_of(run, [&](std::uint32_t c) { return cells_.is_infinite(c); })) continue;
      const double cost = cost_of_turning(run, costs);
      if (cost >= least || !turning_helps(run)) continue;
      least = cost;
      best = &run;
    }
    if (best != nullptr) turn(*best);
    return best != nullptr;
  }

 private:
  // Of cells on one side, in a ring.
  std::vector<Cells> runs_about(Cells ring) const {
    const auto change = std::ranges::adjacent_find(
        ring, [&](std::uint32_t a, std::uint32_t b) { return is_inside_[a] != is_inside_[b]; });
    if (change == ring.end()) return {ring};
    std::rotate(ring.begin(), change + 1, ring.end());
    std::vector<Cells> runs;
    for (const std::uint32_t c : ring) {
      if (runs.empty() || is_inside_[runs.back().front()] != is_inside_[c]) runs.emplace_back();
      runs.back().push_back(c);
    }
    return runs;
  }

  // More for the cut, if they change over.
  double cost_of_turning(const Cells& run, const CutCosts& costs) const {
    const bool was_inside = is_inside_[run.front()];
    double cost = 0;
    for (const std::uint32_t cell : run) {
      cost += was_inside ? costs.gain[cell] : -costs.gain[cell];
      for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t other = cells_.neighbours[cell][k];
        if (std::ranges::find(run, other) != run.end()) continue;
        const auto& back = cells_.neighbours[other];
        const double out = costs.price[cell][k];
        const double in = costs.price[other][static_cast<std::size_t>(std::ranges::find(back, cell) - back.begin())];
        if (was_inside) cost += is_inside_[other] ? in : -out;
        if (!was_inside) cost += is_inside_[other] ? -in : out;
      }
    }
    return cost;
  }

  bool turning_helps(const Cells& run) {
    const std::size_t before = pinched_about(run);
    turn(run);
    const std::size_t after = pinched_about(run);
    turn(run);
    return after < before;
  }

  void turn(const Cells& run) {
    for (const std::uint32_t cell : run) is_inside_[cell] = !is_inside_[cell];
  }

  // Of the edges of these cells.
  std::size_t pinched_about(const Cells& run) const {
    std::map<Edge, std::uint32_t> edges;
    for (const std::uint32_t cell : run)
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = 0; k < i; ++k)
          edges.emplace(std::minmax({cells_.corners[cell][i], cells_.corners[cell][k]}), cell);
    return static_cast<std::size_t>(std::ranges::count_if(edges, [&](const auto& entry) {
      return runs_about(cells_.around(entry.second, entry.first.first, entry.first.second)).size() > 2;
    }));
  }

  const DelaunayCells& cells_;
  std::vector<bool>& is_inside_;
};

}  // namespace

std::size_t count_pinched_edges(const DelaunayCells& cells, const std::vector<bool>& is_inside) {
  std::vector<bool> same = is_inside;
  return Pinches(cells, same).find().size();
}

void open_pinches(const DelaunayCells& cells, const CutCosts& costs, std::vector<bool>& is_inside) {
  Pinches pinches(cells, is_inside);
  // What is stuck may come free when what is beside it has been opened.
  for (bool any = true; any;) {
    any = false;
    for (const auto& [edge, cell] : pinches.find()) any = pinches.open(edge, cell, costs) || any;
  }
}

}  // namespace scan2fea
