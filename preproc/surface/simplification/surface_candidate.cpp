#include "preproc/surface/simplification/surface_candidate.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/collapse/collapse.hpp"
#include "preproc/surface/fit/preserve_volume.hpp"
#include "preproc/surface/kernel/clear_moves.hpp"
#include "preproc/surface/kernel/components.hpp"
#include "preproc/surface/kernel/nearest.hpp"
#include "preproc/surface/lattice/lattice.hpp"
#include "preproc/surface/mending/local_moves.hpp"
#include "preproc/surface/mending/local_refinement.hpp"
#include "preproc/surface/mending/mend_places.hpp"
#include "preproc/surface/mending/mend_surface.hpp"
#include "preproc/surface/simplification/fewer_creases.hpp"
#include "preproc/surface/simplification/scan_by_shape.hpp"
#include "preproc/surface/simplification/shape_check.hpp"
#include "preproc/surface/sizing/shape_lengths.hpp"
#include "preproc/surface/sizing/shorter_edges.hpp"
#include "preproc/surface/sizing/split_long_edges.hpp"
#include "quality/self_intersections.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scan2fea {
namespace {

// Over the wanted edge length.
constexpr double longest_edge_to_contract = 1;

// With smaller angles (see weak_places.hpp) a lattice failed as with faces that cross: what mends these mends them.
constexpr double unusable_angle_deg = 0.5;

// Most fits reach it without the mending.
constexpr double least_angle_deg = 38.5;

// Of the diagonal, the dial between shape and fit at the least on parts with edges: most of them have plane faces and
// cylinders, which triangles can follow.
constexpr double fidelity_of_parts = 0.0003;
// And over the edges, since a slender part has a long diagonal: from 0.05 on single vertices rise from its planes by
// half an edge.
constexpr double fidelity_over_edge = 0.03;

// Of the fit, in which it finds out how near the triangles can come.
constexpr int first_rounds = 2;

// Of the faces. Where all points are bounded afterwards, a few that oppose a rough scan do not make a surface
// useless, and there is none without at sizes below the scan's own. Without a bound only as many as a scan's own
// folds leave among very many: to give up the lattice for one of half a million costs far more than it mends.
constexpr double most_inverted_within_deviation = 0.001, most_inverted = 1e-5;

// What an effort buys. Trials differ by a little in the sizing, which lays another lattice: of several, the distances
// to the scan in the tightest folds differ by a third, so the best of them is worth having where time is no matter.
struct FitPlan {
  int rounds;
  double fidelity_of_diagonal;  // the dial between shape and fit, at the least
  double fidelity_of_residual;  // and over the RMS distance of the first fit
  int trials;
  bool lowers_worst;              // see lower_worst
  bool within_deviation = false;  // the result is to be, and its deviation bounded

  double largest_inverted_share() const { return within_deviation ? most_inverted_within_deviation : most_inverted; }
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

std::string describe(const SurfaceDefects& defects) {
  return std::to_string(defects.crossings.size()) + " crossing pairs of faces and " +
         std::to_string(defects.inverted.size()) + " inverted faces remained";
}

// Few places where faces cross or are inverted are mended where they are: to give up the lattice for them costs far
// more. Not on parts with edges, which then want fewer of these, unless the deviation is bounded afterwards.
bool mend_few_tangles(Candidate& candidate, const SurfaceDefects& defects, bool within_deviation,
                      const Progress& progress) {
  const PreparedScan& scan = *candidate.scan;
  const double few = scan.has_creases() || !within_deviation ? 0.01 : 0.03;  // of the faces; else make another surface
  if (static_cast<double>(defects.crossings.size() + defects.inverted.size()) >
          few * static_cast<double>(candidate.faces()) ||
      (scan.has_creases() && !within_deviation) || !(candidate.fit.largest_distance > 0))
    return false;
  MendPlacesOptions options;
  options.limit = candidate.fit.largest_distance;
  SurfaceMesh mesh = candidate.mesh;
  FeatureNet net = candidate.net;
  if (mend_tangles(mesh, net, scan.reference(), defects, options, progress).left > 0) return false;
  if (scan.is_closed()) preserve_volume_clear(mesh, scan.mesh, held_lines(net, mesh.vertices.size()));
  if (!find_self_intersections(mesh).empty()) return false;
  candidate.mesh = std::move(mesh);
  candidate.net = std::move(net);
  candidate.fit.largest_distance_of_face.resize(candidate.faces(), 0);
  return true;
}

// Exact volume, mending, and flips of what it leaves without area.
void finish(Candidate& candidate, const FitPlan& plan, const MendOptions& options, const Progress& progress) {
  const PreparedScan& scan = *candidate.scan;
  try {
    MendOptions mending = options;
    mending.least_angle_deg = least_angle_deg;
    mending.keep_volume = scan.is_closed();
    const MendResult mended = mend_surface(candidate.mesh, candidate.net, scan.reference(), mending, progress);
    candidate.crossings_mended = mended.before.crossings.size();
    if (SurfaceMesh flipped = candidate.mesh; flip_caps(flipped, edges_of(candidate.net)) > 0 &&
                                              find_self_intersections(flipped).size() <= mended.after.crossings.size())
      candidate.mesh = std::move(flipped);
    const std::size_t inverted = mended.after.inverted.size();
    if (mended.after.crossings.empty() &&
        static_cast<double>(inverted) <=
            plan.largest_inverted_share() * static_cast<double>(candidate.mesh.triangles.size()))
      return;
    if (mend_few_tangles(candidate, mended.after, plan.within_deviation, progress)) return;
    candidate.failure = describe(mended.after);
    const auto centre = [&](std::uint32_t f) { return centroid(candidate.mesh, candidate.mesh.triangles[f]); };
    for (const FacePair& pair : mended.after.crossings) candidate.failed_at.push_back(centre(pair.face));
    for (const std::uint32_t f : mended.after.inverted) candidate.failed_at.push_back(centre(f));
  } catch (const NotMeshable& e) {
    candidate.failure = e.parts().what;
  }
}

Candidate by_lattice(const PreparedScanPointer& prepared, const SizingOptions& sizing, const FitPlan& plan,
                     double strength_factor, const Progress& progress) {
  const PreparedScan& scan = *prepared;
  LatticeOptions lattice_options;
  lattice_options.sizing = sizing;
  lattice_options.sizing.strength *= strength_factor;
  LatticeResult lattice = scan.has_features() ? remesh_by_lattice(scan.features(), lattice_options, progress)
                                              : remesh_by_lattice(scan.mesh, lattice_options, progress);
  Candidate candidate{.mesh = {}, .net = {}, .scan = prepared};
  // Where features need more triangles than were asked for, they get them.
  candidate.failure = scan.has_features() ? "" : lattice.failure;
  if (!candidate.failure.empty()) return candidate;
  candidate.mesh = std::move(lattice.mesh);
  candidate.net = std::move(lattice.net);
  ShapeFitOptions fit;
  fit.rounds = first_rounds + plan.rounds;
  if (plan.within_deviation) fit.hold_faces_below = 1;
  fit.fidelity_of_diagonal = plan.fidelity_of_diagonal;
  fit.fidelity_of_residual = plan.fidelity_of_residual;
  const bool holds_border = !scan.features().held_border.empty();
  const bool keeps_planes = scan.has_creases() || holds_border;
  if (keeps_planes) {
    const double edge = scan.reference().mean_edge(candidate.faces());
    fit.fidelity_of_diagonal = std::min(fidelity_of_parts, fidelity_over_edge * edge / scan.reference().diagonal);
    *fit.lift_tail_of_diagonal *= fit.fidelity_of_diagonal / plan.fidelity_of_diagonal;
    fit.rounds_of_dialling = plan.rounds;
    fit.rounds = first_rounds + plan.rounds / 2;  // planes and cylinders are met soon
  }
  fit.nearest_vertex_of_scan_vertex = std::move(lattice.vertex_of_scan_vertex);
  if (holds_border) fit.constraints = held_borders(candidate.net, candidate.mesh.vertices.size());
  candidate.fit = optimise_shape_and_fit(candidate.mesh, candidate.net, scan.reference(), fit, progress);
  MendOptions mending;
  mending.nearest_vertex_of_scan_vertex = std::move(fit.nearest_vertex_of_scan_vertex);
  mending.scan_vertex_of_face = std::move(candidate.fit.scan_vertex_of_face);
  // On parts with edges, not much looser than the fit: what is plane stays plane.
  if (keeps_planes) {
    mending.fidelity_of_diagonal = candidate.fit.fidelity_of_diagonal;
    mending.loosest_fidelity_of_diagonal = 2 * candidate.fit.fidelity_of_diagonal;
  }
  finish(candidate, plan, mending, progress);
  std::vector<Vec3> bad;
  if (candidate.failure.empty() &&
      smallest_angle_beside_creases_deg(candidate, unusable_angle_deg, bad) < unusable_angle_deg) {
    candidate.failure = std::to_string(bad.size()) + " triangles that no solver takes remained";
    candidate.failed_at = std::move(bad);
  }
  return candidate;
}

Candidate best_by_lattice(const PreparedScanPointer& scan, const SizingOptions& sizing, const FitPlan& plan,
                          const Progress& progress) {
  if (plan.trials == 1) return by_lattice(scan, sizing, plan, 1, progress);
  constexpr double strength_step = 0.03;
  Candidate best, failed;
  double best_score = std::numeric_limits<double>::infinity();
  for (int trial = 0; trial < plan.trials; ++trial) {
    const double strength_factor = 1 + strength_step * (trial - (plan.trials - 1) / 2.0);
    const bool has_one = !best.mesh.triangles.empty();
    Candidate candidate;
    try {
      candidate = by_lattice(scan, sizing, plan, strength_factor, has_one ? progress.for_improvement() : progress);
    } catch (const OutOfTime&) {
      if (has_one) break;
      throw;
    }
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

// Shorter edges around places where a surface came out badly.
void shorten_around(const std::vector<Vec3>& bad, const SurfaceMesh& scan, double gradation,
                    std::vector<double>& length) {
  constexpr double factor = 0.6, reach = 3;  // edges
  const std::vector<std::uint32_t> near = nearest_vertices(bad, std::vector<Vec3>(bad.size(), Vec3::Zero()), scan, 0);
  std::vector<ShorterEdges> places;
  for (std::size_t i = 0; i < near.size(); ++i) places.push_back({{bad[i], reach * length[near[i]]}, factor});
  shorten_around(places, scan, length);
  limit_gradation(scan, gradation, length);
}

// Smaller ones, where no creases make them, are worth another lattice.
constexpr double poor_angle_deg = 15;

// Solvers warn of smaller ones; then contractions may do better.
constexpr double usable_angle_deg = 5;

// Whether its smallest angle is no smaller, or no poor one; usable where the other failed.
bool is_as_well_shaped(const Candidate& candidate, const Candidate& other) {
  std::vector<Vec3> bad;
  if (!candidate.failure.empty()) return false;
  return smallest_angle_beside_creases_deg(candidate, 0, bad) >=
         (other.failure.empty() ? std::min(poor_angle_deg, smallest_angle_beside_creases_deg(other, 0, bad))
                                : usable_angle_deg);
}

// Where the lattice gives way: contractions towards the same sizing, none of which makes faces meet, then the same
// fit. Where the fit ends in crossings that cannot be mended, vertices go only as far towards it as nothing meets,
// and where the shape needs more triangles than were asked for, it keeps them: this way always ends in a sound
// surface.
Candidate by_contraction(const PreparedScanPointer& prepared, const SizingOptions& sizing, const FitPlan& plan,
                         const Progress& progress) {
  const PreparedScan& scan = *prepared;
  // Long triangles, as CAD makes them, are no start for even ones.
  RefinedScan refined = refine_scan(scan.mesh, compute_sizing_field(scan.mesh, sizing), longest_edge_to_contract);
  Candidate contracted{
      .mesh = std::move(refined.mesh), .net = {}, .scan = prepared, .method = SimplifyMethod::collapse};
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
  if (plan.within_deviation) fit.hold_faces_below = 1;
  optimise_shape_and_fit(fitted.mesh, scan.reference(), fit, progress);
  const std::vector<Vec3> targets = fitted.mesh.vertices;
  finish(fitted, plan, {}, progress);
  if (fitted.failure.empty()) return fitted;

  SurfaceMesh near_fit = contracted.mesh;
  move_clear(near_fit, targets);
  if (!scan.is_closed() || preserve_volume_clear(near_fit, scan.mesh)) contracted.mesh = std::move(near_fit);
  return contracted;
}

// The paper's method as it is; only what passes through itself is mended.
Candidate by_collapse(const PreparedScanPointer& scan, double faces, const SimplifyOptions& options,
                      const Progress& progress) {
  CollapseOptions collapse_options = options.collapse;
  collapse_options.target_faces = static_cast<std::size_t>(std::lround(faces));
  Candidate candidate{.mesh = scan->mesh, .net = {}, .scan = scan, .method = SimplifyMethod::collapse};
  collapse(candidate.mesh, collapse_options, progress);
  MendOptions mending;
  mending.least_angle_deg = 0;
  mending.keep_volume = false;
  const MendResult mended = mend_surface(candidate.mesh, scan->reference(), mending, progress);
  candidate.crossings_mended = mended.before.crossings.size();
  // It may end in needles that turn over, as the paper's does; what is sound for a mesher crosses nothing.
  if (!mended.after.crossings.empty()) candidate.failure = describe(mended.after);
  return candidate;
}

// Where the lattice failed with creases since triangles of the wanted size are too large for them: without the short
// ones around, with smaller triangles, or without any. Restored creases run through places that no scanner saw: of
// these the pieces near all places that have failed so far go, farther around with each trial, and the number of
// triangles stays.
Candidate with_fewer_creases(Candidate failed, SizingOptions sizing, const SimplifyOptions& options,
                             const FitPlan& plan, const Progress& progress) {
  constexpr int most_trials = 3;
  const bool restored = options.may_drop_given;
  // Times: a free form is itself without creases, too.
  const int most_larger = is_part(failed.scan->given) && !restored ? 1 : 0;
  constexpr double growth = 1.6;            // of the number of triangles
  constexpr std::size_t many_failed = 100;  // places; of few, some may be gone by chance
  const double wanted = sizing.triangles;
  PreparedScanPointer scan = failed.scan;
  std::vector<Vec3> places;  // that failed so far
  int larger = 0;
  for (int trial = 0;; ++trial) {
    places.insert(places.end(), failed.failed_at.begin(), failed.failed_at.end());
    const PreparedScanPointer fewer =
        restored ? without_pieces(failed, places, 2 + 2 * trial) : without_short_creases(failed);
    if (fewer == scan) {
      if (larger++ == most_larger) break;
      sizing.triangles *= growth;
    }
    scan = fewer;
    if (trial == most_trials || !scan->has_creases()) break;
    const std::size_t before = failed.failed_at.size();
    failed = best_by_lattice(scan, sizing, plan, progress);
    if (failed.failure.empty()) return failed;
    // Where hardly fewer places fail, those that are left would fail again.
    if (2 * failed.failed_at.size() > before && before > many_failed) break;
  }
  sizing.triangles = wanted;
  return best_by_lattice(with_creases(scan, {}), sizing, plan, progress);
}

void refuse_failed(const Candidate& candidate, double triangles) {
  if (!candidate.failure.empty())
    throw NotMeshable({.what = "no valid surface of this size: " + candidate.failure,
                       .where = {},
                       .value = std::to_string(std::lround(triangles)) + " triangles",
                       .limit = {},
                       .advice = "more triangles (--faces, or a smaller --edge-length or --deviation)"});
}

}  // namespace

Candidate make_surface(const PreparedScanPointer& scan, const SizingOptions& sizing, const SimplifyOptions& options,
                       Effort effort, const WaysOut& ways, const Progress& progress) {
  FitPlan plan = plan_of(effort);
  plan.within_deviation = std::holds_alternative<LargestDeviation>(options.size);
  if (options.method == SimplifyMethod::collapse) {
    Candidate candidate = by_collapse(scan, sizing.triangles, options, progress);
    refuse_failed(candidate, sizing.triangles);
    return candidate;
  }
  Candidate candidate = best_by_lattice(scan, sizing, plan, progress);
  const bool failed = !candidate.failure.empty();
  // A deviation asks for shorter edges itself.
  if (ways.by_shape && !plan.within_deviation && !options.may_drop_given) {
    const bool lost_shape = failed || is_far(candidate);
    if ((lost_shape || is_ill_shaped(candidate)) && is_part(scan->given)) try {
        progress.explain("triangles of the wanted size are too large for the part" +
                         (failed ? ": " + candidate.failure : "") + "; tried with edges as short as its walls need");
        Candidate by_shape =
            make_surface_by_shape(*scan, sizing, options, effort, shape_budget(sizing.triangles, lost_shape),
                                  failed ? progress : progress.for_improvement());
        if (is_as_well_shaped(by_shape, candidate)) return by_shape;
      } catch (const OutOfTime&) {
        if (failed) throw;
      }
  }
  if (!failed) return candidate;
  if (scan->has_creases()) {
    progress.explain("the lattice failed: " + candidate.failure + "; tried with fewer creases, then with none");
    candidate = with_fewer_creases(std::move(candidate), sizing, options, plan, progress);
  }
  if (!candidate.failure.empty() && ways.contraction) {
    progress.explain("the lattice failed: " + candidate.failure + "; edges of the scan are contracted instead");
    Candidate contracted = by_contraction(candidate.scan, sizing, plan, progress);
    contracted.fallback_reason = std::move(candidate.failure);
    contracted.failed_at = std::move(candidate.failed_at);
    candidate = std::move(contracted);
    refuse_failed(candidate, sizing.triangles);
  }
  return candidate;
}

Candidate make_surface_by_shape(const PreparedScan& scan, const SizingOptions& sizing, const SimplifyOptions& options,
                                Effort effort, const ShapeBudget& budget, const Progress& progress) {
  FitPlan plan = plan_of(effort);
  plan.within_deviation = true;  // small faces are held to the scan as large ones are
  // These lengths can follow the shape: what residual there is comes from a few places, and is no reason to let go.
  plan.fidelity_of_residual = 2;
  ScanByShape by_shape = prepare_by_shape(scan, sizing, options, budget.triangles);
  Candidate best;
  double best_angle_deg = -1;
  for (int trial = 0; trial < budget.trials; ++trial) {
    SizingOptions asked = sizing;
    asked.gradation *= 2;
    asked.keeps_count = false;
    ask_for_lengths(by_shape.scan->mesh, by_shape.length, asked);
    if (trial > 0 && asked.triangles > 2 * budget.triangles) break;
    const bool has_one = trial > 0 && best.failure.empty();
    Candidate candidate;
    try {
      candidate = best_by_lattice(by_shape.scan, asked, plan, has_one ? progress.for_improvement() : progress);
    } catch (const OutOfTime&) {
      if (has_one) break;
      throw;
    }
    candidate.lengths_by_shape = by_shape.length;
    double angle_deg = -1;
    std::vector<Vec3> bad = candidate.failed_at;
    if (candidate.failure.empty()) angle_deg = smallest_angle_beside_creases_deg(candidate, poor_angle_deg, bad);
    // The next ones would do no better than one that does not.
    if (trial > 0 && (angle_deg < best_angle_deg || (angle_deg < 0 && bad.size() >= best.failed_at.size()))) break;
    best = std::move(candidate);
    best_angle_deg = angle_deg;
    if (angle_deg >= poor_angle_deg || bad.empty()) break;
    shorten_around(bad, by_shape.scan->mesh, asked.gradation, by_shape.length);
  }
  return best;
}

ShapeBudget shape_budget(double wanted, bool lost_shape) {
  constexpr double most = 3, few_lost = 40000, most_of_lost = 1000, few_ill_shaped = 8000, most_of_ill_shaped = 40;
  const double few =
      lost_shape ? std::min(few_lost, most_of_lost * wanted) : std::min(few_ill_shaped, most_of_ill_shaped * wanted);
  return {.triangles = std::max(most * wanted, few), .trials = lost_shape ? 3 : 2};
}

void lower_worst(Candidate& candidate, Effort effort, const Progress& progress) {
  constexpr double outlier = 14;             // over the RMS distance; 10 takes more shape than it gives
  constexpr double vertices_a_face = 0.001;  // at most 0.2 % more triangles
  constexpr std::size_t faces_a_place = 1500;
  const PreparedScan& scan = *candidate.scan;
  LocalRefinementOptions options;
  options.limit = outlier * candidate.fit.rms_distance;
  if (!plan_of(effort).lowers_worst || !(options.limit > 0) || scan.has_features()) return;
  options.least_angle_deg = least_angle_deg;
  options.most_vertices = static_cast<std::size_t>(vertices_a_face * static_cast<double>(candidate.faces()));
  options.most_places = 1 + candidate.faces() / faces_a_place;
  SurfaceMesh refined = candidate.mesh;
  refine_worst(refined, scan.reference(), candidate.fit.largest_distance_of_face, options, progress);
  if (preserve_volume_clear(refined, scan.mesh)) candidate.mesh = std::move(refined);
}

}  // namespace scan2fea
