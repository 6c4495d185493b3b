#include "preproc/surface/simplify.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/clear_moves.hpp"
#include "preproc/surface/guard.hpp"
#include "preproc/surface/lattice.hpp"
#include "preproc/surface/preserve_volume.hpp"
#include "preproc/surface/reference_surface.hpp"
#include "preproc/surface/refined_scan.hpp"
#include "preproc/surface/shape_fit.hpp"
#include "quality/deviation.hpp"
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

// Of the first fit, which finds out how near the triangles can come.
constexpr int first_rounds = 2;

// What an effort buys. Trials differ by a little in the sizing, which lays another lattice: of several, the distances
// to the scan in the tightest folds differ by a third, so the best of them is worth having where time is no matter.
struct FitPlan {
  int rounds;
  double fidelity_of_diagonal;  // the dial between shape and fit, at the least
  double fidelity_of_residual;  // and over the RMS distance of the first fit
  int trials;
};

FitPlan plan_of(Effort effort) {
  switch (effort) {
    case Effort::low:
      return {.rounds = 4, .fidelity_of_diagonal = 0.0013, .fidelity_of_residual = 7, .trials = 1};
    case Effort::normal:
      return {.rounds = 8, .fidelity_of_diagonal = 0.0012, .fidelity_of_residual = 7, .trials = 1};
    case Effort::high:
      return {.rounds = 12, .fidelity_of_diagonal = 0.00095, .fidelity_of_residual = 5.7, .trials = 5};
  }
  return {};
}

struct Candidate {
  SurfaceMesh mesh;
  std::size_t crossings_mended = 0;
  std::string failure;  // empty where `mesh` is valid
  ShapeFitResult fit;
};

std::string describe(const SurfaceDefects& defects) {
  return std::to_string(defects.crossings.size()) + " crossing pairs of faces and " +
         std::to_string(defects.inverted.size()) + " inverted faces remained";
}

// Exact volume, then the guard.
void finish(Candidate& candidate, const ReferenceSurface& scan, const Progress& progress) {
  try {
    GuardOptions guard;
    guard.least_angle_deg = 38.5;  // most fits reach it without the guard
    const GuardResult guarded = guard_surface(candidate.mesh, scan, guard, progress);
    candidate.crossings_mended = guarded.before.crossings.size();
    if (!guarded.clean()) candidate.failure = describe(guarded.after);
  } catch (const NotMeshable& e) {
    candidate.failure = e.parts().what;
  }
}

Candidate by_lattice(const ReferenceSurface& scan, double faces, const FitPlan& plan, const SimplifyOptions& options,
                     double strength_factor, const Progress& progress) {
  LatticeOptions lattice_options;
  lattice_options.sizing.triangles = faces;
  lattice_options.sizing.sizing = options.sizing;
  lattice_options.sizing.gradation = options.gradation;
  lattice_options.sizing.strength *= strength_factor;
  LatticeResult lattice = remesh_by_lattice(scan.mesh, lattice_options, progress);
  if (!lattice.failure.empty()) return {.mesh = {}, .crossings_mended = 0, .failure = lattice.failure, .fit = {}};

  Candidate candidate{.mesh = std::move(lattice.mesh), .crossings_mended = 0, .failure = {}, .fit = {}};
  ShapeFitOptions fit;
  fit.rounds = first_rounds;
  fit.fidelity_of_diagonal = plan.fidelity_of_diagonal;
  fit.nearest_vertex_of_scan_vertex = std::move(lattice.vertex_of_scan_vertex);
  const ShapeFitResult first = optimise_shape_and_fit(candidate.mesh, scan, fit, progress);

  // What the triangles are too large for, or noise, no fit can follow: drawn to it hard, they only lose their shape.
  fit.fidelity_of_diagonal =
      std::clamp(plan.fidelity_of_residual * first.rms_distance / scan.diagonal, plan.fidelity_of_diagonal, 0.01);
  fit.lift_tail_of_diagonal = *fit.lift_tail_of_diagonal * fit.fidelity_of_diagonal / plan.fidelity_of_diagonal;
  fit.rounds = plan.rounds;
  fit.nearest_vertex_of_scan_vertex.reset();
  candidate.fit = optimise_shape_and_fit(candidate.mesh, scan, fit, progress);
  finish(candidate, scan, progress);
  return candidate;
}

Candidate best_by_lattice(const ReferenceSurface& scan, double faces, const SimplifyOptions& options,
                          const Progress& progress) {
  const FitPlan plan = plan_of(options.effort);
  if (plan.trials == 1) return by_lattice(scan, faces, plan, options, 1, progress);
  constexpr double strength_step = 0.03;
  Candidate best;
  double best_score = std::numeric_limits<double>::infinity();
  for (int trial = 0; trial < plan.trials; ++trial) {
    const double strength_factor = 1 + strength_step * (trial - (plan.trials - 1) / 2.0);
    Candidate candidate = by_lattice(scan, faces, plan, options, strength_factor, progress);
    if (!candidate.failure.empty()) {
      if (best.mesh.triangles.empty()) best.failure = candidate.failure;
      continue;
    }
    // All that is to be small, at once.
    const double score = (measure_triangles(candidate.mesh).edge_ratio.mean - 1) * candidate.fit.rms_distance *
                         candidate.fit.largest_distance;
    if (score >= best_score) continue;
    best = std::move(candidate);
    best_score = score;
  }
  return best;
}

// Where the lattice gives way: contractions towards the same sizing, none of which makes faces meet, then the same fit.
// Where the fit ends in crossings that the guard cannot mend, vertices go only as far towards it as nothing meets, and
// where the shape needs more triangles than were asked for, it keeps them: this way always ends in a sound surface.
Candidate by_contraction(const ReferenceSurface& scan, double faces, const SimplifyOptions& options,
                         const Progress& progress) {
  SizingOptions sizing;
  sizing.triangles = faces;
  sizing.sizing = options.sizing;
  sizing.gradation = options.gradation;
  // Long triangles, as CAD makes them, are no start for even ones.
  RefinedScan refined = refine_scan(scan.mesh, compute_sizing_field(scan.mesh, sizing), longest_edge_to_contract);
  Candidate contracted{.mesh = std::move(refined.mesh), .crossings_mended = 0, .failure = {}, .fit = {}};
  CollapseOptions collapse_options;
  collapse_options.target_faces = static_cast<std::size_t>(std::lround(faces));
  collapse_options.cost = CollapseCost::sized_length;
  collapse_options.sizing = std::move(refined.edge_length);
  collapse_options.keep_clear = true;
  collapse(contracted.mesh, collapse_options, progress);

  Candidate fitted = contracted;
  ShapeFitOptions fit;
  fit.rounds = 12;
  optimise_shape_and_fit(fitted.mesh, scan, fit, progress);
  const std::vector<Vec3> targets = fitted.mesh.vertices;
  finish(fitted, scan, progress);
  if (fitted.failure.empty()) return fitted;

  SurfaceMesh near_fit = contracted.mesh;
  move_clear(near_fit, targets);
  if (preserve_volume_clear(near_fit, scan.mesh)) contracted.mesh = std::move(near_fit);
  return contracted;
}

// The paper's method as it is; only what passes through itself is mended.
Candidate by_collapse(const ReferenceSurface& scan, double faces, const SimplifyOptions& options,
                      const Progress& progress) {
  CollapseOptions collapse_options = options.collapse;
  collapse_options.target_faces = static_cast<std::size_t>(std::lround(faces));
  Candidate candidate{.mesh = scan.mesh, .crossings_mended = 0, .failure = {}, .fit = {}};
  collapse(candidate.mesh, collapse_options, progress);
  GuardOptions guard;
  guard.least_angle_deg = 0;
  guard.keep_volume = false;
  const GuardResult guarded = guard_surface(candidate.mesh, scan, guard, progress);
  candidate.crossings_mended = guarded.before.crossings.size();
  if (!guarded.clean()) candidate.failure = describe(guarded.after);
  return candidate;
}

// One surface of about `faces` triangles, by the method asked for or, where that fails, the other.
SurfaceMesh make_surface(const ReferenceSurface& scan, double faces, const SimplifyOptions& options,
                         SimplifyResult& result, const Progress& progress) {
  result.method = options.method;
  result.fallback_reason.clear();
  Candidate candidate = options.method == SimplifyMethod::lattice ? best_by_lattice(scan, faces, options, progress)
                                                                  : by_collapse(scan, faces, options, progress);
  if (!candidate.failure.empty() && options.method == SimplifyMethod::lattice) {
    result.method = SimplifyMethod::collapse;
    result.fallback_reason = candidate.failure;
    candidate = by_contraction(scan, faces, options, progress);
  }
  if (!candidate.failure.empty())
    throw NotMeshable({.what = "no valid surface of this size: " + candidate.failure,
                       .where = {},
                       .value = std::to_string(std::lround(faces)) + " triangles",
                       .limit = {},
                       .advice = "more triangles (--faces, or a smaller --edge-length or --deviation)"});
  result.crossings_mended = candidate.crossings_mended;
  result.faces_after = candidate.mesh.triangles.size();
  return std::move(candidate.mesh);
}

// The deviation of linear triangles falls as the edge length squared, so as one over their number; a few steps of that
// law, with a margin for where it does not hold, find the number that keeps the bound with few triangles to spare.
SurfaceMesh make_surface_within(const ReferenceSurface& scan, double distance, const SimplifyOptions& options,
                                SimplifyResult& result, const Progress& progress) {
  constexpr int most_trials = 8;
  constexpr double margin = 0.9;        // of the bound, aimed at
  constexpr double good_enough = 0.75;  // of the bound, reached: fewer triangles are not looked for
  const double relative = distance / scan.diagonal;
  double faces = std::clamp(12.0 / relative, 500.0, static_cast<double>(scan.mesh.triangles.size()));
  double too_few = 0;
  std::optional<SurfaceMesh> best;
  SimplifyResult best_result;
  for (int trial = 0; trial < most_trials; ++trial) {
    SurfaceMesh surface = make_surface(scan, faces, options, result, progress);
    result.largest_deviation = measure_deviation(surface, scan.mesh).hausdorff;
    const bool within = result.largest_deviation <= distance;
    if (within && (!best || surface.triangles.size() < best->triangles.size())) {
      best = std::move(surface);
      best_result = result;
    }
    if (!within) too_few = std::max(too_few, faces);
    if (within && result.largest_deviation >= good_enough * distance) break;
    double next = faces * std::clamp(result.largest_deviation / (margin * distance), 0.3, 3.0);
    // A count that failed bounds the search from below, one that passed from above: between them, the middle.
    if (best) {
      const double upper = static_cast<double>(best->triangles.size());
      if (next >= upper || next <= too_few) next = std::sqrt(std::max(too_few, upper / 8) * upper);
      if (next > 0.95 * upper) break;
    }
    faces = std::max(next, 100.0);
  }
  if (!best)
    throw NotMeshable({.what = "the deviation was not reached",
                       .where = {},
                       .value = std::to_string(result.largest_deviation) + " with " +
                                std::to_string(result.faces_after) + " triangles",
                       .limit = std::to_string(distance),
                       .advice = "a larger --deviation"});
  result = best_result;
  return std::move(*best);
}

void require_positive(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value))
    throw WrongUsage({.what = std::string(what) + " must be above 0",
                      .where = {},
                      .value = std::to_string(value),
                      .limit = {},
                      .advice = {}});
}

double wanted_faces(const TargetSize& size, const ReferenceSurface& scan) {
  if (const auto* count = std::get_if<FaceCount>(&size)) return static_cast<double>(count->faces);
  if (const auto* ratio = std::get_if<FaceRatio>(&size))
    return ratio->of_input * static_cast<double>(scan.mesh.triangles.size());
  const double length = std::get<MeanEdgeLength>(size).length;
  require_positive(length, "the edge length");
  return scan.area / (equilateral_area * length * length);
}

}  // namespace

SimplifyResult simplify(const SurfaceMesh& mesh, SurfaceMesh& surface, const SimplifyOptions& options,
                        const Progress& progress) {
  const ReferenceSurface scan(mesh);
  SimplifyResult result;
  result.faces_before = mesh.triangles.size();
  if (const auto* bound = std::get_if<LargestDeviation>(&options.size)) {
    require_positive(bound->distance, "the deviation");
    surface = make_surface_within(scan, bound->distance, options, result, progress);
  } else {
    const double faces = wanted_faces(options.size, scan);
    require_positive(faces, "the number of triangles");
    surface = make_surface(scan, std::max(faces, fewest_faces), options, result, progress);
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
