#include "preproc/volume/mid_edge_nodes.hpp"

#include "preproc/volume/mid_edge_relocation.hpp"
#include "quality/tetrahedron_measures.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

namespace scan2fea {
namespace {

struct Edge {
  std::uint32_t low, high;  // corner nodes
  std::uint32_t tetrahedron, local;

  bool same_ends(const Edge& other) const { return low == other.low && high == other.high; }
};

constexpr double farthest_of_edge = 0.25;
// Of the way that a node is from the middle of its edge, each time that an element beside it suffers; after so many
// times it is in the middle.
constexpr double easing = 0.85;
constexpr int most_easings = 20;

template <class T>
void sort_and_unique(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

struct BoundaryEdge {
  std::array<std::uint32_t, 2> ends;
  std::uint32_t node;

  auto operator<=>(const BoundaryEdge&) const = default;
};

std::vector<BoundaryEdge> boundary_edges(const TetMesh& mesh) {
  std::vector<BoundaryEdge> edges;
  for (const BoundaryFace f : mesh.boundary) {
    const Triangle corners = boundary_triangle(mesh, f), middles = boundary_mid_edge_nodes(mesh, f);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(corners[k], corners[(k + 1) % 3]);
      edges.push_back({{low, high}, middles[k]});
    }
  }
  sort_and_unique(edges);
  return edges;
}

}  // namespace

void add_mid_edge_nodes(TetMesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(mesh.tetrahedra.size() * 6);
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t)
    for (std::uint32_t e = 0; e < 6; ++e) {
      const auto [a, b] = tetrahedron_edges[e];
      const std::uint32_t i = mesh.tetrahedra[t][static_cast<std::size_t>(a)];
      const std::uint32_t j = mesh.tetrahedra[t][static_cast<std::size_t>(b)];
      edges.push_back({std::min(i, j), std::max(i, j), t, e});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.tetrahedron) < std::tie(b.low, b.high, b.tetrahedron);
  });
  mesh.mid_edge_nodes.resize(mesh.tetrahedra.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i == 0 || !edges[i].same_ends(edges[i - 1]))
      mesh.nodes.push_back((mesh.nodes[edges[i].low] + mesh.nodes[edges[i].high]) / 2);
    mesh.mid_edge_nodes[edges[i].tetrahedron][edges[i].local] = static_cast<std::uint32_t>(mesh.nodes.size() - 1);
  }
}

EdgePlaces nearest_on_scan(const TetMesh& mesh, const TriangleTree& scan) {
  EdgePlaces to;
  std::uint32_t hint = 0;
  for (const BoundaryEdge& edge : boundary_edges(mesh)) {
    const Vec3 &a = mesh.nodes[edge.ends[0]], &b = mesh.nodes[edge.ends[1]];
    const ClosestPoint nearest = scan.closest((a + b) / 2, hint);
    hint = nearest.triangle;
    const bool is_near = nearest.squared_distance <= farthest_of_edge * farthest_of_edge * (b - a).squaredNorm();
    to.edges.push_back(edge.ends);
    to.places.push_back(is_near ? nearest.point : Vec3((a + b) / 2));
  }
  return to;
}

namespace {

// Whether an element is too poor to be curved as it is; see curve_mid_edge_nodes.
class PoorlyCurved {
 public:
  PoorlyCurved(const TetMesh& mesh, const std::vector<Vec3>& straight, std::size_t flat_tetrahedra)
      : mesh_(mesh), straight_(straight), flat_(flat_tetrahedra) {}

  bool operator()(std::uint32_t t) const {
    constexpr double of_straight = 0.5;
    if (t >= flat_) return curved_quality(mesh_, t) < 1;
    const CurvedTetrahedron curved = curved_tetrahedron(mesh_, t);
    CurvedTetrahedron straight;
    for (std::size_t k = 0; k < 4; ++k) straight[k] = straight_[mesh_.tetrahedra[t][k]];
    for (std::size_t k = 0; k < 6; ++k) straight[4 + k] = straight_[mesh_.mid_edge_nodes[t][k]];
    return curved_scaled_jacobian(curved) < of_straight * curved_scaled_jacobian(straight);
  }

 private:
  const TetMesh& mesh_;
  const std::vector<Vec3>& straight_;
  std::size_t flat_;
};

// Nodes of poor elements are eased all at once, so that the outcome does not depend on an order. An eased node may make
// a neighbour poor whose other nodes stay, so until none is: straight elements are good. Returns how often each was.
std::vector<int> ease(TetMesh& mesh, const std::vector<Vec3>& straight, const PoorlyCurved& is_poor,
                      std::vector<std::uint32_t> suspects) {
  std::vector<int> easings(mesh.nodes.size(), 0);
  const auto may_ease = [&](std::uint32_t v) { return easings[v] < most_easings && mesh.nodes[v] != straight[v]; };
  std::vector<std::vector<std::uint32_t>> around(mesh.nodes.size());
  for (const std::uint32_t t : suspects)
    for (const std::uint32_t v : mesh.mid_edge_nodes[t]) around[v].push_back(t);
  while (!suspects.empty()) {
    std::vector<std::uint32_t> eased;
    for (const std::uint32_t t : suspects)
      if (is_poor(t)) std::ranges::copy_if(mesh.mid_edge_nodes[t], std::back_inserter(eased), may_ease);
    sort_and_unique(eased);
    suspects.clear();
    for (const std::uint32_t v : eased) {
      Vec3& place = mesh.nodes[v];
      place = ++easings[v] < most_easings ? Vec3(straight[v] + easing * (place - straight[v])) : straight[v];
      suspects.insert(suspects.end(), around[v].begin(), around[v].end());
    }
    sort_and_unique(suspects);
  }
  return easings;
}

}  // namespace

std::vector<std::uint32_t> place_mid_edge_nodes(TetMesh& mesh, const EdgePlaces& to) {
  constexpr std::uint32_t none = ~0U;
  std::vector<std::uint32_t> node_of_place(to.places.size(), none);
  std::size_t placed = 0;
  const auto place = [&](std::array<std::uint32_t, 2> ends, std::uint32_t node) {
    const auto at = std::lower_bound(to.edges.begin(), to.edges.end(), ends);
    if (at == to.edges.end() || *at != ends) return;
    const auto e = static_cast<std::size_t>(at - to.edges.begin());
    placed += node_of_place[e] == none ? 1 : 0;
    node_of_place[e] = node;
    mesh.nodes[node] = to.places[e];
  };
  for (const BoundaryEdge& edge : boundary_edges(mesh)) place(edge.ends, edge.node);
  for (std::size_t t = 0; t < mesh.tetrahedra.size() && placed < to.places.size(); ++t)  // those inside
    for (std::size_t e = 0; e < 6; ++e) {
      const auto [i, j] = tetrahedron_edges[e];
      const auto [low, high] =
          std::minmax(mesh.tetrahedra[t][static_cast<std::size_t>(i)], mesh.tetrahedra[t][static_cast<std::size_t>(j)]);
      place({low, high}, mesh.mid_edge_nodes[t][e]);
    }
  return node_of_place;
}

CurveResult curve_mid_edge_nodes(TetMesh& mesh, EdgePlaces& to, const Progress& progress, std::size_t flat_tetrahedra) {
  const std::vector<Vec3> straight = mesh.nodes;
  const std::vector<std::uint32_t> node_of_place = place_mid_edge_nodes(mesh, to);
  std::vector<bool> held(mesh.nodes.size(), false);
  for (const std::uint32_t v : node_of_place) held[v] = true;
  const PoorlyCurved is_poor(mesh, straight, flat_tetrahedra);
  std::vector<std::uint32_t> poor;
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t)
    if (std::ranges::any_of(mesh.mid_edge_nodes[t], [&](std::uint32_t v) { return held[v]; }) && is_poor(t))
      poor.push_back(t);
  const bool has_poor = !poor.empty();
  std::erase_if(poor, [&](std::uint32_t t) { return t < flat_tetrahedra; });
  // Where many are poor, the surface is too coarse for its bends, and easing alone does as well.
  constexpr double many_poor = 0.1;
  if (!poor.empty() && static_cast<double>(poor.size()) <= many_poor * static_cast<double>(mesh.tetrahedra.size()))
    relocate_mid_edge_nodes(mesh, poor, held, 1, progress);
  std::vector<std::uint32_t> moved_elements;
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t)
    if (std::ranges::any_of(mesh.mid_edge_nodes[t], [&](auto v) { return mesh.nodes[v] != straight[v]; }))
      moved_elements.push_back(t);
  const std::vector<int> easings =
      has_poor ? ease(mesh, straight, is_poor, moved_elements) : std::vector<int>(mesh.nodes.size(), 0);

  CurveResult result;
  for (std::size_t e = 0; e < to.places.size(); ++e) {
    const std::uint32_t v = node_of_place[e];
    to.places[e] = mesh.nodes[v];
    const double moved = (mesh.nodes[v] - straight[v]).norm();
    result.curved += moved > 0;
    result.eased += easings[v] > 0;
    result.largest_displacement = std::max(result.largest_displacement, moved);
  }
  for (const std::uint32_t t : moved_elements)
    result.least_scaled_jacobian =
        std::min(result.least_scaled_jacobian, curved_scaled_jacobian(curved_tetrahedron(mesh, t)));
  result.tetrahedra = mesh.tetrahedra.size();
  result.nodes = mesh.nodes.size();
  result.volume = total_volume(mesh);
  return result;
}

}  // namespace scan2fea
