#include "preproc/surface/simplification/simplify.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/curved/fit_curves.hpp"
#include "preproc/surface/features/feature_selection.hpp"
#include "preproc/surface/features/match_features.hpp"
#include "preproc/surface/features/scan_noise.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/components.hpp"
#include "preproc/surface/simplification/surface_on_scan.hpp"
#include "preproc/surface/simplification/surface_search.hpp"
#include "preproc/surface/sizing/split_long_edges.hpp"
#include "preproc/surface/sizing/triangle_memory.hpp"
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

// How far the result's edges may be from the curves, of the smallest body's diagonal: a chord of a circle with a radius
// of a tenth of it then spans 6 degrees at the most. Under noise the curves themselves are known no better than
// noise_on_curves times it.
constexpr double curve_tolerance = 0.00014;
constexpr double noise_on_curves = 1.5;

// How far chords of the result may be from the scan's creases and borders, over the deviation: the mending of places
// leaves them as they are.
constexpr double curves_over_deviation = 0.9;

// Edge length of a result, over its deviation, about; see lengths_for_deviation.
constexpr double edge_over_deviation = 12;

void require_positive(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value))
    throw WrongUsage({.what = std::string(what) + " must be above 0",
                      .where = {},
                      .value = std::to_string(value),
                      .limit = {},
                      .advice = {}});
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
    return std::max(edge_over_deviation * bound->distance,
                    equilateral_edge(area, SurfaceSearch::most_of_scan * static_cast<double>(scan.triangles.size())));
  }
  return equilateral_edge(area, wanted_faces(size, scan, area));
}

// Those of the scan that were found or given.
Features features_of(const SurfaceMesh& mesh, const SimplifyOptions& options) {
  if (options.method != SimplifyMethod::lattice) return {};
  if (!options.given_features) return find_features(mesh, options.features);
  const MeshAdjacency adjacency(mesh);
  return {match_features(mesh, adjacency.stars, *options.given_features), estimate_noise(mesh, adjacency), {}};
}

// An aim that noise is beyond would be met by following it, vertex by vertex: half of the aim is left to the triangles,
// and on top of it comes how far the farthest of so many vertices are by chance. Returns the noise where that was done.
double allow_for_noise(const SurfaceMesh& scan, WantedSurface& wanted) {
  LargestDeviation& aim = *wanted.deviation;
  if (aim.required) return 0;
  const double noise = estimate_independent_noise(scan, VertexStars(scan));
  const double farthest = noise * std::sqrt(2 * std::log(static_cast<double>(scan.vertices.size())));
  wanted.left_to_noise = std::max(0.0, farthest - aim.distance / 2);
  aim.distance += wanted.left_to_noise;
  return wanted.left_to_noise > 0 ? noise : 0;
}

CurveTolerance tolerance_of_curves(const SurfaceMesh& mesh, const TargetSize& size, double noise) {
  CurveTolerance tolerance{.least = std::max(curve_tolerance * body_sizes(mesh).smallest, noise_on_curves * noise)};
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
  if (features.empty() && options.kept_lines.segments.empty() && options.limits.empty() && !few_faces) return {};
  const double finest = equilateral_edge(area, triangles_of_small_part);
  SurfaceMesh parted = mesh;
  std::vector<double> length(mesh.vertices.size(), std::min(edge, finest));
  halve_long_edges(parted, length, features, longest_edge_of_part, longest_edge_of_part);
  refine_within_limits(parted, features, options.limits);
  return parted;
}

// `creases`: sorted. Of the mesh that is to be simplified, which may be another one than the lines are of.
KeptLines lines_to_keep(const SurfaceMesh& mesh, const std::vector<FeatureEdge>& creases,
                        const SimplifyOptions& options) {
  KeptLines lines;
  if (options.method != SimplifyMethod::lattice || options.kept_lines.segments.empty()) return lines;
  lines.edges = match_features(mesh, VertexStars(mesh), options.kept_lines);
  for (const FeatureEdge& e : lines.edges) lines.smooth += !std::ranges::binary_search(creases, e);
  return lines;
}

// What became of the creases that were to be kept.
std::string feature_remark(std::size_t wanted, std::size_t kept, bool is_noisy) {
  if (kept >= wanted) return {};
  if (kept == 0 && is_noisy)
    return "noise hides where creases run, and triangles between them are poor: none is kept; "
           "of a part, --idealise all finds them by the shapes of its faces";
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

// What is kept from one surface to the next.
struct Simplification::State {
  const SurfaceMesh& scan;
  SimplifyOptions options;
  SimplifyResult of_scan = {};             // what is known before any surface is made
  std::optional<SurfaceMesh> parted = {};  // the scan with smaller faces, where it has large ones
  std::size_t wanted_creases = 0;
  double wanted_triangles = 0;  // 0 where the size is a deviation
  std::optional<SurfaceSearch> search = {};

  SimplifyResult result(Candidate candidate, SurfaceMesh& surface) const;
};

SimplifyResult Simplification::State::result(Candidate candidate, SurfaceMesh& surface) const {
  SimplifyResult result = of_scan;
  result.method = candidate.method;
  result.fallback_reason = candidate.fallback_reason;
  result.faces_after = candidate.faces();
  result.crossings_mended = candidate.crossings_mended;
  result.largest_deviation = candidate.largest_deviation;
  result.line_edges = edges_of(candidate.net);
  result.feature_edges_kept = result.line_edges.size();
  result.feature_remark = feature_remark(wanted_creases, candidate.scan->creases().size(), of_scan.noise_in_aim > 0);
  result.feature_edges_too_fine = search->too_fine_creases();
  result.size_remark = search->size_remark();
  const double made = static_cast<double>(candidate.faces());
  if (wanted_triangles > 0 && made > 1.01 * search->wanted_triangles() + 1)
    result.size_remark = "triangles of the wanted size cannot be well shaped everywhere: made " +
                         std::to_string(candidate.faces()) + " instead of " +
                         std::to_string(std::lround(wanted_triangles));
  result.on_scan = std::make_shared<const SurfaceOnScan>(std::move(candidate.scan), std::move(candidate.net));
  surface = std::move(candidate.mesh);
  return result;
}

Simplification::Simplification(const SurfaceMesh& scan, const SimplifyOptions& options)
    : state_(new State{.scan = scan, .options = options}) {
  check_options(options);
  State& state = *state_;
  const TargetSize size = in_model_units(options.size, bounding_box(scan.vertices));
  TargetSize straight_size = size;  // what that is of straight triangles
  if (auto* bound = std::get_if<LargestDeviation>(&straight_size); bound != nullptr && options.curved)
    bound->distance *= SurfaceSearch::least_straight_over_curved;
  const double area = surface_area(scan);
  const double edge = typical_edge(straight_size, scan, area);
  require_memory_of_triangles(area / (equilateral_area * edge * edge),
                              "a larger --edge-length or --deviation, or fewer --faces");
  Features features = features_of(scan, options);
  state.of_scan.faces_before = scan.triangles.size();
  state.of_scan.feature_edges = features.edges.size();
  for (const UnsupportedCreases& dropped : features.dropped) state.of_scan.feature_edges += dropped.edges;
  state.of_scan.unsupported_creases = std::move(features.dropped);
  state.of_scan.features = lines_of(scan, features.edges);

  std::vector<FeatureEdge> too_fine;
  if (!options.given_features || options.may_drop_given) {
    std::vector<FeatureEdge> all = std::move(features.edges);
    std::sort(all.begin(), all.end());
    features.edges = select_features(scan, all, edge);
    std::set_difference(all.begin(), all.end(), features.edges.begin(), features.edges.end(),
                        std::back_inserter(too_fine));
  }
  FineCreases fine_creases(features.edges, std::move(too_fine));
  const CurveTolerance tolerance = tolerance_of_curves(scan, straight_size, features.noise);
  state.parted = with_smaller_faces(scan, options, area, edge, features.edges);
  const SurfaceMesh& mesh = state.parted ? *state.parted : scan;
  std::sort(features.edges.begin(), features.edges.end());
  KeptLines lines = lines_to_keep(mesh, features.edges, options);
  const auto prepared =
      std::make_shared<const PreparedScan>(scan, mesh, std::move(features.edges), tolerance, std::move(lines));
  state.wanted_creases = prepared->creases().size();
  WantedSurface wanted;
  if (const auto* bound = std::get_if<LargestDeviation>(&size)) {
    wanted.deviation = *bound;
    state.of_scan.noise_in_aim = allow_for_noise(scan, wanted);
    wanted.is_of_curved = state.of_scan.is_of_curved = options.curved;
    state.of_scan.aimed_deviation = wanted.deviation->distance;
  } else {
    wanted.triangles = state.wanted_triangles = wanted_faces(size, scan, area);
  }
  if (!options.limits.empty())
    wanted.longest = longest_edges(prepared->mesh, options.limits, longest_edge_of_part * edge);
  PlanesOfScan planes = options.keep_planes ? PlanesOfScan(scan, features.noise, edge) : PlanesOfScan();
  state.search.emplace(prepared, std::move(fine_creases), std::move(planes), std::move(wanted), state.options);
}

Simplification::~Simplification() = default;

SimplifyResult Simplification::run(SurfaceMesh& surface, const Progress& progress) {
  if (!state_->of_scan.is_of_curved) return state_->result(state_->search->run(progress), surface);
  const Progress::Clock::time_point now = Progress::Clock::now();
  try {
    return state_->result(state_->search->run(progress.until(now + (progress.end() - now) / 4)), surface);
  } catch (const NotMeshable&) {  // for want of time, too
  }
  progress.explain("curved triangles come no nearer than straight ones, of which the surface is made");
  // What curved triangles have not reached, straight ones may: they are mended until they do.
  SimplifyOptions options = state_->options;
  options.curved = false;
  state_ = Simplification(state_->scan, options).state_;
  return run(surface, progress);
}

std::optional<SimplifyResult> Simplification::run_again(std::span<const ShorterEdges> places, double most_triangles,
                                                        SurfaceMesh& surface, const Progress& progress) {
  std::optional<Candidate> made = state_->search->run_again(places, most_triangles, progress);
  if (!made) return {};
  return state_->result(std::move(*made), surface);
}

std::optional<SimplifyResult> Simplification::run_moved(const std::vector<Vec3>& places, SurfaceMesh& surface) {
  std::optional<Candidate> moved = state_->search->run_moved(places);
  if (!moved) return {};
  return state_->result(std::move(*moved), surface);
}

std::vector<bool> Simplification::held() const {
  return state_->search->held();
}

double Simplification::way_off() const {
  return state_->search->way_off();
}

const PlanesOfScan& Simplification::planes() const {
  return state_->search->planes();
}

FittedCurves Simplification::curved(const SimplifyResult& result, const SurfaceMesh& surface, bool keep_corners,
                                    const Progress& progress) const {
  const PreparedScan& scan = *result.on_scan->scan;
  std::optional<KeptDeviation> kept;
  if (result.keeps_deviation()) kept.emplace(scan.deviation_reference(), result.aimed_deviation);
  return fit_curves(surface, result.on_scan->net, scan.reference(), state_->search->planes(), keep_corners,
                    kept ? &*kept : nullptr, progress);
}

SimplifyResult simplify(SurfaceMesh& mesh, const SimplifyOptions& options, const Progress& progress) {
  SurfaceMesh surface;
  SimplifyResult result = Simplification(mesh, options).run(surface, progress);
  result.on_scan.reset();  // it refers to what is gone
  mesh = std::move(surface);
  return result;
}

}  // namespace scan2fea
