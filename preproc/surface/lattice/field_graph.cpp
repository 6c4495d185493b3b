#include "preproc/surface/lattice/field_graph.hpp"

#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/parallel_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scan2fea {
namespace {

constexpr std::uint32_t no_node = std::numeric_limits<std::uint32_t>::max();
// The number of nodes at which coarsening ends: so few cost nothing to solve.
constexpr std::size_t coarse_enough = 100;
// Cosine of 70 degrees: nodes whose normals turn more from one another are not joined.
constexpr double same_side_cosine = 0.342;

double cotangent(const Vec3& apex, const Vec3& a, const Vec3& b) {
  const Vec3 u = a - apex, v = b - apex;
  const double area = u.cross(v).norm();
  return area > 0 ? u.dot(v) / area : 0.0;
}

// Half-edges bucketed by origin: entry i of vertex v is a half-edge from v to `neighbours[i]`. At borders the half-edge
// from the far end is missing and is added, so that every edge is there from both ends.
void connect(const SurfaceMesh& mesh, GraphLevel& level) {
  const std::size_t n = mesh.vertices.size();
  std::vector<Triangle> extra;  // (from, to) of the missing half-edges, apex of the triangle
  std::vector<float> own;       // half the cotangent of the angle opposite, from the half-edge's own triangle
  for (const bool with_borders : {false, true}) {
    level.first.assign(n + 1, 0);
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t) ++level.first[v + 1];
    for (const Triangle& e : extra) ++level.first[e[0] + 1];
    for (std::size_t v = 0; v < n; ++v) level.first[v + 1] += level.first[v];
    level.neighbours.resize(level.first[n]);
    own.assign(level.first[n], 0.0F);
    std::vector<std::uint32_t> apex(level.first[n], no_node);
    std::vector<std::uint32_t> next(level.first.begin(), level.first.end() - 1);
    for (const Triangle& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t slot = next[t[k]]++;
        level.neighbours[slot] = t[(k + 1) % 3];
        apex[slot] = t[(k + 2) % 3];
      }
    for (const Triangle& e : extra) level.neighbours[next[e[0]]++] = e[1];
    for_each_block(n, [&](std::size_t first, std::size_t last) {
      for (std::size_t v = first; v < last; ++v)
        for (std::uint32_t i = level.first[v]; i < level.first[v + 1]; ++i)
          if (apex[i] != no_node)
            own[i] = static_cast<float>(
                0.5 * cotangent(mesh.vertices[apex[i]], mesh.vertices[v], mesh.vertices[level.neighbours[i]]));
    });
    if (with_borders) break;
    for (std::uint32_t v = 0; v < n; ++v)
      for (std::uint32_t i = level.first[v]; i < level.first[v + 1]; ++i) {
        const std::uint32_t w = level.neighbours[i];
        const auto begin = level.neighbours.begin() + level.first[w],
                   end = level.neighbours.begin() + level.first[w + 1];
        if (std::find(begin, end, v) == end) extra.push_back({w, v, apex[i]});
      }
    if (extra.empty()) break;
  }
  level.weights.resize(own.size());
  for_each_block(n, [&](std::size_t first, std::size_t last) {
    for (std::size_t v = first; v < last; ++v)
      for (std::uint32_t i = level.first[v]; i < level.first[v + 1]; ++i) {
        const std::uint32_t mate = level.mate(static_cast<std::uint32_t>(v), i);
        // Obtuse pairs have negative weights, which would push neighbours apart.
        level.weights[i] = std::clamp(own[i] + own[mate], 0.05F, 5.0F);
      }
  });
}

GraphLevel finest_level(const RefinedScan& scan) {
  GraphLevel level;
  level.positions = scan.mesh.vertices;
  level.normals = vertex_normals(scan.mesh);
  level.areas.assign(scan.mesh.vertices.size(), 0.0);
  for (const Triangle& t : scan.mesh.triangles) {
    const double third = area_vector(scan.mesh, t).norm() / 6;
    for (const std::uint32_t v : t) level.areas[v] += third;
  }
  // Vertices with needles alone around them have no area; means over areas then still have a value.
  const double least = 1e-9 * surface_area(scan.mesh) / static_cast<double>(level.areas.size());
  for (double& a : level.areas) a = std::max(a, least);
  level.log_length.resize(scan.edge_length.size());
  for (std::size_t v = 0; v < level.log_length.size(); ++v) level.log_length[v] = std::log(scan.edge_length[v]);
  connect(scan.mesh, level);
  return level;
}

// Edges weigh about 0.6, so that the features' own directions hold against all their neighbours: a lattice that turns
// away from its borders costs 0.03 in the mean edge ratio.
constexpr double guide_weight = 20;

void tie_to_features(const Anchors& anchors, GraphLevel& level) {
  level.anchor = anchors.sample_of_node;
  level.guide.assign(level.size(), 0);
  for (const NodeTangent& t : anchors.tangents) {
    const Complex along = TangentFrame(level.normals[t.node]).coordinates(t.along);
    const double size = length(along);
    if (size > 0) level.guide[t.node] += size * sixth_power(along / size);
  }
  for (Complex& g : level.guide)
    if (g != Complex(0)) g = guide_weight * unit(g);
}

// Nodes of an independent set that cannot be enlarged become the coarse nodes; the others join one of them.
void aggregate(GraphLevel& fine, std::uint32_t& coarse_count) {
  const std::size_t n = fine.size();
  fine.parent.assign(n, no_node);
  std::vector<bool> covered(n, false);
  coarse_count = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    if (covered[i]) continue;
    fine.parent[i] = coarse_count++;
    for (std::uint32_t e = fine.first[i]; e < fine.first[i + 1]; ++e) covered[fine.neighbours[e]] = true;
    covered[i] = true;
  }
  std::vector<bool> is_root(n);
  for (std::size_t i = 0; i < n; ++i) is_root[i] = fine.parent[i] != no_node;
  for (std::uint32_t i = 0; i < n; ++i) {
    if (is_root[i]) continue;
    float strongest = 0;
    for (std::uint32_t e = fine.first[i]; e < fine.first[i + 1]; ++e) {
      const std::uint32_t j = fine.neighbours[e];
      if (!is_root[j] || fine.weights[e] <= strongest) continue;
      if (fine.normals[i].dot(fine.normals[j]) < same_side_cosine) continue;
      strongest = fine.weights[e];
      fine.parent[i] = fine.parent[j];
    }
    if (fine.parent[i] == no_node) fine.parent[i] = coarse_count++;
  }
}

// The members of each coarse node, as one array with offsets.
struct Members {
  Members(const GraphLevel& fine, std::uint32_t coarse_count) : first(coarse_count + 1, 0), nodes(fine.size()) {
    for (const std::uint32_t p : fine.parent) ++first[p + 1];
    for (std::size_t c = 0; c < coarse_count; ++c) first[c + 1] += first[c];
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::uint32_t i = 0; i < fine.size(); ++i) nodes[next[fine.parent[i]]++] = i;
  }
  std::span<const std::uint32_t> of(std::size_t c) const { return {nodes.data() + first[c], first[c + 1] - first[c]}; }

  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> nodes;
};

void coarse_edges(const GraphLevel& fine, const Members& members, GraphLevel& coarse) {
  const std::size_t n = coarse.size();
  std::vector<std::uint32_t> slot_of(n, no_node);
  coarse.first.assign(1, 0);
  coarse.first.reserve(n + 1);
  for (std::uint32_t c = 0; c < n; ++c) {
    const std::size_t begin = coarse.neighbours.size();
    for (const std::uint32_t i : members.of(c))
      for (std::uint32_t e = fine.first[i]; e < fine.first[i + 1]; ++e) {
        const std::uint32_t d = fine.parent[fine.neighbours[e]];
        if (d == c) continue;
        if (slot_of[d] == no_node) {
          slot_of[d] = static_cast<std::uint32_t>(coarse.neighbours.size());
          coarse.neighbours.push_back(d);
          coarse.weights.push_back(0);
        }
        coarse.weights[slot_of[d]] += fine.weights[e];
      }
    for (std::size_t s = begin; s < coarse.neighbours.size(); ++s) slot_of[coarse.neighbours[s]] = no_node;
    coarse.first.push_back(static_cast<std::uint32_t>(coarse.neighbours.size()));
  }
}

// A coarse node takes the nearest of the anchors below it, and the sum of the guides.
void inherit_ties(const std::vector<Vec3>& places, const GraphLevel& fine, const Members& members, GraphLevel& coarse) {
  coarse.anchor.assign(coarse.size(), no_sample);
  coarse.guide.assign(coarse.size(), 0);
  for (std::size_t c = 0; c < coarse.size(); ++c) {
    const TangentFrame here(coarse.normals[c]);
    double nearest = std::numeric_limits<double>::infinity();
    for (const std::uint32_t i : members.of(c)) {
      if (fine.guide[i] != Complex(0))
        coarse.guide[c] += fine.guide[i] * sixth_power(transport(TangentFrame(fine.normals[i]), here));
      if (fine.anchor[i] == no_sample) continue;
      const double distance = (places[fine.anchor[i]] - coarse.positions[c]).squaredNorm();
      if (distance >= nearest) continue;
      nearest = distance;
      coarse.anchor[c] = fine.anchor[i];
    }
  }
}

GraphLevel coarser_level(const std::vector<Vec3>& places, GraphLevel& fine) {
  std::uint32_t count = 0;
  aggregate(fine, count);
  const Members members(fine, count);
  GraphLevel coarse;
  coarse.positions.assign(count, Vec3::Zero());
  coarse.normals.assign(count, Vec3::Zero());
  coarse.areas.assign(count, 0.0);
  coarse.log_length.assign(count, 0.0);
  for_each_block(count, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c) {
      for (const std::uint32_t i : members.of(c)) {
        const double area = fine.areas[i];
        coarse.areas[c] += area;
        coarse.positions[c] += area * fine.positions[i];
        coarse.normals[c] += area * fine.normals[i];
        coarse.log_length[c] += area * fine.log_length[i];
      }
      coarse.positions[c] /= coarse.areas[c];
      coarse.log_length[c] /= coarse.areas[c];
      coarse.normals[c].normalize();
    }
  });
  coarse_edges(fine, members, coarse);
  if (!fine.anchor.empty()) inherit_ties(places, fine, members, coarse);
  return coarse;
}

}  // namespace

FieldGraph build_field_graph(const RefinedScan& scan, const Anchors& anchors) {
  FieldGraph graph;
  graph.levels.push_back(finest_level(scan));
  if (!anchors.empty()) {
    tie_to_features(anchors, graph.levels.front());
    for (const FeatureSample& sample : anchors.samples) graph.anchors.push_back(sample.position);
  }
  while (graph.levels.back().size() > coarse_enough) {
    GraphLevel coarse = coarser_level(graph.anchors, graph.levels.back());
    if (10 * coarse.size() > 9 * graph.levels.back().size()) {  // many small components
      graph.levels.back().parent.clear();
      break;
    }
    graph.levels.push_back(std::move(coarse));
  }
  return graph;
}

void restrict_log_length(FieldGraph& graph) {
  for (std::size_t l = 0; l + 1 < graph.levels.size(); ++l) {
    const GraphLevel& fine = graph.levels[l];
    GraphLevel& coarse = graph.levels[l + 1];
    coarse.log_length.assign(coarse.size(), 0.0);
    for (std::size_t i = 0; i < fine.size(); ++i)
      coarse.log_length[fine.parent[i]] += fine.areas[i] * fine.log_length[i];
    for (std::size_t c = 0; c < coarse.size(); ++c) coarse.log_length[c] /= coarse.areas[c];
  }
}

}  // namespace scan2fea
