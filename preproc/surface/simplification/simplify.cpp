#include "preproc/surface/simplification/simplify.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/features/feature_selection.hpp"
#include "preproc/surface/features/match_features.hpp"
#include "preproc/surface/simplification/deviation_search.hpp"
#include "preproc/surface/simplification/error_sizing.hpp"
#include "preproc/surface/simplification/shape_search.hpp"
#include "preproc/surface/simplification/surface_candidate.hpp"
#include "preproc/surface/sizing/split_long_edges.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace scan2fea {
namespace {

// Of a scan with creases, over the result's mean edge.
constexpr double longest_edge_of_part = 1.5;

// The scan's mean face over the result's, above which its edges are halved, too.
constexpr double largest_face = 0.3;

// Where few triangles are asked for, make_shaped_surface may want to make about so many.
constexpr double triangles_of_small_part = 4000;

// How far the result's edges may be from the curves: of the diagonal, and over the scan's noise.
constexpr double curve_tolerance = 0.00014;
constexpr double noise_on_curves = 1.5;

// Of the edge lengths' renewal, over the local error (see error_factors).
constexpr double error_renewal = 0.3;

void require_positive(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value))
    throw WrongUsage({.what = std::string(what) + " must be above 0",
                      .where = {},
                      .value = std::to_string(value),
                      .limit = {},
                      .advice = {}});
}

// A deviation far below the scan's own facets asks for more; nothing is known there.
double most_triangles_of(const SurfaceMesh& scan) {
  return 32 * static_cast<double>(scan.triangles.size());
}

double wanted_faces(const TargetSize& size, const SurfaceMesh& scan) {
  if (const auto* count = std::get_if<FaceCount>(&size)) return static_cast<double>(count->faces);
  if (const auto* ratio = std::get_if<FaceRatio>(&size))
    return ratio->of_input * static_cast<double>(scan.triangles.size());
  const double length = std::get<MeanEdgeLength>(size).length;
  require_positive(length, "the edge length");
  return surface_area(scan) / (equilateral_area * length * length);
}

// Of the result, about.
double typical_edge(const TargetSize& size, const SurfaceMesh& scan) {
  if (const auto* bound = std::get_if<LargestDeviation>(&size)) {
    require_positive(bound->distance, "the deviation");
    const double shortest = equilateral_edge(surface_area(scan), most_triangles_of(scan));
    return std::max(first_edge_over_deviation * bound->distance, shortest);
  }
  return equilateral_edge(surface_area(scan), std::max(wanted_faces(size, scan), fewest_faces));
}

// Those that the result is to keep; what was found is told.
Features features_to_keep(const SurfaceMesh& mesh, const SimplifyOptions& options, double edge,
                          SimplifyResult& result) {
  Features features;
  if (options.method == SimplifyMethod::lattice) {
    features = find_features(mesh, options.given_features ? FeatureOptions{.angle_deg = {}} : options.features);
    if (options.given_features) features.edges = match_features(mesh, *options.given_features);
  }
  result.feature_edges = features.edges.size();
  result.features = lines_of(mesh, features.edges);
  if (!options.given_features) features.edges = select_features(mesh, std::move(features.edges), edge);
  return features;
}

CurveTolerance tolerance_of_curves(const SurfaceMesh& mesh, const TargetSize& size, double noise) {
  CurveTolerance tolerance{
      .least = std::max(curve_tolerance * bounding_box(mesh.vertices).diagonal(), noise_on_curves * noise)};
  if (const auto* bound = std::get_if<LargestDeviation>(&size))
    tolerance.largest = curves_over_deviation * bound->distance;
  return tolerance;
}

// Faces of CAD are far larger than the result's, and so are a scan's where more triangles are asked for than it has;
// searches for what is near want them alike. Nothing where the scan's own are fine enough.
std::optional<SurfaceMesh> with_smaller_faces(const SurfaceMesh& mesh, const SimplifyOptions& options, double edge,
                                              std::vector<FeatureEdge>& features) {
  const double area = surface_area(mesh);
  const bool few_faces =
      options.method == SimplifyMethod::lattice && !std::holds_alternative<LargestDeviation>(options.size) &&
      area > equilateral_area * edge * edge * largest_face * static_cast<double>(mesh.triangles.size());
  if (features.empty() && options.limits.empty() && !few_faces) return {};
  const double finest = options.for_tetrahedra ? equilateral_edge(area, triangles_of_small_part) : edge;
  SurfaceMesh parted = mesh;
  std::vector<double> length(mesh.vertices.size(), std::min(edge, finest));
  halve_long_edges(parted, length, features, longest_edge_of_part, longest_edge_of_part);
  refine_within_limits(parted, features, options.limits);
  return parted;
}

// Lowers the lengths that the sizing asks for, and asks for those. Keeps a reference to `length`.
void keep_within(const PreparedScan& scan, const std::vector<double>& longest, const SimplifyOptions& options,
                 SizingOptions& sizing, std::vector<double>& length, SimplifyResult& result) {
  const double wanted = sizing.triangles;
  const bool keeps_count = !std::holds_alternative<MeanEdgeLength>(options.size);
  length = within_limits(scan.mesh, scan.wanted_lengths(sizing), longest, options.gradation,
                         keeps_count ? std::optional(wanted) : std::nullopt);
  ask_for_lengths(scan.mesh, length, sizing);
  if (keeps_count && sizing.triangles > 1.01 * wanted)
    result.size_remark = "boxes, balls and elements across walls need about " +
                         std::to_string(std::lround(sizing.triangles)) + " triangles instead of " +
                         std::to_string(std::lround(wanted));
}

SurfaceMesh make_surface_of(double triangles, PreparedScan& scan, const std::vector<double>& longest,
                            const SimplifyOptions& options, SimplifyResult& result, const Progress& progress) {
  SizingOptions sizing;
  sizing.triangles = triangles;
  sizing.sizing = options.sizing;
  sizing.gradation = options.gradation;
  std::vector<double> factors, length;
  if (options.sizing == Sizing::error) {
    // A quick first surface shows where edges of the curvature's lengths come too far from the scan.
    sizing.sizing = Sizing::curvature;
    const SurfaceMesh first = make_surface(scan, sizing, options, Effort::low, result, progress).mesh;
    factors = scan.by_vertex(error_factors(first, scan.reference(), error_renewal),
                             [](double a, double b) { return std::min(a, b); });
    sizing.factors = factors;
  }
  if (!longest.empty()) keep_within(scan, longest, options, sizing, length, result);
  Candidate candidate = options.for_tetrahedra ? make_shaped_surface(scan, sizing, options, result, progress)
                                               : make_surface(scan, sizing, options, options.effort, result, progress);
  if (!options.for_tetrahedra && result.method == SimplifyMethod::lattice)
    lower_worst(candidate, scan, options.effort, result, progress);
  if (const auto made = static_cast<double>(candidate.mesh.triangles.size()); made > 1.01 * sizing.triangles + 1)
    result.size_remark = "triangles of the wanted size cannot be well shaped everywhere: made " +
                         std::to_string(candidate.mesh.triangles.size()) + " instead of " +
                         std::to_string(std::lround(sizing.triangles));
  return std::move(candidate.mesh);
}

}  // namespace

SimplifyResult simplify(const SurfaceMesh& mesh, SurfaceMesh& surface, const SimplifyOptions& options,
                        const Progress& progress) {
  if (options.method == SimplifyMethod::collapse && !options.limits.empty())
    throw WrongUsage({.what = "boxes, balls and elements across walls need the lattice method",
                      .where = {},
                      .value = {},
                      .limit = {},
                      .advice = "--method lattice"});
  SimplifyResult result;
  result.faces_before = mesh.triangles.size();
  const double edge = typical_edge(options.size, mesh);
  Features features = features_to_keep(mesh, options, edge, result);
  const CurveTolerance tolerance = tolerance_of_curves(mesh, options.size, features.noise);
  const std::optional<SurfaceMesh> parted = with_smaller_faces(mesh, options, edge, features.edges);
  PreparedScan scan(parted ? *parted : mesh, std::move(features.edges), tolerance);
  std::vector<double> longest;
  if (!options.limits.empty()) longest = longest_edges(scan.mesh, options.limits, longest_edge_of_part * edge);
  if (const auto* bound = std::get_if<LargestDeviation>(&options.size)) {
    surface = make_surface_within(scan, *bound, most_triangles_of(mesh), longest, options, result, progress).mesh;
  } else {
    const double faces = wanted_faces(options.size, mesh);
    require_positive(faces, "the number of triangles");
    surface = make_surface_of(std::max(faces, fewest_faces), scan, longest, options, result, progress);
  }
  return result;
}

SimplifyResult simplify(SurfaceMesh& mesh, const SimplifyOptions& options, const Progress& progress) {
  SurfaceMesh surface;
  const SimplifyResult result = simplify(mesh, surface, options, progress);
  mesh = std::move(surface);
  return result;
}

}  // namespace scan2fea
