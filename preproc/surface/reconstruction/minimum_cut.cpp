#include "preproc/surface/reconstruction/minimum_cut.hpp"

#include "preproc/mesh/sorted_corners.hpp"
#include "preproc/mesh/union_find.hpp"
#include "preproc/surface/kernel/components.hpp"
#include "preproc/surface/kernel/parallel_blocks.hpp"
#include "preproc/surface/kernel/winding_number.hpp"
#include "preproc/surface/reconstruction/pinches.hpp"

#include <algorithm>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <boost/graph/compressed_sparse_row_graph.hpp>
#include <boost/range/iterator_range.hpp>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>

namespace scan2fea {
namespace {

struct Hash {
  std::size_t operator()(const Triangle& t) const {
    std::uint64_t h = t[0];
    for (const std::uint32_t v : {t[1], t[2]}) h = (h ^ (h >> 29)) * 0x9e3779b97f4a7c15U + v;
    return h ^ (h >> 32);
  }
};

// The pieces, joined across edges, that have a vertex: two where they meet in it.
std::vector<std::set<std::uint32_t>> pieces_of_vertices(const std::vector<Triangle>& triangles, std::size_t vertices) {
  UnionFind pieces(triangles.size());
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> at_edge;
  for (std::uint32_t f = 0; f < triangles.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [entry, is_new] = at_edge.try_emplace(std::minmax({triangles[f][k], triangles[f][(k + 1) % 3]}), f);
      if (!is_new) pieces.unite(f, entry->second);
    }
  std::vector<std::set<std::uint32_t>> of_vertex(vertices);
  for (std::uint32_t f = 0; f < triangles.size(); ++f)
    for (const std::uint32_t v : triangles[f]) of_vertex[v].insert(pieces.find(f));
  return of_vertex;
}

struct Edge {
  std::uint32_t from, to;
  double capacity;
};

class Cut {
 public:
  Cut(const std::vector<Vec3>& points, const std::vector<double>& spacing, const DelaunayCells& cells,
      const std::vector<const WoundSurface*>& surfaces, const SeenCells& seen)
      : points_(points),
        spacing_(spacing),
        cells_(cells),
        seen_(seen),
        winding_(cells.corners.size(), 0.0),
        costs_{winding_, std::vector<std::array<double, 4>>(cells.corners.size(), {0, 0, 0, 0})} {
    const double share = 1 / static_cast<double>(surfaces.size());
    for (const WoundSurface* surface : surfaces) {
      for (const Triangle& t : surface->triangles) votes_[sorted(t)] += share;
      for (std::size_t cell = 0; cell < winding_.size(); ++cell) winding_[cell] += share * surface->winding[cell];
    }
  }

  CutSurface run(const std::vector<CellSide>& known) {
    take(known);
    cut();
    wind_what_is_voted(surface());
    take(known);
    cut();
    join_at_edges();
    return opened();
  }

  CutSurface run_joined(const std::vector<const WoundSurface*>& surfaces, const std::vector<Triangle>& parted,
                        double longest) {
    wind_what_is_voted(parted);
    find_gaps(surfaces, parted, longest);
    cut();
    join_at_edges();
    return opened();
  }

 private:
  // Each once.
  template <class Visit>
  void for_each_facet(const Visit& visit) const {
    for (std::uint32_t cell = 0; cell < cells_.corners.size(); ++cell)
      for (std::size_t k = 0; k < 4; ++k)
        if (const std::uint32_t other = cells_.neighbours[cell][k]; cell < other) visit(cell, k, other);
  }

  void wind_what_is_voted(std::vector<Triangle> triangles) {
    std::erase_if(triangles, [&](const Triangle& t) { return !votes_.contains(sorted(t)); });
    winding_ = wind(points_, cells_, std::move(triangles)).winding;
  }

  // What is known stands above what surfaces wind about.
  void take(const std::vector<CellSide>& known) {
    for (std::size_t cell = 0; cell < known.size(); ++cell)
      if (known[cell] != CellSide::unknown) winding_[cell] = known[cell] == CellSide::inside ? 1 : 0;
  }

  void cut() {
    edges_.clear();
    std::ranges::fill(costs_.gain, 0.0);
    add_cells();
    add_facets();
    find_inside();
  }

  CutSurface opened() {
    const std::size_t pinched = count_pinched_edges(cells_, is_inside_);
    if (pinched > 0) open_pinches(cells_, costs_, is_inside_);
    return {surface(), pinched};
  }

  std::vector<Triangle> surface() const {
    std::vector<Triangle> triangles;
    for_each_facet([&](std::uint32_t cell, std::size_t k, std::uint32_t other) {
      if (is_inside_[cell] == is_inside_[other]) return;
      Triangle t = cells_.facet(cell, k);
      if (!is_inside_[cell]) std::swap(t[1], t[2]);
      triangles.push_back(t);
    });
    return triangles;
  }

  // How surely the triangle between two cells has the first inside, from -1 to 1.
  double difference(std::uint32_t cell, std::uint32_t other) const {
    return std::clamp(2 * (winding_[cell] - winding_[other]), -1.0, 1.0);
  }

  double crossed(std::uint32_t cell, std::size_t k) const { return seen_.crossed.empty() ? 0 : seen_.crossed[cell][k]; }

  std::size_t corner_across(std::uint32_t cell, std::uint32_t other) const {
    const auto& neighbours = cells_.neighbours[cell];
    return static_cast<std::size_t>(std::ranges::find(neighbours, other) - neighbours.begin());
  }

  double area_of(const Triangle& t) const {
    return 0.5 * (points_[t[1]] - points_[t[0]]).cross(points_[t[2]] - points_[t[0]]).norm();
  }

  // 1 up to twice the spacing, then as the square.
  double cost(const Triangle& t) const {
    constexpr double usual = 2;
    double longest = 0, widest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      longest = std::max(longest, (points_[t[(k + 1) % 3]] - points_[t[k]]).norm());
      widest = std::max(widest, spacing_[t[k]]);
    }
    const double excess = std::max(1.0, longest / (usual * widest));
    return excess * excess;
  }

  void add_facets() {
    for_each_facet([&](std::uint32_t cell, std::size_t k, std::uint32_t other) {
      const Triangle t = cells_.facet(cell, k);
      if (std::ranges::find(t, DelaunayCells::infinite) != t.end()) return;
      const double area = area_of(t);
      const auto found = votes_.find(sorted(t));
      const double votes = found == votes_.end() ? 0 : found->second;
      // The votes hold for one side as far as the two differ.
      const double step = difference(cell, other);
      costs_.gain[cell] += area * votes * step;
      costs_.gain[other] -= area * votes * step;
      const double price = area * cost(t);
      const std::size_t back = corner_across(other, cell);
      costs_.price[cell][k] = price * (1 - votes * std::max(step, 0.0)) + crossed(cell, k);
      costs_.price[other][back] = price * (1 - votes * std::max(-step, 0.0)) + crossed(other, back);
      edges_.push_back({cell, other, costs_.price[cell][k]});
      edges_.push_back({other, cell, costs_.price[other][back]});
    });
  }

  void join_at_edges();
  void find_gaps(const std::vector<const WoundSurface*>& surfaces, const std::vector<Triangle>& parted, double longest);
  void add_cells();
  void find_inside();

  const std::vector<Vec3>& points_;
  const std::vector<double>& spacing_;
  const DelaunayCells& cells_;
  const SeenCells& seen_;
  std::unordered_map<Triangle, double, Hash> votes_;  // the share of the surfaces that have it
  std::vector<double> winding_;                       // about each cell's centre, mean of the surfaces, either way
  std::vector<bool> is_gap_;                          // cells between pieces that belong together; or none
  CutCosts costs_;                                    // areas
  std::vector<Edge> edges_;                           // two for each facet, there and back
  std::vector<bool> is_inside_;
};

void Cut::add_cells() {
  for (std::uint32_t cell = 0; cell < cells_.corners.size(); ++cell) {
    if (cells_.is_infinite(cell)) continue;
    double area = 0;
    for (std::size_t k = 0; k < 4; ++k) area += area_of(cells_.facet(cell, k)) / 4;
    costs_.gain[cell] += area * (2 * winding_[cell] - 1);
    if (!seen_.inside.empty()) costs_.gain[cell] += seen_.inside[cell];
    constexpr double to_join = 4;  // more than two voted sides cost
    if (!is_gap_.empty() && is_gap_[cell]) costs_.gain[cell] += to_join * area;
  }
}

// Pieces of the inside that meet in an edge alone are made one there, by the fewer of the cells that part them: a thin
// part with few points is cut at such edges.
void Cut::join_at_edges() {
  UnionFind pieces(cells_.corners.size());
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::size_t, std::uint32_t>> edges;
  for_each_facet([&](std::uint32_t cell, std::size_t k, std::uint32_t other) {
    if (is_inside_[cell] && is_inside_[other]) pieces.unite(cell, other);
    if (is_inside_[cell] == is_inside_[other]) return;
    const Triangle t = cells_.facet(cell, k);
    for (std::size_t i = 0; i < 3; ++i) {
      auto& [count, of] = edges[std::minmax({t[i], t[(i + 1) % 3]})];
      ++count;
      of = is_inside_[cell] ? cell : other;
    }
  });
  for (const auto& [edge, entry] : edges) {
    if (entry.first != 4) continue;
    const std::vector<std::uint32_t> ring = cells_.around(entry.second, edge.first, edge.second);
    std::vector<std::vector<std::uint32_t>> gaps(1);  // runs of cells outside; the first cell is inside
    std::uint32_t other_piece = entry.second;
    for (const std::uint32_t cell : ring) {
      if (!is_inside_[cell]) {
        gaps.back().push_back(cell);
      } else {
        if (pieces.find(cell) != pieces.find(entry.second)) other_piece = cell;
        if (!gaps.back().empty()) gaps.emplace_back();
      }
    }
    if (gaps.back().empty()) gaps.pop_back();
    std::erase_if(gaps, [&](const auto& gap) {
      return std::ranges::any_of(gap, [&](std::uint32_t cell) { return cells_.is_infinite(cell); });
    });
    if (other_piece == entry.second || gaps.empty()) continue;
    const auto& least = *std::ranges::min_element(gaps, {}, [](const auto& gap) { return gap.size(); });
    for (const std::uint32_t cell : least) is_inside_[cell] = true;
    pieces.unite(entry.second, other_piece);
  }
}

void Cut::find_gaps(const std::vector<const WoundSurface*>& surfaces, const std::vector<Triangle>& parted,
                    double longest) {
  const std::vector<std::set<std::uint32_t>> pieces = pieces_of_vertices(parted, points_.size());
  std::vector<Components> fronts;
  for (const WoundSurface* surface : surfaces) fronts.push_back(find_components({points_, surface->triangles}));
  const auto is_near = [&](std::uint32_t a, std::uint32_t b) {
    return (points_[a] - points_[b]).norm() < longest * std::max(spacing_[a], spacing_[b]);
  };
  const auto belong_together = [&](std::uint32_t a, std::uint32_t b) {
    return !pieces[a].empty() && !pieces[b].empty() && (pieces[a] != pieces[b] || pieces[a].size() > 1) &&
           std::ranges::any_of(fronts, [&](const Components& f) { return f.of_vertex[a] == f.of_vertex[b]; });
  };
  is_gap_.assign(cells_.corners.size(), false);
  for (std::uint32_t cell = 0; cell < cells_.corners.size(); ++cell) {
    if (cells_.is_infinite(cell)) continue;
    const auto& c = cells_.corners[cell];
    bool is_short = true, is_between = false;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < i; ++k) {
        is_short = is_short && is_near(c[i], c[k]);
        is_between = is_between || belong_together(c[i], c[k]);
      }
    is_gap_[cell] = is_short && is_between;
  }
}

// Two nodes more than there are cells, source and sink. Boost wants the edges sorted, and the way back of each.
void Cut::find_inside() {
  using Graph = boost::compressed_sparse_row_graph<boost::directedS, boost::no_property, boost::no_property,
                                                   boost::no_property, std::uint32_t, std::uint32_t>;
  const auto cells = static_cast<std::uint32_t>(cells_.corners.size());
  const std::uint32_t source = cells, sink = cells + 1;
  for (std::uint32_t cell = 0; cell < cells; ++cell) {
    constexpr double surely = 1e300;
    const double gain = cells_.is_infinite(cell) ? -surely : costs_.gain[cell];
    if (gain == 0) continue;
    edges_.push_back(gain > 0 ? Edge{source, cell, gain} : Edge{cell, sink, -gain});
    edges_.push_back(gain > 0 ? Edge{cell, source, 0} : Edge{sink, cell, 0});
  }
  std::vector<std::uint32_t> order(edges_.size()), place(edges_.size());
  for (std::uint32_t e = 0; e < order.size(); ++e) order[e] = e;
  std::ranges::sort(order, {}, [&](std::uint32_t e) { return std::tuple(edges_[e].from, edges_[e].to, e); });
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;
  std::vector<double> capacity, residual(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    const Edge& edge = edges_[order[i]];
    place[order[i]] = i;
    ends.emplace_back(edge.from, edge.to);
    capacity.push_back(edge.capacity);
  }
  const Graph graph(boost::edges_are_sorted, ends.begin(), ends.end(), cells + 2);
  std::vector<Graph::edge_descriptor> by_place(order.size()), reverse(order.size());
  const auto index = boost::get(boost::edge_index, graph);
  for (const auto e : boost::make_iterator_range(boost::edges(graph))) by_place[get(index, e)] = e;
  for (std::uint32_t i = 0; i < order.size(); ++i) reverse[i] = by_place[place[order[i] ^ 1U]];
  std::vector<Graph::edge_descriptor> predecessor(cells + 2);
  std::vector<boost::default_color_type> colour(cells + 2);
  std::vector<std::uint32_t> distance(cells + 2);
  const auto of_edge = [&](auto& values) { return boost::make_iterator_property_map(values.begin(), index); };
  const auto of_node = [&](auto& values) {
    return boost::make_iterator_property_map(values.begin(), boost::get(boost::vertex_index, graph));
  };
  boost::boykov_kolmogorov_max_flow(graph, of_edge(capacity), of_edge(residual), of_edge(reverse), of_node(predecessor),
                                    of_node(colour), of_node(distance), boost::get(boost::vertex_index, graph), source,
                                    sink);
  is_inside_.resize(cells);
  for (std::uint32_t cell = 0; cell < cells; ++cell) is_inside_[cell] = colour[cell] == boost::black_color;
}

}  // namespace

WoundSurface wind(const std::vector<Vec3>& points, const DelaunayCells& cells, std::vector<Triangle> triangles) {
  const WindingNumber winding(points, triangles);
  WoundSurface surface{std::move(triangles), std::vector<double>(cells.corners.size(), 0.0)};
  for_each_block(cells.corners.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t cell = first; cell < last; ++cell) {
      if (cells.is_infinite(static_cast<std::uint32_t>(cell))) continue;
      Vec3 centre = Vec3::Zero();
      for (const std::uint32_t v : cells.corners[cell]) centre += points[v] / 4;
      surface.winding[cell] = std::min(std::abs(winding(centre)), 1.0);
    }
  });
  return surface;
}

CutSurface cut_surface(const std::vector<Vec3>& points, const std::vector<double>& spacing, const DelaunayCells& cells,
                       const std::vector<const WoundSurface*>& surfaces, const std::vector<CellSide>& known,
                       const SeenCells& seen) {
  return Cut(points, spacing, cells, surfaces, seen).run(known);
}

CutSurface join_pieces(const std::vector<Vec3>& points, const std::vector<double>& spacing, const DelaunayCells& cells,
                       const std::vector<const WoundSurface*>& surfaces, const std::vector<Triangle>& parted,
                       double longest, const SeenCells& seen) {
  return Cut(points, spacing, cells, surfaces, seen).run_joined(surfaces, parted, longest);
}

}  // namespace scan2fea
