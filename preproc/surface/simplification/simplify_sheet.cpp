#include "preproc/surface/simplification/simplify_sheet.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/features/feature_selection.hpp"
#include "preproc/surface/features/find_features.hpp"
#include "preproc/surface/kernel/components.hpp"
#include "preproc/surface/kernel/cut_surface.hpp"
#include "preproc/surface/simplification/plane_patches.hpp"
#include "preproc/surface/simplification/prepared_scan.hpp"
#include "preproc/surface/simplification/surface_candidate.hpp"
#include "preproc/surface/simplification/surface_on_scan.hpp"
#include "preproc/surface/sizing/even_planes.hpp"
#include "preproc/surface/sizing/split_long_edges.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <array>
#include <memory>

namespace scan2fea {
namespace {

// As for scans, see simplify.cpp.
constexpr double longest_scan_edge = 1.5, curve_tolerance = 0.00014, curves_over_deviation = 0.9;

constexpr double rounding = 2e-6;  // of the diagonal; of a border's vertices half as much, see interface_sheets.cpp

// Whether halving long edges makes many times the triangles that the area needs.
bool would_be_needles(const SurfaceMesh& sheet, double limit) {
  constexpr double many = 4;
  double halved = 0;
  for (const Triangle& t : sheet.triangles) {
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(longest, (sheet.vertices[t[k]] - sheet.vertices[t[(k + 1) % 3]]).norm());
    halved += std::max(1.0, longest / limit);
  }
  const double needed = surface_area(sheet) / (equilateral_area * limit * limit);
  return halved > many * (needed + static_cast<double>(sheet.triangles.size()));
}

std::vector<double> wanted_lengths(const SurfaceMesh& sheet, const std::vector<FeatureEdge>& creases,
                                   double edge_length, const SimplifyOptions& options) {
  std::vector<double> length(sheet.vertices.size(), edge_length);
  if (const auto* bound = std::get_if<LargestDeviation>(&options.size)) {
    const CutSurface cut = cut_along(sheet, creases);
    const std::vector<double> bent = lengths_for_deviation(sheet, bound->distance, 0, options.gradation, &cut);
    for (std::size_t v = 0; v < length.size(); ++v) length[v] = std::min(length[v], bent[v]);
  }
  limit_gradation(sheet, options.gradation, length);
  return length;
}

// The border's vertices as places, sorted.
std::vector<std::array<double, 3>> places(const SurfaceMesh& mesh, const std::vector<bool>* held) {
  std::vector<std::array<double, 3>> found;
  for (const auto& edge : boundary_edges(mesh))
    for (const std::uint32_t v : edge)
      if (held == nullptr || (v < held->size() && (*held)[v])) {
        const Vec3& p = mesh.vertices[v];
        found.push_back({p.x(), p.y(), p.z()});
      }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace

SimplifiedSheet simplify_sheet(const SurfaceMesh& sheet, const std::vector<bool>& held, double edge_length,
                               const SimplifyOptions& options, const Progress& progress) {
  if (places(sheet, &held).size() < 3)
    throw NotMeshable({.what = "the border of a surface between two bodies was lost",
                       .where = {},
                       .value = {},
                       .limit = {},
                       .advice = "smaller triangles (--deviation, --faces)",
                       .at = sheet.vertices.front()});
  std::vector<FeatureEdge> creases = find_features(sheet, options.features).edges;
  std::sort(creases.begin(), creases.end());
  creases = select_features(sheet, creases, edge_length);
  auto parted = std::make_shared<SurfaceMesh>(sheet);
  const double limit = longest_scan_edge * edge_length;
  if (would_be_needles(sheet, limit))
    *parted = with_even_planes(sheet, limit, rounding * bounding_box(sheet.vertices).diagonal());
  std::vector<double> longest(parted->vertices.size(), edge_length);
  halve_long_edges(*parted, longest, creases, longest_scan_edge, longest_scan_edge);
  std::sort(creases.begin(), creases.end());
  const std::vector<double> length = wanted_lengths(*parted, creases, edge_length, options);
  SizingOptions sizing;
  sizing.gradation = options.gradation;
  sizing.keeps_count = false;
  ask_for_lengths(*parted, length, sizing);
  CurveTolerance tolerance{.least = curve_tolerance * body_sizes(sheet).smallest};
  if (const auto* bound = std::get_if<LargestDeviation>(&options.size))
    tolerance.largest = curves_over_deviation * bound->distance;
  const auto prepared =
      std::make_shared<const PreparedScan>(sheet, std::shared_ptr<const SurfaceMesh>(parted), std::move(creases),
                                           tolerance, KeptLines{.edges = {}, .smooth = 0, .held_border = held});
  Candidate made =
      make_surface(prepared, sizing, options, options.effort, {.by_shape = false, .contraction = false}, progress);
  if (made.failure.empty() && flatten_plane_patches(made.mesh, made.net, made.scan->reference()) > 0)
    made.failure = "what is plane would lie folded";
  if (made.failure.empty() && places(made.mesh, nullptr) != places(sheet, &held))
    made.failure = "its border did not stay";
  if (!made.failure.empty())
    throw NotMeshable({.what = "no valid surface between two bodies: " + made.failure,
                       .where = {},
                       .value = {},
                       .limit = {},
                       .advice = "smaller triangles (--deviation, --faces)",
                       .at = sheet.vertices.front()});
  SimplifiedSheet result{.mesh = std::move(made.mesh), .on_border = {}, .on_line = {}, .on_scan = {}};
  result.on_line = vertices_on_lines(made.net, result.mesh.vertices.size());
  result.on_border.resize(result.mesh.vertices.size(), false);
  for (const auto& edge : boundary_edges(result.mesh))
    for (const std::uint32_t v : edge) result.on_border[v] = true;
  result.on_scan = std::make_shared<const SurfaceOnScan>(std::move(made.scan), std::move(made.net));
  return result;
}

}  // namespace scan2fea
