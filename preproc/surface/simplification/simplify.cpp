#include "preproc/surface/simplification/simplify.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/features/feature_selection.hpp"
#include "preproc/surface/features/match_features.hpp"
#include "preproc/surface/features/scan_noise.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
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

// A scan with creases is halved to edges of so many mean edges of the result: what looks for a vertex or a face near by
// finds one within an edge or two.
constexpr double longest_edge_of_part = 1.5;

// Where the scan's mean face has more than this part of the result's area, its edges are halved, too: with larger ones
// the lattice gave way.
constexpr double largest_face = 0.3;

// Where few triangles are asked for, make_shaped_surface may want to make about so many.
constexpr double triangles_of_small_part = 4000;

// How far the result's edges may be from the curves, of the diagonal: a chord of a circle with a radius of a tenth of
// it then spans 6 degrees at the most. Under noise the curves themselves are known no better than noise_on_curves times
// it.
constexpr double curve_tolerance = 0.00014;
constexpr double noise_on_curves = 1.5;

// Exponent of the local error in the edge lengths' renewal (see error_factors). Equal errors everywhere would take 0.5;
// less leaves shape to the gradation.
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

double wanted_faces(const TargetSize& size, const SurfaceMesh& scan, double area) {
  double faces = 0;
  if (const auto* count = std::get_if<FaceCount>(&size)) {
    faces = static_cast<double>(count->faces);
  } else if (const auto* ratio = std::get_if<FaceRatio>(&size)) {
    faces = ratio->of_input * static_cast<double>(scan.triangles.size());
  } else {
    const double length = std::get<MeanEdgeLength>(size).length;
    require_positive(length, "the edge length");
    faces = area / (equilateral_area * length * length);
  }
  require_positive(faces, "the number of triangles");
  return std::max(faces, fewest_faces);
}

// Of the result, about.
double typical_edge(const TargetSize& size, const SurfaceMesh& scan, double area) {
  if (const auto* bound = std::get_if<LargestDeviation>(&size)) {
    require_positive(bound->distance, "the deviation");
    return std::max(first_edge_over_deviation * bound->distance, equilateral_edge(area, most_triangles_of(scan)));
  }
  return equilateral_edge(area, wanted_faces(size, scan, area));
}

// Those of the scan that were found or given.
Features features_of(const SurfaceMesh& mesh, const SimplifyOptions& options) {
  if (options.method != SimplifyMethod::lattice) return {};
  if (!options.given_features) return find_features(mesh, options.features);
  const MeshAdjacency adjacency(mesh);
  return {match_features(mesh, adjacency.stars, *options.given_features), estimate_noise(mesh, adjacency)};
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
std::optional<SurfaceMesh> with_smaller_faces(const SurfaceMesh& mesh, const SimplifyOptions& options, double area,
                                              double edge, std::vector<FeatureEdge>& features) {
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

// A surface, and where it has more triangles than were asked for, why.
struct MadeSurface {
  Candidate candidate;
  std::string size_remark;
};

// Lowers the lengths that the sizing asks for, and asks for those. Keeps a reference to `length`. Returns a remark
// where they need more triangles.
std::string keep_within(const PreparedScan& scan, const std::vector<double>& longest, const SimplifyOptions& options,
                        SizingOptions& sizing, std::vector<double>& length) {
  const double wanted = sizing.triangles;
  const bool keeps_count = !std::holds_alternative<MeanEdgeLength>(options.size);
  length = within_limits(scan.mesh, scan.wanted_lengths(sizing), longest, options.gradation,
                         keeps_count ? std::optional(wanted) : std::nullopt);
  ask_for_lengths(scan.mesh, length, sizing);
  if (!keeps_count || sizing.triangles <= 1.01 * wanted) return {};
  return "boxes, balls and elements across walls need about " + std::to_string(std::lround(sizing.triangles)) +
         " triangles instead of " + std::to_string(std::lround(wanted));
}

MadeSurface make_surface_of(double triangles, PreparedScanPointer scan, const std::vector<double>& longest,
                            const SimplifyOptions& options, const Progress& progress) {
  SizingOptions sizing;
  sizing.triangles = triangles;
  sizing.sizing = options.sizing;
  sizing.gradation = options.gradation;
  std::vector<double> factors, length;
  if (options.sizing == Sizing::error) {
    // A quick first surface shows where edges of the curvature's lengths come too far from the scan.
    sizing.sizing = Sizing::curvature;
    const Candidate first = make_surface(scan, sizing, options, Effort::low, progress);
    scan = first.scan;  // creases that it could not keep are not asked for again
    factors = scan->by_vertex(error_factors(first.mesh, scan->reference(), error_renewal),
                              [](double a, double b) { return std::min(a, b); });
    sizing.factors = factors;
  }
  MadeSurface made;
  if (!longest.empty()) made.size_remark = keep_within(*scan, longest, options, sizing, length);
  if (options.for_tetrahedra) {
    made.candidate = make_shaped_surface(scan, sizing, options, progress);
  } else {
    made.candidate = make_surface(scan, sizing, options, options.effort, progress);
    if (made.candidate.method == SimplifyMethod::lattice) lower_worst(made.candidate, options.effort, progress);
  }
  if (static_cast<double>(made.candidate.faces()) > 1.01 * sizing.triangles + 1)
    made.size_remark = "triangles of the wanted size cannot be well shaped everywhere: made " +
                       std::to_string(made.candidate.faces()) + " instead of " +
                       std::to_string(std::lround(sizing.triangles));
  return made;
}

// What became of the creases that were to be kept.
std::string feature_remark(std::size_t wanted, std::size_t kept) {
  if (kept >= wanted) return {};
  const std::string too_large = "triangles of the wanted size are too large for the creases: ";
  if (kept == 0) return too_large + "none is kept";
  return too_large + std::to_string(wanted - kept) + " of " + std::to_string(wanted) + " edges of creases are not kept";
}

void check_options(const SimplifyOptions& options) {
  if (options.method == SimplifyMethod::collapse && !options.limits.empty())
    throw WrongUsage({.what = "boxes, balls and elements across walls need the lattice method",
                      .where = {},
                      .value = {},
                      .limit = {},
                      .advice = "--method lattice"});
}

}  // namespace

TargetSize in_model_units(const TargetSize& size, const BoundingBox& scan) {
  const auto* bound = std::get_if<LargestDeviation>(&size);
  if (bound == nullptr || bound->unit == LargestDeviation::Unit::model) return size;
  return LargestDeviation{.distance = bound->distance * scan.diagonal(), .required = bound->required};
}

SimplifyResult simplify(const SurfaceMesh& scan, SurfaceMesh& surface, const SimplifyOptions& options,
                        const Progress& progress) {
  check_options(options);
  const TargetSize size = in_model_units(options.size, bounding_box(scan.vertices));
  const double area = surface_area(scan);
  const double edge = typical_edge(size, scan, area);
  Features features = features_of(scan, options);
  SimplifyResult result;
  result.faces_before = scan.triangles.size();
  result.feature_edges = features.edges.size();
  result.features = lines_of(scan, features.edges);

  if (!options.given_features) features.edges = select_features(scan, std::move(features.edges), edge);
  const CurveTolerance tolerance = tolerance_of_curves(scan, size, features.noise);
  const std::optional<SurfaceMesh> parted = with_smaller_faces(scan, options, area, edge, features.edges);
  const auto prepared =
      std::make_shared<const PreparedScan>(parted ? *parted : scan, std::move(features.edges), tolerance);
  std::vector<double> longest;
  if (!options.limits.empty()) longest = longest_edges(prepared->mesh, options.limits, longest_edge_of_part * edge);
  const auto* bound = std::get_if<LargestDeviation>(&size);
  MadeSurface made =
      bound != nullptr
          ? MadeSurface{make_surface_within(prepared, *bound, most_triangles_of(scan), longest, options, progress), {}}
          : make_surface_of(wanted_faces(size, scan, area), prepared, longest, options, progress);

  const Candidate& candidate = made.candidate;
  result.method = candidate.method;
  result.fallback_reason = candidate.fallback_reason;
  result.faces_after = candidate.faces();
  result.crossings_mended = candidate.crossings_mended;
  result.largest_deviation = candidate.largest_deviation;
  result.feature_edges_kept = candidate.feature_edges();
  result.feature_remark = feature_remark(prepared->creases().size(), candidate.scan->creases().size());
  result.size_remark = std::move(made.size_remark);
  surface = std::move(made.candidate.mesh);
  return result;
}

SimplifyResult simplify(SurfaceMesh& mesh, const SimplifyOptions& options, const Progress& progress) {
  SurfaceMesh surface;
  SimplifyResult result = simplify(mesh, surface, options, progress);
  mesh = std::move(surface);
  return result;
}

}  // namespace scan2fea
