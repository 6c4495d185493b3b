#include "preproc/surface/simplification/deviation_search.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/fit/preserve_volume.hpp"
#include "preproc/surface/mending/local_refinement.hpp"
#include "preproc/surface/simplification/deviation_at_scan.hpp"
#include "quality/deviation_bound.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace scan2fea {
namespace {

// The lengths settle in three or four; the others are for scans on which the lattice gives way now and then.
constexpr int most_trials = 8;
// Where the lattice gives way it often does so by a few triangles, which others of nearly the same size may not have.
constexpr int most_failures = 2;
constexpr double after_failure = 0.96;  // of all edges
// The share of faces too far that is left to local refinement: more are cheaper mended by other lengths, all at once.
constexpr double few_beyond = 0.05;
// The same where all trials are spent and there is no other way.
constexpr double most_beyond = 0.15;
// Where triangles as large as the deviation allows are too large for the part's edges, smaller ones keep their shape.
// The bound is where isotropic remeshing with kept edges ends (CGAL: 1.18 to 1.21 on plates, cubes and cylinders).
constexpr double worst_mean_edge_ratio = 1.19;

// What is known of one trial.
struct Found {
  Candidate candidate;
  double share_beyond = 1;  // of the faces, before local refinement
  double mean_edge_ratio = 0;
  bool is_largest = false;  // of as many triangles as there may be

  bool holds(double distance) const { return candidate.largest_deviation <= distance; }
  bool is_shapely() const { return mean_edge_ratio <= worst_mean_edge_ratio; }
  bool gave_way() const { return !candidate.fallback_reason.empty(); }
};

bool is_better(const Found& a, const Found& b, double distance) {
  if (b.candidate.mesh.triangles.empty()) return true;
  if (a.holds(distance) != b.holds(distance)) return a.holds(distance);
  if (!a.holds(distance)) return a.candidate.largest_deviation < b.candidate.largest_deviation;
  if (a.is_shapely() != b.is_shapely()) return a.is_shapely();
  return a.is_shapely() ? a.candidate.faces() < b.candidate.faces() : a.mean_edge_ratio < b.mean_edge_ratio;
}

double share_beyond(const OneSidedDeviation& side, double distance) {
  const auto beyond = std::count_if(side.upper.begin(), side.upper.end(), [&](double d) { return d > distance; });
  return static_cast<double>(beyond) / static_cast<double>(side.upper.size());
}

// What the edge lengths leave too far is brought near place by place; then the exact volume.
void bring_within(Found& found, double deviation, const Progress& progress) {
  // The shift that restores the volume takes a little of the deviation; where it takes more, once more with more left.
  constexpr int trials = 3;
  constexpr double for_volume = 0.005;
  constexpr double least_angle_deg = 28;
  // What the patches' fits must follow, over the deviation; no looser than mending is (MendOptions), and not so tight
  // that shape has no say.
  constexpr double fidelity = 0.3, tightest = 1e-4, loosest = 1.6e-3;
  const PreparedScan& scan = *found.candidate.scan;
  SurfaceMesh& surface = found.candidate.mesh;
  LocalRefinementOptions options;
  options.least_angle_deg = least_angle_deg;
  options.fidelity_of_diagonal = std::clamp(fidelity * deviation / scan.reference().diagonal, tightest, loosest);
  for (int trial = 0; trial < trials; ++trial) {
    options.limit = (1 - for_volume * std::pow(2, trial)) * deviation;
    const BoundedRefinementResult refined =
        refine_within(surface, found.candidate.net, scan.reference(), options, progress);
    if (scan.is_closed())
      preserve_volume_clear(surface, scan.mesh, held_lines(found.candidate.net, surface.vertices.size()));
    found.candidate.largest_deviation = bound_deviation(surface, scan.mesh, {.limit = deviation}).upper();
    if (found.holds(deviation) || refined.largest_deviation > options.limit) break;
  }
  found.mean_edge_ratio = measure_triangles(surface).edge_ratio.mean;
}

// A surface with edges of about these lengths, and how far it is from the scan around each of the scan's vertices.
Found try_lengths(const std::vector<double>& length, const PreparedScanPointer& scan, double distance,
                  double most_triangles, const SimplifyOptions& options, Effort effort, std::vector<double>& deviation,
                  const Progress& progress) {
  SizingOptions sizing;
  sizing.gradation = options.gradation;
  ask_for_lengths(scan->mesh, length, sizing);
  sizing.triangles = std::clamp(sizing.triangles, fewest_faces, most_triangles);
  Found found;
  found.is_largest = sizing.triangles >= most_triangles;
  found.candidate = make_surface(scan, sizing, options, effort, progress);
  const PreparedScan& kept = *found.candidate.scan;
  const DeviationBound bound = bound_deviation(found.candidate.mesh, scan->mesh, {.limit = distance});
  deviation = kept.by_vertex(deviation_at_scan(found.candidate.mesh, kept.reference(), bound),
                             [](double a, double b) { return std::max(a, b); });
  found.candidate.largest_deviation = bound.upper();
  found.share_beyond = share_beyond(bound.to_reference, distance);
  found.mean_edge_ratio = measure_triangles(found.candidate.mesh).edge_ratio.mean;
  return found;
}

// Shorter edges where the deviation is too large, longer ones where it could be larger, up to `most_growing` times.
void renew(std::vector<double>& length, const std::vector<double>& deviation, double distance, double most_growing) {
  constexpr double margin = 0.8;          // of the distance, aimed at
  constexpr double most_shrinking = 0.5;  // of an edge from trial to trial
  constexpr double shortest_edge = 0.5;   // over the distance: shorter ones help nothing
  for (std::size_t v = 0; v < length.size(); ++v) {
    const double ratio = std::sqrt(margin * distance / std::max(deviation[v], 1e-3 * distance));
    length[v] = std::max(length[v] * std::clamp(ratio, std::min(most_shrinking, most_growing), most_growing),
                         shortest_edge * distance);
  }
}

// How much longer edges may be in the next trial. After the first, whose lengths are a guess, they only shrink, all of
// them where the shape asks for it.
double most_growing_after(int trial, double mean_edge_ratio) {
  // Reached where the first surface has a tenth of the deviation; flat parts of a scan have less.
  constexpr double after_first = 2.8;
  if (trial == 0) return after_first;
  if (mean_edge_ratio <= worst_mean_edge_ratio) return 1;
  // What the edge ratio exceeds 1 by is taken to go with the square of the edges.
  constexpr double aim = 0.01;             // below the worst
  constexpr double most_shrinking = 0.75;  // a guess may be wrong, and triangles go with the square
  return std::max(most_shrinking, std::sqrt((worst_mean_edge_ratio - aim - 1) / (mean_edge_ratio - 1)));
}

// The nearest of the surfaces tried, or the one with fewest triangles where several are near enough.
Found search_lengths(PreparedScanPointer scan, double distance, double most_triangles, std::span<const double> longest,
                     const SimplifyOptions& options, const Progress& progress) {
  std::vector<double> length(scan->mesh.vertices.size(), first_edge_over_deviation * distance);
  const auto keep_within_limits = [&] {
    for (std::size_t v = 0; v < longest.size(); ++v) length[v] = std::min(length[v], longest[v]);
  };
  keep_within_limits();
  std::vector<double> deviation;
  Found best;
  int failures = 0;
  for (int trial = 0; trial < most_trials; ++trial) {
    progress("deviation", static_cast<double>(trial) / most_trials);
    const bool first = trial == 0;
    Found found = try_lengths(length, scan, distance, most_triangles, options, first ? Effort::low : options.effort,
                              deviation, progress);
    const bool failed = found.gave_way();
    if (!first && !failed && found.is_shapely() && found.share_beyond <= few_beyond && !found.holds(distance))
      bring_within(found, distance, progress);
    const bool done = !first && found.holds(distance) && (found.is_shapely() || found.is_largest);
    const bool is_in_vain = failed || found.is_largest;
    const double most_growing = most_growing_after(trial, found.mean_edge_ratio);
    // What was too fine for the first guess need not be for the next, nor for other triangles of about the same size.
    if (!first && !failed) scan = found.candidate.scan;
    if (is_better(found, best, distance)) best = std::move(found);
    if (done || (is_in_vain && failures++ == most_failures)) break;
    if (failed && !first)
      for (double& l : length) l *= after_failure;
    else
      renew(length, deviation, distance, most_growing);
    keep_within_limits();
  }
  return best;
}

}  // namespace

Candidate make_surface_within(const PreparedScanPointer& scan, const LargestDeviation& wanted, double most_triangles,
                              std::span<const double> longest, const SimplifyOptions& options,
                              const Progress& progress) {
  const double distance = wanted.distance;
  Found best = search_lengths(scan, distance, most_triangles, longest, options, progress);
  if (!best.holds(distance) && best.share_beyond <= most_beyond) bring_within(best, distance, progress);
  // The deviation that was asked for comes before the tetrahedra.
  Candidate opened = best.candidate;
  if (open_wedges(opened, options)) {
    opened.largest_deviation = bound_deviation(opened.mesh, scan->mesh, {.limit = distance}).upper();
    if (!wanted.required || opened.largest_deviation <= distance) best.candidate = std::move(opened);
  }
  if (wanted.required && !best.holds(distance))
    throw NotMeshable({.what = "the deviation was not reached",
                       .where = {},
                       .value = std::to_string(best.candidate.largest_deviation) + " with " +
                                std::to_string(best.candidate.faces()) + " triangles",
                       .limit = std::to_string(distance),
                       .advice = "a larger --deviation, or --faces"});
  return std::move(best.candidate);
}

}  // namespace scan2fea
