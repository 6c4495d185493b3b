#include "preproc/surface/simplification/fine_creases.hpp"

#include "preproc/surface/features/feature_selection.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <algorithm>
#include <iterator>

namespace scan2fea {
namespace {

// The parts of an edge whose halves were halved, and so on: they lie on it.
void add_parts(const FeatureEdge& edge, const SurfaceMesh& mesh, const VertexStars& stars,
               std::vector<FeatureEdge>& parts) {
  const Vec3& end = mesh.vertices[edge[1]];
  for (std::uint32_t v = edge[0]; v != edge[1];) {
    std::uint32_t next = v;
    double best = -1;
    for (const std::uint32_t corner : stars.corners(v))
      for (const std::uint32_t w : mesh.triangles[corner / 3]) {
        if (w == v) continue;
        const double cosine =
            (mesh.vertices[w] - mesh.vertices[v]).normalized().dot((end - mesh.vertices[v]).normalized());
        if (cosine > best) {
          best = cosine;
          next = w;
        }
      }
    parts.push_back(feature_edge(v, next));
    v = next;
  }
}

}  // namespace

PreparedScanPointer FineCreases::with_those_kept_by(std::span<const double> edge_length,
                                                    const PreparedScanPointer& scan) {
  if (left_out_.empty()) return scan;
  std::vector<FeatureEdge> all;
  std::ranges::merge(kept_, left_out_, std::back_inserter(all));
  const std::vector<FeatureEdge> selected =
      select_features(scan->given, std::move(all), edge_length.first(scan->given.vertices.size()));
  std::vector<FeatureEdge> back, still_out;
  std::ranges::set_intersection(left_out_, selected, std::back_inserter(back));
  if (back.empty()) return scan;
  std::ranges::set_difference(left_out_, back, std::back_inserter(still_out));
  left_out_ = std::move(still_out);
  std::vector<FeatureEdge> creases = scan->creases();
  const VertexStars stars(scan->mesh);
  for (const FeatureEdge& edge : back) add_parts(edge, scan->mesh, stars, creases);
  std::ranges::sort(creases);
  std::vector<FeatureEdge> kept;
  std::ranges::merge(kept_, back, std::back_inserter(kept));
  kept_ = std::move(kept);
  return with_creases(scan, std::move(creases));
}

}  // namespace scan2fea
