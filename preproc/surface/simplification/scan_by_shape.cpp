#include "preproc/surface/simplification/scan_by_shape.hpp"

#include "preproc/surface/features/feature_selection.hpp"
#include "preproc/surface/features/find_features.hpp"
#include "preproc/surface/features/match_features.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/components.hpp"
#include "preproc/surface/kernel/micro_edges.hpp"
#include "preproc/surface/kernel/nearest.hpp"
#include "preproc/surface/sizing/shape_lengths.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

// Of the smallest body's diagonal. Features that are smaller than the least edges are for nobody; what is shorter than
// micro edges are is an accident.
constexpr double shortest_edge = 0.001, micro_edge = 2e-5;
// The scan's edges, over the wanted ones: see longest_edge_of_part in simplify.cpp.
constexpr double longest_scan_edge = 1.5;
// Areas between creases that have room for fewer triangles are joined: a square of one strip's width has room for two.
constexpr double least_triangles = 1.5;
// Of the lengths, over the surface's own: at that, short edges along a narrow strip would take the faces beside it.
constexpr double gradation = 2;

// What was wanted of the scan, at the vertices of another mesh of the same surface.
std::vector<double> wanted_at(const SurfaceMesh& mesh, const PreparedScan& scan, const SizingOptions& sizing) {
  const std::vector<double> wanted = scan.wanted_lengths(sizing);
  const std::vector<std::uint32_t> near =
      nearest_vertices(mesh.vertices, vertex_normals(mesh), scan.mesh, mean_edge_length(scan.mesh));
  std::vector<double> length;
  for (const std::uint32_t v : near) length.push_back(wanted[v]);
  return length;
}

}  // namespace

ScanByShape prepare_by_shape(const PreparedScan& scan, const SizingOptions& sizing, const SimplifyOptions& options,
                             double most_triangles) {
  const double diagonal = body_sizes(scan.given).smallest;
  const double longest = equilateral_edge(surface_area(scan.given), sizing.triangles);
  auto mesh = std::make_shared<SurfaceMesh>(without_micro_edges(scan.given, micro_edge * diagonal));
  std::vector<FeatureEdge> creases = options.given_features
                                         ? match_features(*mesh, VertexStars(*mesh), *options.given_features)
                                         : find_features(*mesh, options.features).edges;
  std::vector<double> length = part_by_shape(*mesh, creases, longest_scan_edge,
                                             std::min(longest, shortest_edge * diagonal), longest, most_triangles);
  std::sort(creases.begin(), creases.end());
  const std::vector<double> wanted = wanted_at(*mesh, scan, sizing);
  for (std::size_t v = 0; v < length.size(); ++v) length[v] = std::min(length[v], wanted[v]);
  limit_gradation(*mesh, gradation * sizing.gradation, length);
  const double triangles = predicted_triangles(*mesh, {length});
  if (triangles > most_triangles)
    for (double& l : length) l *= std::sqrt(triangles / most_triangles);
  if (!options.given_features || options.may_drop_given)
    creases = select_features(*mesh, std::move(creases), length, {.least_triangles = least_triangles});
  const CurveTolerance tolerance = scan.features().tolerance;
  KeptLines lines;
  if (!options.kept_lines.segments.empty()) lines.edges = match_features(*mesh, VertexStars(*mesh), options.kept_lines);
  for (const FeatureEdge& e : lines.edges) lines.smooth += !std::ranges::binary_search(creases, e);
  return {std::make_shared<const PreparedScan>(scan.given, std::move(mesh), std::move(creases), tolerance,
                                               std::move(lines)),
          std::move(length)};
}

}  // namespace scan2fea
