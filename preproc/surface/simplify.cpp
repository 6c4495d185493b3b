#include "preproc/surface/simplify.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/clear_moves.hpp"
#include "preproc/surface/error_sizing.hpp"
#include "preproc/surface/feature_selection.hpp"
#include "preproc/surface/local_deviation.hpp"
#include "preproc/surface/local_refinement.hpp"
#include "preproc/surface/match_features.hpp"
#include "preproc/surface/refined_scan.hpp"
#include "preproc/surface/surface_candidate.hpp"
#include "quality/deviation_bound.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

constexpr double equilateral_area = 0.43301270189221932;  // of a triangle with edges of length 1
// A closed surface needs four faces; fewer than this and no shape is left of anything.
constexpr double fewest_faces = 4;

// Of a scan with creases, over the result's mean edge.
constexpr double longest_edge_of_part = 1.5;

// Edge length of the first surface within a deviation, over the deviation.
constexpr double first_edge = 12;

// How far the result's edges may be from the curves: of the diagonal, and over the scan's noise.
constexpr double curve_tolerance = 0.00014;
constexpr double noise_on_curves = 1.5;

// Where a deviation must hold, shape gives way first.
constexpr double least_angle_within_deg = 28;

// Of the largest deviation, where there is one.
constexpr double curves_within_deviation = 0.6;

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

// What the edge lengths leave too far is brought near place by place; then the exact volume. An upper bound of the
// deviation is returned.
double bring_within(SurfaceMesh& surface, PreparedScan& scan, double deviation, const Progress& progress) {
  constexpr double for_volume = 0.995;  // of the deviation: the rest is for the shift that restores the volume
  LocalRefinementOptions options;
  options.limit = for_volume * deviation;
  options.least_angle_deg = least_angle_within_deg;
  options.fidelity_of_diagonal = std::clamp(0.6 * deviation / scan.reference().diagonal, 0.0004, 0.0016);
  refine_within(surface, scan.reference(), options, progress);
  preserve_volume_clear(surface, scan.mesh);
  return bound_deviation(surface, scan.mesh, {.limit = deviation}).upper();
}

double share_beyond(const OneSidedDeviation& side, double distance) {
  const auto beyond = std::count_if(side.upper.begin(), side.upper.end(), [&](double d) { return d > distance; });
  return static_cast<double>(beyond) / static_cast<double>(side.upper.size());
}

// A deviation far below the scan's own facets asks for more; nothing is known there.
double most_triangles_of(const SurfaceMesh& scan) {
  return 32 * static_cast<double>(scan.triangles.size());
}

// The deviation of linear triangles goes with the edge length squared, place by place: a few surfaces are made, and the
// edge lengths renewed from how far each came from the scan there (bounds, not samples), until local refinement can do
// the rest.
Candidate make_surface_within(PreparedScan& scan, const LargestDeviation& wanted, double most_triangles,
                              const SimplifyOptions& options, SimplifyResult& result, const Progress& progress) {
  // With features the edge lengths must do it all: local refinement does not know of them.
  const int most_trials = scan.has_features() ? 16 : 5;
  constexpr double margin = 0.8;          // of the bound, aimed at
  constexpr double most_shrinking = 0.5;  // of an edge from trial to trial
  constexpr double most_growing = 2.8;    // after the first, whose lengths are a guess; later ones only shrink
  constexpr double shortest_edge = 0.5;   // over the deviation: shorter ones help nothing
  constexpr double few_beyond = 0.03;     // of the faces, for local refinement: more are cheaper mended all at once
  constexpr double most_beyond = 0.1;     // where there is no other way left
  std::vector<double> length(scan.mesh.vertices.size(), first_edge * wanted.distance);
  Candidate best;
  SimplifyResult best_result;
  for (int trial = 0; trial < most_trials; ++trial) {
    progress("deviation", static_cast<double>(trial) / most_trials);
    SizingOptions sizing;
    sizing.sizing = Sizing::uniform;
    sizing.gradation = options.gradation;
    sizing.triangles = std::clamp(predicted_triangles(scan.mesh, {length}), fewest_faces, most_triangles);
    sizing.smallest = 0.01;
    sizing.largest = 100;
    sizing.factors = length;  // only their ratios count: the number of triangles sets the scale
    Candidate surface =
        make_surface(scan, sizing, options, trial == 0 ? Effort::low : options.effort, result, progress);
    const DeviationBound bound = bound_deviation(surface.mesh, scan.mesh, {.limit = wanted.distance});
    const std::vector<double> deviation = scan.by_vertex(local_deviation(surface.mesh, scan.reference(), bound),
                                                         [](double a, double b) { return std::max(a, b); });
    result.largest_deviation = bound.upper();
    const bool last = trial + 1 == most_trials;
    if (trial > 0 && !scan.has_features() &&
        share_beyond(bound.to_reference, wanted.distance) <= (last ? most_beyond : few_beyond)) {
      result.largest_deviation = bring_within(surface.mesh, scan, wanted.distance, progress);
      result.faces_after = surface.mesh.triangles.size();
    }
    if (best.mesh.triangles.empty() || result.largest_deviation < best_result.largest_deviation) {
      best = std::move(surface);
      best_result = result;
    }
    if (trial > 0 && best_result.largest_deviation <= wanted.distance) break;
    for (std::size_t v = 0; v < length.size(); ++v) {
      const double ratio = std::sqrt(margin * wanted.distance / std::max(deviation[v], 1e-3 * wanted.distance));
      length[v] = std::max(length[v] * std::clamp(ratio, most_shrinking, trial == 0 ? most_growing : 1.0),
                           shortest_edge * wanted.distance);
    }
  }
  // The deviation that was asked for comes before the tetrahedra.
  Candidate opened = best;
  if (open_wedges(opened, scan, options)) {
    const double reached = bound_deviation(opened.mesh, scan.mesh, {.limit = wanted.distance}).upper();
    if (!wanted.required || reached <= wanted.distance) {
      best = std::move(opened);
      best_result.largest_deviation = reached;
    }
  }
  if (wanted.required && best_result.largest_deviation > wanted.distance)
    throw NotMeshable({.what = "the deviation was not reached",
                       .where = {},
                       .value = std::to_string(best_result.largest_deviation) + " with " +
                                std::to_string(best_result.faces_after) + " triangles",
                       .limit = std::to_string(wanted.distance),
                       .advice = "a larger --deviation, or --faces"});
  result = best_result;
  return best;
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
    return std::max(first_edge * bound->distance, shortest);
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
    tolerance.largest = curves_within_deviation * bound->distance;
  // Faces of CAD are far larger than the result's; searches for what is near want them alike.
  SurfaceMesh parted;
  if (!features.edges.empty()) {
    parted = mesh;
    std::vector<double> length(mesh.vertices.size(), edge);
    halve_long_edges(parted, length, features.edges, longest_edge_of_part, longest_edge_of_part);
  }
  const SurfaceMesh& whole = features.edges.empty() ? mesh : parted;
  PreparedScan scan(whole, std::move(features.edges), tolerance);
  result.faces_before = mesh.triangles.size();
  if (const auto* bound = std::get_if<LargestDeviation>(&options.size)) {
    surface = make_surface_within(scan, *bound, most_triangles_of(mesh), options, result, progress).mesh;
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
    Candidate candidate = make_surface(scan, sizing, options, options.effort, result, progress);
    if (result.method == SimplifyMethod::lattice) lower_worst(candidate, scan, options.effort, result, progress);
    open_wedges(candidate, scan, options);
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
