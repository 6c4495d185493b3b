#include "preproc/volume/mid_edge_nodes.hpp"

#include "quality/jacobian_bound.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace scan2fea {
namespace {

struct Edge {
  std::uint32_t low, high;  // corner nodes
  std::uint32_t tetrahedron, local;

  bool same_ends(const Edge& other) const { return low == other.low && high == other.high; }
};

// A boundary edge by its mid-edge node: where it is straight, and where the scan has it.
struct BoundaryEdge {
  std::uint32_t node;
  double length;
  Vec3 straight;
  std::array<std::uint32_t, 2> ends;  // corner nodes, the smaller one first
};

std::vector<BoundaryEdge> boundary_edges(const TetMesh& mesh) {
  std::vector<BoundaryEdge> edges;
  for (const BoundaryFace f : mesh.boundary) {
    const auto& corners = tetrahedron_faces[f.face];
    for (std::size_t e = 0; e < 6; ++e) {
      const auto [a, b] = tetrahedron_edges[e];
      if (std::find(corners.begin(), corners.end(), a) == corners.end() ||
          std::find(corners.begin(), corners.end(), b) == corners.end())
        continue;
      const Tetrahedron& t = mesh.tetrahedra[f.tetrahedron];
      const std::uint32_t i = t[static_cast<std::size_t>(a)], j = t[static_cast<std::size_t>(b)];
      const Vec3 &p = mesh.nodes[i], &q = mesh.nodes[j];
      edges.push_back(
          {mesh.mid_edge_nodes[f.tetrahedron][e], (q - p).norm(), (p + q) / 2, {std::min(i, j), std::max(i, j)}});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const BoundaryEdge& a, const BoundaryEdge& b) { return a.node < b.node; });
  edges.erase(std::unique(edges.begin(), edges.end(),
                          [](const BoundaryEdge& a, const BoundaryEdge& b) { return a.node == b.node; }),
              edges.end());
  return edges;
}

// A segment is a triangle without area.
std::optional<TriangleTree> tree_of(const ScanLines& lines) {
  if (lines.segments.empty()) return {};
  SurfaceMesh flat{lines.points, {}};
  for (const auto& [a, b] : lines.segments) flat.triangles.push_back({a, b, b});
  return TriangleTree(flat);
}

// The least Jacobian of an element over its straight one, from below.
double least_jacobian(const TetMesh& mesh, std::size_t t) {
  const Tetrahedron& c = mesh.tetrahedra[t];
  const Vec3& a = mesh.nodes[c[0]];
  const double straight = (mesh.nodes[c[1]] - a).cross(mesh.nodes[c[2]] - a).dot(mesh.nodes[c[3]] - a);
  return min_jacobian_bound(curved_tetrahedron(mesh, t)).lower / straight;
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

CurveResult curve_mid_edge_nodes(TetMesh& mesh, const TriangleTree& scan, const CurveOptions& options,
                                 const ScanLines& lines) {
  CurveResult result;
  const std::optional<TriangleTree> line_tree = tree_of(lines);
  const std::vector<BoundaryEdge> edges = boundary_edges(mesh);
  std::vector<bool> curved(mesh.nodes.size(), false);
  std::uint32_t hint = 0;
  for (const BoundaryEdge& edge : edges) {
    const bool on_line = line_tree && std::binary_search(lines.edges.begin(), lines.edges.end(), edge.ends);
    const ClosestPoint nearest = on_line ? line_tree->closest(edge.straight) : scan.closest(edge.straight, hint);
    if (!on_line) hint = nearest.triangle;
    if (std::sqrt(nearest.squared_distance) > options.largest_displacement * edge.length) {
      ++result.too_far;
      continue;
    }
    mesh.nodes[edge.node] = nearest.point;
    curved[edge.node] = true;
  }

  // Straightening an element may leave a neighbour one-sided, so until nothing changes. Straight elements are valid.
  std::vector<std::uint32_t> suspects;
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t)
    if (std::any_of(mesh.mid_edge_nodes[t].begin(), mesh.mid_edge_nodes[t].end(), [&](auto v) { return curved[v]; }))
      suspects.push_back(t);
  for (bool changed = true; changed;) {
    changed = false;
    result.least_jacobian = 1;
    for (const std::uint32_t t : suspects) {
      const double least = least_jacobian(mesh, t);
      if (least >= options.least_jacobian) {
        result.least_jacobian = std::min(result.least_jacobian, least);
        continue;
      }
      for (std::size_t e = 0; e < 6; ++e) {
        const std::uint32_t v = mesh.mid_edge_nodes[t][e];
        if (!curved[v]) continue;
        const auto [a, b] = tetrahedron_edges[e];
        mesh.nodes[v] = (mesh.nodes[mesh.tetrahedra[t][static_cast<std::size_t>(a)]] +
                         mesh.nodes[mesh.tetrahedra[t][static_cast<std::size_t>(b)]]) /
                        2;
        curved[v] = false;
        changed = true;
        ++result.invalid;
      }
    }
  }
  for (const BoundaryEdge& edge : edges)
    if (curved[edge.node]) {
      ++result.curved;
      result.largest_displacement =
          std::max(result.largest_displacement, (mesh.nodes[edge.node] - edge.straight).norm());
    }
  result.volume = total_volume(mesh);
  return result;
}

}  // namespace scan2fea
