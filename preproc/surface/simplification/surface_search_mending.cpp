// How the search mends a surface that it made: brought within a deviation, put onto planes, places of bad shape.
#include "preproc/mesh/error_text.hpp"
#include "preproc/surface/curved/curved_deviation.hpp"
#include "preproc/surface/curved/fit_curves.hpp"
#include "preproc/surface/fit/preserve_volume.hpp"
#include "preproc/surface/kernel/clear_moves.hpp"
#include "preproc/surface/mending/local_refinement.hpp"
#include "preproc/surface/mending/mend_places.hpp"
#include "preproc/surface/simplification/deviation_at_scan.hpp"
#include "preproc/surface/simplification/surface_search.hpp"
#include "preproc/surface/simplification/vertices_beyond.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace scan2fea {
namespace {

// Places below are mended where they are.
constexpr double mended_deg = 30;

// With more places, over the triangles, another surface costs less than the mending of each.
constexpr double few_bad_places = 0.03;

// Of curved triangles, that may be too far if some of them may stay straight.
constexpr double few_straight = 0.05;

// Of a deviation, what is left to the shift that restores the volume.
constexpr double for_volume = 0.005;

}  // namespace

// Per triangle of the surface and of the scan; of curved ones where these count.
DeviationBound SurfaceSearch::deviation_of(const Candidate& made, const DeviationReference& scan) const {
  const double distance = wanted_.deviation->distance;
  if (!wanted_.is_of_curved) return bound_deviation(made.mesh, scan, {.limit = distance});
  const KeptDeviation kept{scan, distance};
  const auto bound = [&](const KeptDeviation* to_keep) {
    const FittedCurves fitted = fit_curves(made.mesh, made.net, made.scan->reference(), planes_, false, to_keep);
    return bound_curved_deviation(fitted.surface, kept);
  };
  DeviationBound free = bound(nullptr);
  const auto far = std::ranges::count_if(free.to_reference.upper, [&](double upper) { return upper > distance; });
  // Many are not so few that some straight triangles would help.
  if (free.holds(distance) || static_cast<double>(far) > few_straight * static_cast<double>(made.faces())) return free;
  return bound(&kept);
}

DeviationBound SurfaceSearch::note_deviation(Trial& made) const {
  const PreparedScan& scan = *made.candidate.scan;
  const SurfaceMesh& mesh = made.candidate.mesh;
  DeviationBound bound = deviation_of(made.candidate, scan.deviation_reference());
  // Edges as short as the shape needs came with a scan of other faces.
  made.candidate.largest_deviation = &scan.mesh == &first_scan_->mesh
                                         ? bound.upper()
                                         : deviation_of(made.candidate, first_scan_->deviation_reference()).upper();
  made.deviation.clear();
  if (!holds(made))
    made.deviation = scan.by_vertex(deviation_at_scan(mesh, scan.reference(), bound),
                                    [](double a, double b) { return std::max(a, b); });
  return bound;
}

// What the edge lengths leave too far is brought near place by place; then the exact volume.
void SurfaceSearch::bring_within(Trial& made, double share_to_yield, std::size_t in_vain,
                                 const Progress& progress) const {
  if (wanted_.is_of_curved) return bring_curves_within(made, progress);
  constexpr int trials = 3;  // the shift that restores the volume takes a little of the deviation, or more
  constexpr double least_angle_deg = 30;
  // What the patches' fits must follow, over the deviation; no looser than mending is (MendOptions), and not so tight
  // that shape has no say.
  constexpr double fidelity = 0.3, tightest = 1e-4, loosest = 1.6e-3;
  Trial within = made;
  within.was_mended = true;
  const double deviation = wanted_.deviation->distance;
  const PreparedScan& scan = *within.candidate.scan;
  SurfaceMesh& surface = within.candidate.mesh;
  LocalRefinementOptions options;
  options.least_angle_deg = least_angle_deg;
  options.fidelity_of_diagonal = std::clamp(fidelity * deviation / scan.reference().diagonal, tightest, loosest);
  options.most_in_vain = in_vain;
  options.most_to_yield = static_cast<std::size_t>(share_to_yield * static_cast<double>(made.candidate.faces()));
  for (int trial = 0; trial < trials; ++trial) {
    options.limit = (1 - for_volume * std::pow(2, trial)) * deviation;
    const BoundedRefinementResult refined =
        refine_within(surface, within.candidate.net, scan.reference(), scan.deviation_reference(), options, progress);
    if (scan.is_closed())
      preserve_volume_clear(surface, scan.mesh, held_lines(within.candidate.net, surface.vertices.size()));
    note_deviation(within);
    progress.explain(std::to_string(refined.changes.patches) + " places too far from the scan were mended by " +
                     std::to_string(refined.changes.inserted) + " vertices more; now at most " +
                     error_text(within.candidate.largest_deviation / deviation, 3) + " times as far as is wanted");
    if (holds(within) || refined.largest_deviation > options.limit) break;
  }
  // What is only aimed at is not worth triangles that solvers warn of.
  if (order().is_aim()) {
    const double angle = find_shape_defects(within.candidate, usable_deg).sharpest();
    if (angle < usable_deg && angle < find_shape_defects(made.candidate, usable_deg).sharpest()) return;
  }
  made = std::move(within);
}

// The same where curved triangles count: those that are too far are brought within the deviation as straight ones.
void SurfaceSearch::bring_curves_within(Trial& made, const Progress& progress) const {
  constexpr int rounds = 8;
  constexpr double least_angle_deg = 30;
  const double distance = wanted_.deviation->distance;
  const PreparedScan& scan = *made.candidate.scan;
  MendPlacesOptions options;
  options.limit = straight_distance();
  options.least_angle_deg = least_angle_deg;
  made.was_mended = true;
  Trial latest = made;
  DeviationBound bound = note_deviation(latest);
  for (int round = 0; round < rounds && !holds(latest); ++round) {
    SurfaceMesh& mesh = latest.candidate.mesh;
    const std::vector<std::uint32_t> far = triangles_beyond(mesh, bound, distance);
    const MendPlacesResult result =
        bring_faces_within(mesh, latest.candidate.net, scan.reference(), &scan.deviation_reference().tree(), far,
                           (1 - for_volume) * distance, options, progress);
    if (result.mended == 0) break;
    if (scan.is_closed())
      preserve_volume_clear(mesh, scan.mesh, held_lines(latest.candidate.net, mesh.vertices.size()));
    bound = note_deviation(latest);
    progress.explain("around " + std::to_string(far.size()) + " curved triangles too far from the scan " +
                     std::to_string(result.mended) + " places were mended by " + std::to_string(result.inserted) +
                     " vertices more; now at most " + error_text(latest.candidate.largest_deviation / distance, 3) +
                     " times as far as is wanted");
    if (latest.candidate.largest_deviation < made.candidate.largest_deviation) made = latest;
  }
  if (holds(latest)) made = std::move(latest);
}

// What is plane on the scan is plane; the volume then comes from what is not, or from the planes as a whole. Vertices
// without which a deviation that was reached is lost stay where they are.
void SurfaceSearch::put_on_planes(Trial& made) const {
  constexpr int trials = 4;
  const PreparedScan& scan = *made.candidate.scan;
  if (planes_.empty() || made.failed() || made.candidate.method != SimplifyMethod::lattice) return;
  VerticesOnPlanes on_planes = planes_.vertices_of(made.candidate.mesh, made.candidate.net);
  const bool was_judged = wanted_.deviation && made.candidate.largest_deviation > 0;
  for (int trial = 0; trial < trials; ++trial) {
    Trial flat = made;
    SurfaceMesh& mesh = flat.candidate.mesh;
    move_clear(mesh, on_planes.places);
    if (scan.is_closed() &&
        !preserve_volume_clear(mesh, scan.mesh, held_lines(flat.candidate.net, mesh.vertices.size()),
                               on_planes.outwards))
      return;
    if (was_judged) {
      const DeviationBound bound = note_deviation(flat);
      if (holds(made) && !holds(flat)) {
        for (const std::uint32_t v : vertices_beyond(mesh, bound, wanted_.deviation->distance)) {
          on_planes.places[v] = made.candidate.mesh.vertices[v];
          on_planes.outwards[v].setZero();
        }
        continue;
      }
    }
    made = std::move(flat);
    return;
  }
}

// Few bad triangles, folds and wedges are mended where they are. No tree of the scan is made for this alone: on a large
// one it would be the peak of the memory.
void SurfaceSearch::mend_shape(Trial& made, const Progress& progress) const {
  // Of a contraction only what no solver takes: it leaves more than patches can mend.
  const bool by_lattice = made.candidate.method == SimplifyMethod::lattice;
  const double least = by_lattice ? mended_deg : usable_deg;
  const std::vector<ShorterEdges> bad = find_shape_defects(made.candidate, least).bad;
  if (bad.empty() || static_cast<double>(bad.size()) > few_bad_places * static_cast<double>(made.candidate.faces()))
    return;
  const PreparedScan& scan = *made.candidate.scan;
  Trial mended = made;
  SurfaceMesh& mesh = mended.candidate.mesh;
  MendPlacesOptions options;
  options.limit = wanted_.deviation ? (1 - for_volume) * straight_distance() : made.candidate.fit.largest_distance;
  options.least_angle_deg = least;
  if (!(options.limit > 0)) options.limit = mean_edge_length(made.candidate.mesh);
  // What is plane stays plane.
  if (by_lattice && scan.has_creases()) options.fidelity_of_diagonal = made.candidate.fit.fidelity_of_diagonal;
  const MendPlacesResult result = mend_places(mesh, mended.candidate.net, scan.reference(),
                                              wanted_.deviation ? &scan.deviation_reference().tree() : nullptr,
                                              without_overlaps(bad), options, progress);
  progress.explain(std::to_string(result.mended) + " badly shaped places were mended where they are, " +
                   std::to_string(result.left) + " could not");
  if (result.mended == 0) return;
  if (scan.is_closed()) preserve_volume_clear(mesh, scan.mesh, held_lines(mended.candidate.net, mesh.vertices.size()));
  if (wanted_.deviation) note_deviation(mended);
  if (holds(made) && !holds(mended)) return;
  made = std::move(mended);
}

}  // namespace scan2fea
