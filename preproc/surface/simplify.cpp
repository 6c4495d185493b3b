#include "preproc/surface/simplify.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/clear_moves.hpp"
#include "preproc/surface/error_sizing.hpp"
#include "preproc/surface/feature_selection.hpp"
#include "preproc/surface/guard.hpp"
#include "preproc/surface/lattice.hpp"
#include "preproc/surface/local_deviation.hpp"
#include "preproc/surface/local_refinement.hpp"
#include "preproc/surface/match_features.hpp"
#include "preproc/surface/preserve_volume.hpp"
#include "preproc/surface/reference_surface.hpp"
#include "preproc/surface/refined_scan.hpp"
#include "preproc/surface/shape_fit.hpp"
#include "preproc/surface/wedges.hpp"
#include "quality/deviation_bound.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace scan2fea {
namespace {

constexpr double equilateral_area = 0.43301270189221932;  // of a triangle with edges of length 1
// A closed surface needs four faces; fewer than this and no shape is left of anything.
constexpr double fewest_faces = 4;
// Over the wanted edge length.
constexpr double longest_edge_to_contract = 1;

// Of a scan with creases, over the result's mean edge.
constexpr double longest_edge_of_part = 1.5;

// Edge length of the first surface within a deviation, over the deviation.
constexpr double first_edge = 12;

// Most fits reach it without the guard.
constexpr double least_angle_deg = 38.5;

// Of the diagonal, the dial between shape and fit at the least on parts with edges: most of them have plane faces and
// cylinders, which triangles can follow.
constexpr double fidelity_of_parts = 0.0003;

// How far the result's edges may be from the curves: of the diagonal, and over the scan's noise.
constexpr double curve_tolerance = 0.00015;
constexpr double noise_on_curves = 1.5;

// Where a deviation must hold, shape gives way first.
constexpr double least_angle_within_deg = 28;

// Of the fit, in which it finds out how near the triangles can come.
constexpr int first_rounds = 2;

// Of the edge lengths' renewal, over the local error (see error_factors).
constexpr double error_renewal = 0.3;

// What an effort buys. Trials differ by a little in the sizing, which lays another lattice: of several, the distances
// to the scan in the tightest folds differ by a third, so the best of them is worth having where time is no matter.
struct FitPlan {
  int rounds;
  double fidelity_of_diagonal;  // the dial between shape and fit, at the least
  double fidelity_of_residual;  // and over the RMS distance of the first fit
  int trials;
  bool lowers_worst;  // see lower_worst
};

FitPlan plan_of(Effort effort) {
  switch (effort) {
    case Effort::low:
      return {
          .rounds = 4, .fidelity_of_diagonal = 0.0013, .fidelity_of_residual = 7, .trials = 1, .lowers_worst = false};
    case Effort::normal:
      return {
          .rounds = 8, .fidelity_of_diagonal = 0.0012, .fidelity_of_residual = 7, .trials = 1, .lowers_worst = true};
    case Effort::high:
      return {.rounds = 12,
              .fidelity_of_diagonal = 0.00095,
              .fidelity_of_residual = 5.7,
              .trials = 5,
              .lowers_worst = true};
  }
  return {};
}

// The scan, and what the stages after the lattice ask of it: made when the first of them does, since beside the graph
// of the fields it would be the peak of the memory.
class Scan {
 public:
  // `sharp`: its creases.
  Scan(const SurfaceMesh& surface, std::vector<FeatureEdge> sharp, double tolerance_of_curves)
      : mesh(surface), features_(std::in_place, surface, std::move(sharp), tolerance_of_curves) {}

  const ReferenceSurface& reference() {
    if (!reference_) {
      if (has_features())
        reference_.emplace(*features_);
      else
        reference_.emplace(mesh);
    }
    return *reference_;
  }
  const FeatureScan& features() const { return *features_; }
  bool has_features() const { return !features_->empty(); }  // creases or borders
  bool has_creases() const { return !features_->sharp.empty(); }
  bool is_closed() const { return features_->border.empty(); }

  // From here on there are only these.
  void keep_creases(std::vector<FeatureEdge> sharp) {
    reference_.reset();
    features_.emplace(mesh, std::move(sharp), features_->curve_tolerance);
  }

  // What the reference's vertices have, by vertex of the scan: of the copies at a crease, the one that `wins`.
  template <class Wins>
  std::vector<double> by_vertex(std::vector<double> of_reference, const Wins& wins) const {
    const std::vector<std::uint32_t>& vertex = features_->cut.vertex_of_copy;
    for (std::size_t c = mesh.vertices.size(); c < of_reference.size(); ++c)
      of_reference[vertex[c]] = wins(of_reference[vertex[c]], of_reference[c]);
    of_reference.resize(mesh.vertices.size());
    return of_reference;
  }

  const SurfaceMesh& mesh;

 private:
  std::optional<FeatureScan> features_;
  std::optional<ReferenceSurface> reference_;
};

struct Candidate {
  SurfaceMesh mesh;
  FeatureNet net;
  std::size_t crossings_mended = 0;
  std::string failure;          // empty where `mesh` is valid
  std::vector<Vec3> failed_at;  // places of what is wrong
  ShapeFitResult fit;
};

std::string describe(const SurfaceDefects& defects) {
  return std::to_string(defects.crossings.size()) + " crossing pairs of faces and " +
         std::to_string(defects.inverted.size()) + " inverted faces remained";
}

// Exact volume, then the guard.
void finish(Candidate& candidate, Scan& scan, const GuardOptions& options, const Progress& progress) {
  try {
    GuardOptions guard = options;
    guard.least_angle_deg = least_angle_deg;
    guard.keep_volume = scan.is_closed();
    const GuardResult guarded = guard_surface(candidate.mesh, candidate.net, scan.reference(), guard, progress);
    candidate.crossings_mended = guarded.before.crossings.size();
    if (guarded.clean()) return;
    candidate.failure = describe(guarded.after);
    const auto centre = [&](std::uint32_t f) {
      const auto& [a, b, c] = candidate.mesh.triangles[f];
      return Vec3((candidate.mesh.vertices[a] + candidate.mesh.vertices[b] + candidate.mesh.vertices[c]) / 3);
    };
    for (const FacePair& pair : guarded.after.crossings) candidate.failed_at.push_back(centre(pair.face));
    for (const std::uint32_t f : guarded.after.inverted) candidate.failed_at.push_back(centre(f));
  } catch (const NotMeshable& e) {
    candidate.failure = e.parts().what;
  }
}

Candidate by_lattice(Scan& scan, const SizingOptions& sizing, const FitPlan& plan, double strength_factor,
                     const Progress& progress) {
  LatticeOptions lattice_options;
  lattice_options.sizing = sizing;
  lattice_options.sizing.strength *= strength_factor;
  LatticeResult lattice = scan.has_features() ? remesh_by_lattice(scan.features(), lattice_options, progress)
                                              : remesh_by_lattice(scan.mesh, lattice_options, progress);
  Candidate candidate;
  // Where features need more triangles than were asked for, they get them.
  candidate.failure = scan.has_features() ? "" : lattice.failure;
  if (!candidate.failure.empty()) return candidate;
  candidate.mesh = std::move(lattice.mesh);
  candidate.net = std::move(lattice.net);
  ShapeFitOptions fit;
  fit.rounds = first_rounds + plan.rounds;
  fit.hold_small_faces = sizing.sizing == Sizing::uniform && !sizing.factors.empty();
  fit.fidelity_of_diagonal = plan.fidelity_of_diagonal;
  fit.fidelity_of_residual = plan.fidelity_of_residual;
  if (scan.has_features()) {
    fit.fidelity_of_diagonal = fidelity_of_parts;
    fit.lift_tail_of_diagonal = *fit.lift_tail_of_diagonal * fidelity_of_parts / plan.fidelity_of_diagonal;
    fit.rounds_of_dialling = plan.rounds;
    fit.rounds = first_rounds + plan.rounds * 3 / 4;  // planes and cylinders are met soon
  }
  fit.nearest_vertex_of_scan_vertex = std::move(lattice.vertex_of_scan_vertex);
  candidate.fit = optimise_shape_and_fit(candidate.mesh, candidate.net, scan.reference(), fit, progress);
  GuardOptions guard;
  // On parts with edges, not much looser than the fit: what is plane stays plane.
  if (scan.has_features()) {
    guard.fidelity_of_diagonal = candidate.fit.fidelity_of_diagonal;
    guard.loosest_fidelity_of_diagonal = 2 * candidate.fit.fidelity_of_diagonal;
  }
  finish(candidate, scan, guard, progress);
  return candidate;
}

Candidate best_by_lattice(Scan& scan, const SizingOptions& sizing, Effort effort, const Progress& progress) {
  const FitPlan plan = plan_of(effort);
  if (plan.trials == 1) return by_lattice(scan, sizing, plan, 1, progress);
  constexpr double strength_step = 0.03;
  Candidate best, failed;
  double best_score = std::numeric_limits<double>::infinity();
  for (int trial = 0; trial < plan.trials; ++trial) {
    const double strength_factor = 1 + strength_step * (trial - (plan.trials - 1) / 2.0);
    Candidate candidate = by_lattice(scan, sizing, plan, strength_factor, progress);
    if (!candidate.failure.empty()) {
      failed = std::move(candidate);
      continue;
    }
    // All that is to be small, at once.
    const double score = (measure_triangles(candidate.mesh).edge_ratio.mean - 1) * candidate.fit.rms_distance *
                         candidate.fit.largest_distance;
    if (score >= best_score) continue;
    best = std::move(candidate);
    best_score = score;
  }
  return best.mesh.triangles.empty() ? failed : best;
}

// Where the lattice gives way: contractions towards the same sizing, none of which makes faces meet, then the same fit.
// Where the fit ends in crossings that the guard cannot mend, vertices go only as far towards it as nothing meets, and
// where the shape needs more triangles than were asked for, it keeps them: this way always ends in a sound surface.
Candidate by_contraction(Scan& scan, const SizingOptions& sizing, const Progress& progress) {
  // Long triangles, as CAD makes them, are no start for even ones.
  RefinedScan refined = refine_scan(scan.mesh, compute_sizing_field(scan.mesh, sizing), longest_edge_to_contract);
  Candidate contracted;
  contracted.mesh = std::move(refined.mesh);
  CollapseOptions collapse_options;
  collapse_options.target_faces = static_cast<std::size_t>(std::lround(sizing.triangles));
  collapse_options.cost = CollapseCost::sized_length;
  collapse_options.sizing = std::move(refined.edge_length);
  collapse_options.keep_clear = true;
  collapse(contracted.mesh, collapse_options, progress);

  Candidate fitted = contracted;
  ShapeFitOptions fit;
  fit.rounds = 12;
  if (!scan.is_closed()) {
    fit.constraints.resize(fitted.mesh.vertices.size(), VertexConstraint::free);
    for (const auto& [a, b] : boundary_edges(fitted.mesh))
      fit.constraints[a] = fit.constraints[b] = VertexConstraint::fixed;
  }
  fit.hold_small_faces = sizing.sizing == Sizing::uniform && !sizing.factors.empty();
  optimise_shape_and_fit(fitted.mesh, scan.reference(), fit, progress);
  const std::vector<Vec3> targets = fitted.mesh.vertices;
  finish(fitted, scan, {}, progress);
  if (fitted.failure.empty()) return fitted;

  SurfaceMesh near_fit = contracted.mesh;
  move_clear(near_fit, targets);
  if (!scan.is_closed() || preserve_volume_clear(near_fit, scan.mesh)) contracted.mesh = std::move(near_fit);
  return contracted;
}

// The paper's method as it is; only what passes through itself is mended.
Candidate by_collapse(Scan& scan, double faces, const SimplifyOptions& options, const Progress& progress) {
  CollapseOptions collapse_options = options.collapse;
  collapse_options.target_faces = static_cast<std::size_t>(std::lround(faces));
  Candidate candidate;
  candidate.mesh = scan.mesh;
  collapse(candidate.mesh, collapse_options, progress);
  GuardOptions guard;
  guard.least_angle_deg = 0;
  guard.keep_volume = false;
  const GuardResult guarded = guard_surface(candidate.mesh, scan.reference(), guard, progress);
  candidate.crossings_mended = guarded.before.crossings.size();
  // It may end in needles that turn over, as the paper's does; what is sound for a mesher crosses nothing.
  if (!guarded.after.crossings.empty()) candidate.failure = describe(guarded.after);
  return candidate;
}

// Gives up the short creases near the places where a surface failed: whether there were some.
bool drop_short_creases(Scan& scan, const Candidate& failed) {
  constexpr double longest = 0.5;  // of the diagonal: the folds of a scan, not the edges of a part
  constexpr double reach = 2;      // mean edges
  const double edge =
      std::sqrt(surface_area(failed.mesh) / (equilateral_area * static_cast<double>(failed.mesh.triangles.size())));
  std::vector<FeatureEdge> left =
      without_short_creases_near(scan.mesh, scan.features().sharp, failed.failed_at, reach * edge,
                                 longest * bounding_box(scan.mesh.vertices).diagonal());
  if (left.size() == scan.features().sharp.size()) return false;
  scan.keep_creases(std::move(left));
  return true;
}

// The lattice with the creases; where triangles of the wanted size are too large for them, without the short ones, with
// smaller triangles, or without any.
Candidate by_lattice_with_creases(Scan& scan, SizingOptions sizing, Effort effort, SimplifyResult& result,
                                  const Progress& progress) {
  constexpr int most_trials = 4;
  constexpr int most_larger = 1;  // times
  constexpr double growth = 1.6;  // of the number of triangles
  const double wanted = sizing.triangles;
  const std::size_t creases = scan.features().sharp.size();
  const std::string too_large = "triangles of the wanted size are too large for the creases: ";
  int larger = 0;
  for (int trial = 0; trial < most_trials && scan.has_creases(); ++trial) {
    Candidate candidate = best_by_lattice(scan, sizing, effort, progress);
    if (candidate.failure.empty()) {
      const std::size_t kept = scan.features().sharp.size();
      if (kept < creases)
        result.feature_remark = too_large + std::to_string(creases - kept) + " of " + std::to_string(creases) +
                                " edges of creases are not kept";
      if (static_cast<double>(candidate.mesh.triangles.size()) > 1.005 * wanted + 1)
        result.feature_remark = too_large + "made " + std::to_string(candidate.mesh.triangles.size()) + " instead of " +
                                std::to_string(std::lround(wanted));
      return candidate;
    }
    if (drop_short_creases(scan, candidate)) continue;
    if (larger++ == most_larger) break;
    sizing.triangles *= growth;
  }
  result.feature_remark = too_large + "none is kept";
  scan.keep_creases({});
  sizing.triangles = wanted;
  return best_by_lattice(scan, sizing, effort, progress);
}

// One surface of the sizes asked for, by the method asked for or, where the lattice fails, by contraction.
Candidate make_surface(Scan& scan, const SizingOptions& sizing, const SimplifyOptions& options, Effort effort,
                       SimplifyResult& result, const Progress& progress) {
  result.method = options.method;
  result.fallback_reason.clear();
  Candidate candidate = options.method == SimplifyMethod::collapse
                            ? by_collapse(scan, sizing.triangles, options, progress)
                        : scan.has_creases() ? by_lattice_with_creases(scan, sizing, effort, result, progress)
                                             : best_by_lattice(scan, sizing, effort, progress);
  if (!candidate.failure.empty() && options.method == SimplifyMethod::lattice) {
    result.method = SimplifyMethod::collapse;
    result.fallback_reason = candidate.failure;
    candidate = by_contraction(scan, sizing, progress);
  }
  if (!candidate.failure.empty())
    throw NotMeshable({.what = "no valid surface of this size: " + candidate.failure,
                       .where = {},
                       .value = std::to_string(std::lround(sizing.triangles)) + " triangles",
                       .limit = {},
                       .advice = "more triangles (--faces, or a smaller --edge-length or --deviation)"});
  result.crossings_mended = candidate.crossings_mended;
  result.faces_after = candidate.mesh.triangles.size();
  result.feature_edges_kept = edges_of(candidate.net).size();
  return candidate;
}

bool opens_wedges(const SimplifyOptions& options, const Scan& scan) {
  return options.for_tetrahedra && options.method == SimplifyMethod::lattice && !scan.has_creases();
}

// What bounds the tetrahedra's angles; what is sharp in the scan stays so.
bool open_wedges(Candidate& candidate, Scan& scan) {
  return open_wedges(candidate.mesh, scan.reference(),
                     {.keep_volume = scan.is_closed(),
                      .constraints = held_lines(candidate.net, candidate.mesh.vertices.size())})
      .opened();
}

// The largest distances are at a few fins and folds thinner than the triangles, far from all others: these places get
// triangles of their own, so few that the count stays within what was asked for.
void lower_worst(Candidate& candidate, Scan& scan, SimplifyResult& result, const Progress& progress) {
  constexpr double outlier = 14;             // over the RMS distance; 10 takes more shape than it gives
  constexpr double vertices_a_face = 0.001;  // at most 0.2 % more triangles
  constexpr std::size_t faces_a_place = 1500;
  LocalRefinementOptions options;
  options.limit = outlier * candidate.fit.rms_distance;
  if (!(options.limit > 0) || scan.has_features()) return;
  options.least_angle_deg = least_angle_deg;
  options.most_vertices = static_cast<std::size_t>(vertices_a_face * static_cast<double>(result.faces_after));
  options.most_places = 1 + result.faces_after / faces_a_place;
  SurfaceMesh refined = candidate.mesh;
  refine_worst(refined, scan.reference(), candidate.fit.largest_distance_of_face, options, progress);
  if (!preserve_volume_clear(refined, scan.mesh)) return;
  candidate.mesh = std::move(refined);
  result.faces_after = candidate.mesh.triangles.size();
}

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
double bring_within(SurfaceMesh& surface, Scan& scan, double deviation, const Progress& progress) {
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

// The deviation of linear triangles goes with the edge length squared, place by place: a few surfaces are made, and the
// edge lengths renewed from how far each came from the scan there (bounds, not samples), until local refinement can do
// the rest.
Candidate make_surface_within(Scan& scan, const LargestDeviation& wanted, const SimplifyOptions& options,
                              SimplifyResult& result, const Progress& progress) {
  constexpr int most_trials = 5;
  constexpr double margin = 0.8;          // of the bound, aimed at
  constexpr double most_shrinking = 0.5;  // of an edge from trial to trial
  constexpr double most_growing = 2.8;    // after the first, whose lengths are a guess; later ones only shrink
  constexpr double shortest_edge = 0.5;   // over the deviation: shorter ones help nothing
  constexpr double few_beyond = 0.03;     // of the faces, for local refinement: more are cheaper mended all at once
  constexpr double most_beyond = 0.1;     // where there is no other way left
  // A deviation far below the scan's own facets asks for more; nothing is known there.
  const double most_triangles = 32 * static_cast<double>(scan.mesh.triangles.size());
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
  if (opens_wedges(options, scan) && open_wedges(opened, scan)) {
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
  if (const auto* bound = std::get_if<LargestDeviation>(&size)) return first_edge * bound->distance;
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
  const double tolerance =
      std::max(curve_tolerance * bounding_box(mesh.vertices).diagonal(), noise_on_curves * features.noise);
  // Faces of CAD are far larger than the result's; searches for what is near want them alike.
  SurfaceMesh parted;
  if (!features.edges.empty()) {
    parted = mesh;
    std::vector<double> length(mesh.vertices.size(), edge);
    halve_long_edges(parted, length, features.edges, longest_edge_of_part, longest_edge_of_part);
  }
  const SurfaceMesh& whole = features.edges.empty() ? mesh : parted;
  Scan scan(whole, std::move(features.edges), tolerance);
  result.faces_before = mesh.triangles.size();
  if (const auto* bound = std::get_if<LargestDeviation>(&options.size)) {
    require_positive(bound->distance, "the deviation");
    surface = make_surface_within(scan, *bound, options, result, progress).mesh;
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
    if (plan_of(options.effort).lowers_worst && result.method == SimplifyMethod::lattice)
      lower_worst(candidate, scan, result, progress);
    if (opens_wedges(options, scan)) open_wedges(candidate, scan);
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
