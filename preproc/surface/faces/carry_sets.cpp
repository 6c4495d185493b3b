#include "preproc/surface/faces/carry_sets.hpp"

#include "preproc/mesh/union_find.hpp"
#include "quality/triangle_tree.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace scan2fea {
namespace {

using Index = std::uint32_t;

constexpr double share_of_one = 0.9;

std::vector<Index> pieces_between(const SurfaceMesh& surface, std::span<const FeatureEdge> lines) {
  const std::vector<Triangle> neighbours = face_neighbours(surface, VertexStars(surface));
  UnionFind sets(surface.triangles.size());
  for (Index f = 0; f < neighbours.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const Triangle& t = surface.triangles[f];
      const Index g = neighbours[f][k];
      if (g == no_face || g < f) continue;
      if (!std::binary_search(lines.begin(), lines.end(), feature_edge(t[(k + 1) % 3], t[(k + 2) % 3])))
        sets.unite(f, g);
    }
  std::vector<Index> piece(surface.triangles.size());
  for (Index f = 0; f < piece.size(); ++f) piece[f] = sets.find(f);
  return piece;
}

// Areas by label.
using Votes = std::map<Index, double>;

Index most_of(const Votes& votes) {
  return std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

}  // namespace

std::vector<Index> carry_labels(const SurfaceMesh& scan, std::span<const Index> label, const SurfaceMesh& surface,
                                std::span<const FeatureEdge> lines) {
  // Inside the triangle, off its border, which may be that of a label.
  constexpr std::array<std::array<double, 3>, 4> places{
      {{1.0 / 3, 1.0 / 3, 1.0 / 3}, {0.6, 0.2, 0.2}, {0.2, 0.6, 0.2}, {0.2, 0.2, 0.6}}};
  const TriangleTree tree(scan);
  const std::vector<Index> piece = pieces_between(surface, lines);
  std::map<Index, Votes> of_piece;
  std::vector<Index> result(surface.triangles.size());
  std::uint32_t hint = 0;
  for (Index f = 0; f < result.size(); ++f) {
    const auto& [a, b, c] = surface.triangles[f];
    Votes own;
    const double area = area_vector(surface, surface.triangles[f]).norm();
    for (const auto& [u, v, w] : places) {
      const Vec3 p = u * surface.vertices[a] + v * surface.vertices[b] + w * surface.vertices[c];
      hint = tree.closest(p, hint).triangle;
      own[label[hint]] += area;
      of_piece[piece[f]][label[hint]] += area;
    }
    result[f] = most_of(own);
  }
  for (Index f = 0; f < result.size(); ++f) {
    const Votes& votes = of_piece[piece[f]];
    double sum = 0;
    for (const auto& vote : votes) sum += vote.second;
    if (const Index most = most_of(votes); votes.at(most) >= share_of_one * sum) result[f] = most;
  }
  return result;
}

}  // namespace scan2fea
