#include "export/raw_mesh.hpp"

#include "export/raw_sets.hpp"
#include "preproc/mesh/element_faces.hpp"
#include "preproc/mesh/error.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>

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

// Nodes that elements use become the nodes of a mesh, in the order of their numbers.
class NodeMap {
 public:
  NodeMap(const RawMesh& raw, const Place& place_of_node)
      : raw_(raw), place_of_node_(place_of_node), order_(by_number(raw, place_of_node)) {
    renumbered_.resize(order_.size(), no_index);
  }

  // As positions in `order_`, which `index_of` turns into nodes of the mesh when all are known.
  std::vector<std::uint32_t> use(const std::vector<std::uint64_t>& numbers, std::size_t per_element,
                                 const Place& place_of_element) {
    std::vector<std::uint32_t> positions = resolve(raw_, order_, numbers, per_element, place_of_element);
    for (const std::uint32_t n : positions) renumbered_[n] = 0;
    return positions;
  }

  std::vector<Vec3> nodes() {
    std::vector<Vec3> nodes;
    for (std::size_t n = 0; n < order_.size(); ++n) {
      if (renumbered_[n] == no_index) continue;
      if (!raw_.nodes[order_[n]].allFinite())
        throw InvalidInput({"coordinate is not a finite number", place_of_node_(order_[n]), {}, {}, {}});
      renumbered_[n] = static_cast<std::uint32_t>(nodes.size());
      nodes.push_back(raw_.nodes[order_[n]]);
    }
    return nodes;
  }

  // Of those that are used, in the order of the mesh.
  std::vector<std::uint64_t> numbers() const {
    std::vector<std::uint64_t> numbers;
    for (std::size_t n = 0; n < order_.size(); ++n)
      if (renumbered_[n] != no_index) numbers.push_back(raw_.node_numbers[order_[n]]);
    return numbers;
  }

  std::uint32_t index_of(std::uint32_t position) const { return renumbered_[position]; }

  // What `number` is in the mesh; nothing where no element uses it.
  std::optional<std::uint32_t> find(std::uint64_t number) const {
    const auto it = std::lower_bound(order_.begin(), order_.end(), number, [&](std::uint32_t n, std::uint64_t wanted) {
      return raw_.node_numbers[n] < wanted;
    });
    if (it == order_.end() || raw_.node_numbers[*it] != number) return {};
    const std::uint32_t index = renumbered_[static_cast<std::size_t>(it - order_.begin())];
    if (index == no_index) return {};
    return index;
  }

 private:
  const RawMesh& raw_;
  const Place& place_of_node_;
  std::vector<std::uint32_t> order_, renumbered_;
};

TetMesh tetrahedra_of(const RawMesh& raw, NodeMap& map, const Place& place_of_element) {
  const std::vector<std::uint32_t> corners = map.use(raw.corners, 4, place_of_element);
  const std::vector<std::uint32_t> mid_edges = map.use(raw.mid_edges, 6, place_of_element);
  TetMesh mesh;
  mesh.nodes = map.nodes();
  mesh.tetrahedra.resize(corners.size() / 4);
  for (std::size_t i = 0; i < corners.size(); ++i) mesh.tetrahedra[i / 4][i % 4] = map.index_of(corners[i]);
  mesh.mid_edge_nodes.resize(mid_edges.size() / 6);
  for (std::size_t i = 0; i < mid_edges.size(); ++i) mesh.mid_edge_nodes[i / 6][i % 6] = map.index_of(mid_edges[i]);
  require_distinct(mesh, place_of_element);
  ElementFaces faces = find_element_faces(mesh.tetrahedra);
  if (faces.overlapping)
    throw InvalidInput({.what = "elements lie in one another: a face is that of three, or an element is there twice",
                        .where = place_of_element((*faces.overlapping)[0]),
                        .value = "and " + place_of_element((*faces.overlapping)[1]),
                        .limit = {},
                        .advice = "leaving out elements that are there twice"});
  mesh.boundary = std::move(faces.boundary);
  mesh.unit = raw.unit;
  return mesh;
}

// Nothing where the numbers are 1, 2, ..., or not one for each.
std::vector<std::uint64_t> numbers_of_note(std::vector<std::uint64_t> numbers, std::size_t count) {
  if (numbers.size() != count) return {};
  bool is_plain = true;
  for (std::size_t i = 0; i < count; ++i) is_plain = is_plain && numbers[i] == i + 1;
  if (is_plain) return {};
  std::vector<std::uint64_t> sorted = numbers;
  std::ranges::sort(sorted);
  const bool is_unique = std::ranges::adjacent_find(sorted) == sorted.end() && sorted.front() > 0;
  return is_unique ? std::move(numbers) : std::vector<std::uint64_t>();
}

// What a scan may have, triangles that repeat a corner among it, is left to the repair.
NamedSurface surface_of(const RawMesh& raw, NodeMap& map, const Place& place_of_element) {
  const std::vector<std::uint32_t> corners = map.use(raw.triangles, 3, place_of_element);
  NamedSurface surface;
  surface.mesh.vertices = map.nodes();
  surface.mesh.triangles.resize(corners.size() / 3);
  for (std::size_t i = 0; i < corners.size(); ++i) surface.mesh.triangles[i / 3][i % 3] = map.index_of(corners[i]);
  surface.unit = raw.unit;
  return surface;
}

}  // namespace

void RawMesh::add_tetrahedron(std::uint64_t number, std::span<const std::uint64_t> of_file) {
  corners.insert(corners.end(), of_file.begin(), of_file.begin() + 4);
  mid_edges.insert(mid_edges.end(), of_file.begin() + 4, of_file.end());
  tetrahedron_numbers.push_back(number);
}

std::vector<std::uint64_t>& members_of(std::vector<RawSet>& sets, const std::string& name) {
  const auto it = std::find_if(sets.begin(), sets.end(), [&](const RawSet& s) { return s.name == name; });
  if (it != sets.end()) return it->members;
  return sets.emplace_back(RawSet{name, {}}).members;
}

MeshFile assemble(const RawMesh& raw, const std::filesystem::path& file, const Place& place_of_node,
                  const Place& place_of_element) {
  const std::size_t elements = raw.corners.size() / 4, triangles = raw.triangles.size() / 3;
  const auto fail = [&](std::string what) { throw InvalidInput({std::move(what), file.string(), {}, {}, {}}); };
  if (elements == 0 && triangles == 0) fail("holds no tetrahedra and no triangles");
  if (raw.nodes.size() >= no_index || elements >= no_index / 4 || triangles >= no_index / 4)
    fail("holds more than 2^30 elements");
  if (!raw.mid_edges.empty() && raw.mid_edges.size() != 6 * elements)
    fail("holds tetrahedra of first and of second order");

  NodeMap map(raw, place_of_node);
  MeshFile read;
  const auto node = [&](std::uint64_t number) { return map.find(number); };
  if (elements > 0) {
    TetMesh& mesh = read.mesh.emplace<TetMesh>(tetrahedra_of(raw, map, place_of_element));
    add_sets(raw, node, mesh, read.warnings);
  } else {
    NamedSurface& surface = read.mesh.emplace<NamedSurface>(surface_of(raw, map, place_of_element));
    add_sets(raw, node, surface, read.warnings);
  }
  read.has_own_numbers = raw.has_own_numbers;
  read.numbers.elements = elements > 0 ? numbers_of_note(raw.tetrahedron_numbers, elements)
                                       : numbers_of_note(raw.triangle_numbers, triangles);
  if (raw.has_own_numbers) {
    std::vector<std::uint64_t> of_nodes = map.numbers();
    const std::size_t nodes = of_nodes.size();
    read.numbers.nodes = numbers_of_note(std::move(of_nodes), nodes);
  }
  if (raw.passed_over > 0)
    read.warnings.push_back(std::to_string(raw.passed_over) + " elements are neither tetrahedra nor triangles");
  return read;
}

MeshFile assemble(const RawMesh& raw, const std::filesystem::path& file) {
  const auto number = [](const std::vector<std::uint64_t>& numbers, std::size_t i) {
    return std::to_string(i < numbers.size() ? numbers[i] : i + 1);
  };
  const std::vector<std::uint64_t>& elements = raw.corners.empty() ? raw.triangle_numbers : raw.tetrahedron_numbers;
  return assemble(
      raw, file, [&](std::size_t n) { return file.string() + ": node " + number(raw.node_numbers, n); },
      [&](std::size_t e) { return file.string() + ": element " + number(elements, e); });
}

}  // namespace scan2fea
