#include "export/raw_mesh.hpp"

#include "preproc/mesh/error.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace scan2fea {
namespace {

using Place = std::function<std::string(std::size_t)>;
constexpr auto no_index = std::numeric_limits<std::uint32_t>::max();

// Indices into RawMesh's nodes, ordered by node number.
std::vector<std::uint32_t> by_number(const RawMesh& raw, const Place& place_of_node) {
  std::vector<std::uint32_t> order(raw.node_numbers.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto less = [&](std::uint32_t a, std::uint32_t b) { return raw.node_numbers[a] < raw.node_numbers[b]; };
  if (!std::is_sorted(order.begin(), order.end(), less)) std::stable_sort(order.begin(), order.end(), less);
  for (std::size_t i = 1; i < order.size(); ++i)
    if (raw.node_numbers[order[i]] == raw.node_numbers[order[i - 1]])
      throw InvalidInput({.what = "node " + std::to_string(raw.node_numbers[order[i]]) + " is defined twice",
                          .where = place_of_node(order[i]),
                          .value = {},
                          .limit = {},
                          .advice = "one part per file, with node numbers of its own"});
  return order;
}

// Replaces node numbers by positions in `order`.
std::vector<std::uint32_t> resolve(const RawMesh& raw, const std::vector<std::uint32_t>& order,
                                   const std::vector<std::uint64_t>& numbers, std::size_t per_element,
                                   const Place& place_of_element) {
  std::vector<std::uint32_t> positions(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto it =
        std::lower_bound(order.begin(), order.end(), numbers[i],
                         [&](std::uint32_t n, std::uint64_t number) { return raw.node_numbers[n] < number; });
    if (it == order.end() || raw.node_numbers[*it] != numbers[i])
      throw InvalidInput({.what = "element uses node " + std::to_string(numbers[i]) + ", which is not defined",
                          .where = place_of_element(i / per_element),
                          .value = {},
                          .limit = {},
                          .advice = {}});
    positions[i] = static_cast<std::uint32_t>(it - order.begin());
  }
  return positions;
}

void require_distinct(const TetMesh& mesh, const Place& place_of_element) {
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    std::array<std::uint32_t, 10> nodes{};
    auto* end = std::copy(mesh.tetrahedra[t].begin(), mesh.tetrahedra[t].end(), nodes.begin());
    if (mesh.order() == 2) end = std::copy(mesh.mid_edge_nodes[t].begin(), mesh.mid_edge_nodes[t].end(), end);
    std::sort(nodes.begin(), end);
    if (std::adjacent_find(nodes.begin(), end) != end)
      throw InvalidInput(
          {.what = "element uses a node twice", .where = place_of_element(t), .value = {}, .limit = {}, .advice = {}});
  }
}

}  // namespace

TetMesh assemble(const RawMesh& raw, const std::filesystem::path& file, const Place& place_of_node,
                 const Place& place_of_element) {
  const std::size_t elements = raw.corners.size() / 4;
  const auto fail = [&](std::string what, std::string where) {
    throw InvalidInput({.what = std::move(what), .where = std::move(where), .value = {}, .limit = {}, .advice = {}});
  };
  if (elements == 0) fail("holds no tetrahedra", file.string());
  if (raw.nodes.size() >= no_index || elements >= no_index / 4) fail("holds more than 2^30 elements", file.string());
  if (!raw.mid_edges.empty() && raw.mid_edges.size() != 6 * elements)
    fail("holds tetrahedra of first and of second order", file.string());

  const std::vector<std::uint32_t> order = by_number(raw, place_of_node);
  std::vector<std::uint32_t> corners = resolve(raw, order, raw.corners, 4, place_of_element);
  std::vector<std::uint32_t> mid_edges = resolve(raw, order, raw.mid_edges, 6, place_of_element);

  std::vector<std::uint32_t> renumbered(order.size(), no_index);
  for (const std::uint32_t n : corners) renumbered[n] = 0;
  for (const std::uint32_t n : mid_edges) renumbered[n] = 0;
  TetMesh mesh;
  for (std::size_t n = 0; n < order.size(); ++n) {
    if (renumbered[n] == no_index) continue;
    if (!raw.nodes[order[n]].allFinite()) fail("coordinate is not a finite number", place_of_node(order[n]));
    renumbered[n] = static_cast<std::uint32_t>(mesh.nodes.size());
    mesh.nodes.push_back(raw.nodes[order[n]]);
  }

  mesh.tetrahedra.resize(elements);
  for (std::size_t i = 0; i < corners.size(); ++i) mesh.tetrahedra[i / 4][i % 4] = renumbered[corners[i]];
  mesh.mid_edge_nodes.resize(mid_edges.size() / 6);
  for (std::size_t i = 0; i < mid_edges.size(); ++i) mesh.mid_edge_nodes[i / 6][i % 6] = renumbered[mid_edges[i]];
  require_distinct(mesh, place_of_element);
  mesh.boundary = find_boundary(mesh.tetrahedra);
  return mesh;
}

}  // namespace scan2fea
