#include "preproc/bodies/contact_gap.hpp"

#include "preproc/surface/kernel/adjacency.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace scan2fea {

std::optional<Gap> find_gap(const SurfaceMesh& mesh, std::span<const std::uint32_t> triangles, const FacingSurface& own,
                            const FacingSurface& other, double tolerance, double reach) {
  // By triangle: the widest place, and whether the other surface faces it and touches it.
  std::vector<std::optional<Gap>> widest(mesh.triangles.size());
  std::vector<bool> touches(mesh.triangles.size(), false);
  for (const std::uint32_t f : triangles) {
    const Triangle& t = mesh.triangles[f];
    for (const Vec3& p : {centroid(mesh, t), mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}) {
      const auto foot = other.under(p, own.normal(f), reach);
      if (!foot) continue;
      touches[f] = touches[f] || std::abs(foot->height) <= tolerance;
      if (!widest[f] || foot->height > widest[f]->height) widest[f] = Gap{foot->height, p, f, foot->triangle};
    }
  }
  const MeshAdjacency adjacency(mesh);
  std::vector<bool> reached(mesh.triangles.size(), false);
  std::optional<Gap> gap;
  for (const std::uint32_t seed : triangles) {
    if (reached[seed] || !widest[seed]) continue;
    std::vector<std::uint32_t> piece{seed};
    reached[seed] = true;
    bool is_joined = false;
    Gap of_piece = *widest[seed];
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const std::uint32_t f = piece[i];
      is_joined = is_joined || touches[f];
      if (widest[f]->height > of_piece.height) of_piece = *widest[f];
      for (const std::uint32_t n : adjacency.neighbours[f]) {
        if (n == no_face || reached[n] || !widest[n] || own.normal(n).dot(own.normal(f)) < facing) continue;
        reached[n] = true;
        piece.push_back(n);
      }
    }
    if (!is_joined && of_piece.height > tolerance && (!gap || of_piece.height > gap->height)) gap = of_piece;
  }
  return gap;
}

}  // namespace scan2fea
