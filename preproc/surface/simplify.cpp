#include "preproc/surface/simplify.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/deviation_search.hpp"
#include "preproc/surface/error_sizing.hpp"
#include "preproc/surface/feature_selection.hpp"
#include "preproc/surface/match_features.hpp"
#include "preproc/surface/refined_scan.hpp"
#include "preproc/surface/shape_renewal.hpp"
#include "preproc/surface/surface_candidate.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

constexpr double equilateral_area = 0.43301270189221932;  // of a triangle with edges of length 1
// A closed surface needs four faces; fewer than this and no shape is left of anything.
constexpr double fewest_faces = 4;

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
    const double shortest = std::sqrt(surface_area(scan) / (equilateral_area * most_triangles_of(scan)));
    return std::max(first_edge_over_deviation * bound->distance, shortest);
  }
  return std::sqrt(surface_area(scan) / (equilateral_area * std::max(wanted_faces(size, scan), fewest_faces)));
}

}  // namespace

SimplifyResult simplify(const SurfaceMesh& mesh, SurfaceMesh& surface, const SimplifyOptions& options,
                        const Progress& progress) {
  SimplifyResult result;
  Features features;
  if (options.method == SimplifyMethod::lattice) {
    features = find_features(mesh, options.given_features ? FeatureOptions{.angle_deg = {}} : options.features);
    if (options.given_features) features.edges = match_features(mesh, *options.given_features);
  }
  result.feature_edges = features.edges.size();
  result.features = lines_of(mesh, features.edges);
  const double edge = typical_edge(options.size, mesh);
  if (!options.given_features) features.edges = select_features(mesh, std::move(features.edges), edge);
  CurveTolerance tolerance{
      .least = std::max(curve_tolerance * bounding_box(mesh.vertices).diagonal(), noise_on_curves * features.noise)};
  if (const auto* bound = std::get_if<LargestDeviation>(&options.size))
    tolerance.largest = curves_over_deviation * bound->distance;
  if (options.method == SimplifyMethod::collapse && !options.limits.empty())
    throw WrongUsage({.what = "boxes, balls and elements across walls need the lattice method",
                      .where = {},
                      .value = {},
                      .limit = {},
                      .advice = "--method lattice"});
  // Faces of CAD are far larger than the result's, and so are a scan's where more triangles are asked for than it has;
  // searches for what is near want them alike.
  SurfaceMesh parted;
  const bool has_large_faces =
      !features.edges.empty() || !options.limits.empty() ||
      (options.method == SimplifyMethod::lattice && !std::holds_alternative<LargestDeviation>(options.size) &&
       surface_area(mesh) > equilateral_area * edge * edge * largest_face * static_cast<double>(mesh.triangles.size()));
  if (has_large_faces) {
    parted = mesh;
    double edge_of_parts = edge;
    if (options.for_tetrahedra)
      edge_of_parts = std::min(edge, std::sqrt(surface_area(mesh) / (equilateral_area * triangles_of_small_part)));
    std::vector<double> length(mesh.vertices.size(), edge_of_parts);
    halve_long_edges(parted, length, features.edges, longest_edge_of_part, longest_edge_of_part);
    refine_within_limits(parted, features.edges, options.limits);
  }
  const SurfaceMesh& whole = has_large_faces ? parted : mesh;
  std::vector<double> longest;
  if (!options.limits.empty()) longest = longest_edges(whole, options.limits, longest_edge_of_part * edge);
  PreparedScan scan(whole, std::move(features.edges), tolerance);
  result.faces_before = mesh.triangles.size();
  if (const auto* bound = std::get_if<LargestDeviation>(&options.size)) {
    surface = make_surface_within(scan, *bound, most_triangles_of(mesh), longest, options, result, progress).mesh;
  } else {
    const double faces = wanted_faces(options.size, mesh);
    require_positive(faces, "the number of triangles");
    SizingOptions sizing;
    sizing.triangles = std::max(faces, fewest_faces);
    sizing.sizing = options.sizing;
    sizing.gradation = options.gradation;
    std::vector<double> factors;
    if (options.sizing == Sizing::error) {
      // A quick first surface shows where edges of the curvature's lengths come too far from the scan.
      sizing.sizing = Sizing::curvature;
      const SurfaceMesh first = make_surface(scan, sizing, options, Effort::low, result, progress).mesh;
      factors = scan.by_vertex(error_factors(first, scan.reference(), error_renewal),
                               [](double a, double b) { return std::min(a, b); });
      sizing.factors = factors;
    }
    std::vector<double> length;
    if (!longest.empty()) {
      const std::vector<double> wanted =
          compute_sizing_field(whole, sizing, scan.has_features() ? &scan.features().cut : nullptr).edge_length;
      const bool keeps_count = !std::holds_alternative<MeanEdgeLength>(options.size);
      length = within_limits(whole, wanted, longest, options.gradation,
                             keeps_count ? std::optional(sizing.triangles) : std::nullopt);
      ask_for_lengths(whole, length, sizing);
      if (keeps_count && sizing.triangles > 1.01 * faces)
        result.size_remark = "boxes, balls and elements across walls need about " +
                             std::to_string(std::lround(sizing.triangles)) + " triangles instead of " +
                             std::to_string(std::lround(faces));
    }
    const double asked = sizing.triangles;
    Candidate candidate = options.for_tetrahedra
                              ? make_shaped_surface(scan, sizing, options, result, progress)
                              : make_surface(scan, sizing, options, options.effort, result, progress);
    if (!options.for_tetrahedra && result.method == SimplifyMethod::lattice)
      lower_worst(candidate, scan, options.effort, result, progress);
    if (const auto made = static_cast<double>(candidate.mesh.triangles.size()); made > 1.01 * asked + 1)
      result.size_remark = "triangles of the wanted size cannot be well shaped everywhere: made " +
                           std::to_string(candidate.mesh.triangles.size()) + " instead of " +
                           std::to_string(std::lround(asked));
    surface = std::move(candidate.mesh);
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
