#include "export/partition.hpp"

#include "export/run_metis.hpp"
#include "preproc/mesh/element_faces.hpp"
#include "preproc/mesh/error.hpp"

#include <algorithm>
#include <numeric>

namespace scan2fea {
namespace {

// METIS leaves parts empty where there are few elements for each.
constexpr std::size_t fewest_elements_of_a_part = 16;

[[noreturn]] void refuse(std::string what, std::uint64_t value, std::string limit, std::string advice) {
  throw WrongUsage({.what = std::move(what),
                    .where = "--parts",
                    .value = std::to_string(value),
                    .limit = std::move(limit),
                    .advice = std::move(advice)});
}

Graph dual_graph(const std::vector<Tetrahedron>& tetrahedra) {
  Graph graph;
  graph.first.reserve(tetrahedra.size() + 1);
  graph.neighbours.reserve(4 * tetrahedra.size());
  graph.first.push_back(0);
  for (const std::array<std::uint32_t, 4>& across : element_neighbours(tetrahedra)) {
    for (const std::uint32_t t : across)
      if (t != no_element) graph.neighbours.push_back(static_cast<std::int32_t>(t));
    graph.first.push_back(static_cast<std::int32_t>(graph.neighbours.size()));
  }
  return graph;
}

struct Walk {
  std::vector<std::int32_t> order;  // all vertices, each piece breadth first from its first one on
  std::size_t pieces = 0;           // that do not hang together
};

Walk walk_through(const Graph& graph) {
  Walk walk;
  std::vector<bool> is_met(static_cast<std::size_t>(graph.size()), false);
  walk.order.reserve(is_met.size());
  const auto meet = [&](std::int32_t v) {
    if (is_met[static_cast<std::size_t>(v)]) return;
    is_met[static_cast<std::size_t>(v)] = true;
    walk.order.push_back(v);
  };
  std::size_t next = 0;
  for (std::int32_t seed = 0; seed < graph.size(); ++seed) {
    if (is_met[static_cast<std::size_t>(seed)]) continue;
    ++walk.pieces;
    for (meet(seed); next < walk.order.size(); ++next) {
      const auto v = static_cast<std::size_t>(walk.order[next]);
      for (std::int32_t i = graph.first[v]; i < graph.first[v + 1]; ++i)
        meet(graph.neighbours[static_cast<std::size_t>(i)]);
    }
  }
  return walk;
}

std::vector<std::uint32_t> blocks_of(const std::vector<std::int32_t>& order, std::size_t parts) {
  std::vector<std::uint32_t> part(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    part[static_cast<std::size_t>(order[i])] = static_cast<std::uint32_t>(i * parts / order.size());
  return part;
}

std::vector<std::uint32_t> sizes_of(const std::vector<std::uint32_t>& part, std::size_t parts) {
  std::vector<std::uint32_t> sizes(parts, 0);
  for (const std::uint32_t p : part) ++sizes[p];
  return sizes;
}

}  // namespace

void require_partition(std::uint64_t elements, std::uint64_t parts) {
  if (parts == 0) refuse("a mesh has at least one part", parts, "1", "a number of processes");
  if (parts > elements)
    refuse("more parts than tetrahedra", parts, std::to_string(elements), "fewer parts, or smaller tetrahedra");
  const std::uint64_t most = largest_metis_number() / 4;  // each element has four neighbours
  if (elements > most)
    refuse("more tetrahedra than METIS counts", elements, std::to_string(most),
           "a single file, which the solver divides itself");
}

std::vector<std::uint32_t> partition(const std::vector<Tetrahedron>& tetrahedra, std::size_t parts) {
  require_partition(tetrahedra.size(), parts);
  if (parts == 1) return std::vector<std::uint32_t>(tetrahedra.size(), 0);
  Graph graph = dual_graph(tetrahedra);
  const Walk walk = walk_through(graph);
  if (tetrahedra.size() / parts < fewest_elements_of_a_part) return blocks_of(walk.order, parts);
  std::vector<std::uint32_t> part = run_metis(graph, static_cast<std::int32_t>(parts), walk.pieces == 1);
  const bool has_empty_part = std::ranges::count(sizes_of(part, parts), 0U) > 0;
  return has_empty_part ? blocks_of(walk.order, parts) : part;
}

std::vector<std::uint32_t> order_by_parts(TetMesh& mesh, std::size_t parts) {
  const std::vector<std::uint32_t> part = partition(mesh.tetrahedra, parts);
  std::vector<std::uint32_t> origin(part.size()), place(part.size());
  std::iota(origin.begin(), origin.end(), 0U);
  std::ranges::stable_sort(origin, {}, [&](std::uint32_t t) { return part[t]; });
  for (std::uint32_t i = 0; i < origin.size(); ++i) place[origin[i]] = i;
  const auto reordered = [&]<class T>(const std::vector<T>& of_elements) {
    std::vector<T> result;
    result.reserve(of_elements.size());
    for (const std::uint32_t t : origin) result.push_back(of_elements[t]);
    return result;
  };
  mesh.tetrahedra = reordered(mesh.tetrahedra);
  if (mesh.order() == 2) mesh.mid_edge_nodes = reordered(mesh.mid_edge_nodes);
  for (BoundaryFace& face : mesh.boundary) face.tetrahedron = place[face.tetrahedron];
  for (NamedSet& set : mesh.element_sets) {
    for (std::uint32_t& t : set.members) t = place[t];
    std::ranges::sort(set.members);
  }
  return sizes_of(part, parts);
}

std::vector<MeshPart> parts_of(const TetMesh& mesh, std::span<const std::uint32_t> sizes) {
  const auto whole = static_cast<std::uint32_t>(mesh.tetrahedra.size());
  const std::span<const std::uint32_t> given = sizes.empty() ? std::span(&whole, 1) : sizes;
  if (std::accumulate(given.begin(), given.end(), std::uint64_t{0}) != whole)
    throw WrongUsage(
        {"the parts are of another mesh", {}, {}, std::to_string(whole) + " tetrahedra", "order_by_parts"});
  std::vector<MeshPart> parts;
  std::vector<std::uint32_t> part_of;  // of each element
  part_of.reserve(whole);
  for (const std::uint32_t size : given) {
    MeshPart part{
        .first_element = static_cast<std::uint32_t>(part_of.size()), .elements = size, .nodes = {}, .faces = {}};
    part_of.resize(part_of.size() + size, static_cast<std::uint32_t>(parts.size()));
    for (std::uint32_t t = part.first_element; t < part_of.size(); ++t) {
      part.nodes.insert(part.nodes.end(), mesh.tetrahedra[t].begin(), mesh.tetrahedra[t].end());
      if (mesh.order() == 2)
        part.nodes.insert(part.nodes.end(), mesh.mid_edge_nodes[t].begin(), mesh.mid_edge_nodes[t].end());
    }
    std::ranges::sort(part.nodes);
    part.nodes.erase(std::unique(part.nodes.begin(), part.nodes.end()), part.nodes.end());
    parts.push_back(std::move(part));
  }
  for (std::uint32_t f = 0; f < mesh.boundary.size(); ++f)
    parts[part_of[mesh.boundary[f].tetrahedron]].faces.push_back(f);
  return parts;
}

std::size_t shared_nodes(std::size_t nodes, std::span<const MeshPart> parts) {
  std::vector<std::uint32_t> times(nodes, 0);
  for (const MeshPart& part : parts)
    for (const std::uint32_t n : part.nodes) ++times[n];
  return static_cast<std::size_t>(std::ranges::count_if(times, [](std::uint32_t t) { return t > 1; }));
}

}  // namespace scan2fea
