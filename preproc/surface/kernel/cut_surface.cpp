#include "preproc/surface/kernel/cut_surface.hpp"

#include "preproc/mesh/union_find.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace scan2fea {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

bool contains(const std::vector<FeatureEdge>& sorted, const FeatureEdge& edge) {
  return std::binary_search(sorted.begin(), sorted.end(), edge);
}

// A side of a face along an edge, and where its ends are among the corners: corner 3 f + k is face f at its k-th
// vertex.
struct Side {
  FeatureEdge edge;
  std::uint32_t corner_of_first, corner_of_second;
};

}  // namespace

CutSurface cut_along(const SurfaceMesh& mesh, std::span<const FeatureEdge> edges) {
  CutSurface result{.mesh = mesh, .vertex_of_copy = std::vector<std::uint32_t>(mesh.vertices.size())};
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) result.vertex_of_copy[v] = v;
  if (edges.empty()) return result;

  std::vector<FeatureEdge> cuts(edges.begin(), edges.end());
  std::sort(cuts.begin(), cuts.end());
  std::vector<bool> on_cut(mesh.vertices.size(), false);
  for (const FeatureEdge& e : cuts) on_cut[e[0]] = on_cut[e[1]] = true;

  // Corners on cuts hang together over the edges that are not cut.
  std::vector<Side> sides;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[f][k], b = mesh.triangles[f][(k + 1) % 3];
      if (!on_cut[a] && !on_cut[b]) continue;
      const FeatureEdge edge = feature_edge(a, b);
      if (contains(cuts, edge)) continue;
      const std::uint32_t at_a = 3 * f + k, at_b = 3 * f + (k + 1) % 3;
      sides.push_back(a < b ? Side{edge, at_a, at_b} : Side{edge, at_b, at_a});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
    return s.edge != t.edge ? s.edge < t.edge : s.corner_of_first < t.corner_of_first;
  });
  UnionFind corners(3 * mesh.triangles.size());
  for (std::size_t i = 1; i < sides.size(); ++i) {
    if (sides[i].edge != sides[i - 1].edge) continue;
    corners.unite(sides[i].corner_of_first, sides[i - 1].corner_of_first);
    corners.unite(sides[i].corner_of_second, sides[i - 1].corner_of_second);
  }
  // A set's root is its smallest corner, so it is met first.
  std::vector<std::uint32_t> copy_of_root(3 * mesh.triangles.size(), none);
  std::vector<bool> taken(mesh.vertices.size(), false);
  for (std::uint32_t c = 0; c < copy_of_root.size(); ++c) {
    std::uint32_t& corner = result.mesh.triangles[c / 3][c % 3];
    const std::uint32_t v = mesh.triangles[c / 3][c % 3];
    if (!on_cut[v]) continue;
    const std::uint32_t root = corners.find(c);
    if (root == c) {
      copy_of_root[c] = v;
      if (taken[v]) {
        copy_of_root[c] = static_cast<std::uint32_t>(result.mesh.vertices.size());
        result.mesh.vertices.push_back(mesh.vertices[v]);
        result.vertex_of_copy.push_back(v);
      }
      taken[v] = true;
    }
    corner = copy_of_root[root];
  }
  return result;
}

std::vector<FeatureEdge> boundary_edges(const SurfaceMesh& mesh) {
  // Half-edges by the vertex that they start at; one is at a border if none goes back.
  std::vector<std::uint32_t> first(mesh.vertices.size() + 1, 0), ends(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) ++first[v + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ends[next[t[k]]++] = t[(k + 1) % 3];
  std::vector<FeatureEdge> border;
  for (std::uint32_t a = 0; a < mesh.vertices.size(); ++a)
    for (std::uint32_t i = first[a]; i < first[a + 1]; ++i) {
      const std::uint32_t b = ends[i];
      if (std::find(ends.begin() + first[b], ends.begin() + first[b + 1], a) == ends.begin() + first[b + 1])
        border.push_back(feature_edge(a, b));
    }
  std::sort(border.begin(), border.end());
  return border;
}

}  // namespace scan2fea
