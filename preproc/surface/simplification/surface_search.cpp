#include "preproc/surface/simplification/surface_search.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/features/feature_selection.hpp"
#include "preproc/surface/fit/preserve_volume.hpp"
#include "preproc/surface/kernel/clear_moves.hpp"
#include "preproc/surface/simplification/error_sizing.hpp"
#include "preproc/surface/sizing/shape_lengths.hpp"
#include "preproc/surface/sizing/size_limits.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace scan2fea {
namespace {

// Of triangles that all together may be made, over those that were wanted, or those of the first surface.
constexpr double most_work = 5;
// A small part may cost so many whatever was wanted: they cost nothing. As many more where its user asks again.
constexpr double work_for_small = 50000;
// Curves are fitted to each surface and bounded, which takes several times as long.
constexpr double curved_work_for_small = work_for_small / 2;

// In one surface, over those that were wanted. A small part may have 8,000, but not more than forty times as many: who
// asks for 20 does not want 8,000.
constexpr double most_growth = 3, few_triangles = 8000, most_growth_of_small = 40;

// Tries without a gain, one after the other, after which it is given up. Another lattice may turn out better by chance,
// which is worth waiting for only where it costs little.
constexpr std::size_t many_triangles = 5000, very_many_triangles = 20000;
int patience(std::size_t triangles) {
  return triangles < many_triangles ? 3 : triangles < very_many_triangles ? 1 : 0;
}

// Angles that are aimed at. Where time matters, the optimisation of the tetrahedra copes with smaller ones.
constexpr double good_of_few_deg = 30, good_of_many_deg = 17;
// Wanted with fewer triangles than this, a part without its edges stands for nothing any more: edges go before angles.
constexpr double few_triangles_of_part = 1000;

// The share of faces too far that is left to the mending of places: more are cheaper mended by other lengths, all at
// once. The second is for the last surface, when there is no other way.
constexpr double few_beyond = 0.08, most_beyond = 0.15;
// Curved triangles are mended as straight ones, which takes more of them. Where more than the second share of the first
// ones are too far, the scan bends on a smaller scale than they do: then they are no better than straight ones.
constexpr double few_curves_beyond = 0.01, most_curves_beyond = 0.05;

// How far straight triangles are from a scan whose curved ones are at the deviation that is wanted, over it: the
// smoother the scan, the more.
constexpr std::array straight_over_curved{9.0, 5.0, SurfaceSearch::least_straight_over_curved};
// Of the faces: where more places are stuck, shorter edges in each cost more than another surface.
constexpr double most_stuck = 0.01;

// How many places more may be tried in vain than come nearer, before another surface is made and on the last one: each
// costs as much as a surface of several hundred triangles.
constexpr std::size_t few_in_vain = 12, most_in_vain = 40;

// Around bad places edge lengths may grow this many times as fast as elsewhere: at the surface's own gradation a few
// short edges would drag those of a whole neighbourhood along.
constexpr double gradation_around_bad = 2;

// Where the shorter lengths ask for fewer triangles more than this, the other edges grow to make up for them.
constexpr double room_for_places = 1.05;

// Exponent of the local error in the edge lengths' renewal (see error_factors). Equal errors everywhere would take 0.5;
// less leaves shape to the gradation.
constexpr double error_renewal = 0.3;

double share_beyond(const OneSidedDeviation& side, double distance) {
  return static_cast<double>(std::ranges::count_if(side.upper, [&](double d) { return d > distance; })) /
         static_cast<double>(side.upper.size());
}

// What the edge ratio exceeds 1 by is taken to go with the square of the edges; a guess may be wrong.
double shortening_for_shape(double mean_edge_ratio) {
  constexpr double aim = 0.01;  // below the worst
  return std::max(least_shortening, std::sqrt((worst_mean_edge_ratio - aim - 1) / (mean_edge_ratio - 1)));
}

// From the Horse, igea, the bunny and fandisk with 5,000 to 80,000 triangles, within a factor of two.
double processor_seconds_of_surface(double triangles, std::size_t of_scan, Effort effort) {
  const double of_effort = effort == Effort::low ? 0.7 : effort == Effort::high ? 5 : 1;
  return of_effort * (45e-6 * triangles + 2e-6 * static_cast<double>(of_scan));
}

NotMeshable no_gain_of_curves() {
  return NotMeshable({.what = "curved triangles come no nearer than straight ones",
                      .where = {},
                      .value = {},
                      .limit = {},
                      .advice = "straight ones"});
}

std::string count(double triangles) {
  return std::to_string(std::lround(triangles));
}

}  // namespace

SurfaceSearch::SurfaceSearch(PreparedScanPointer scan, FineCreases fine_creases, PlanesOfScan planes,
                             WantedSurface wanted, const SimplifyOptions& options)
    : first_scan_(scan),
      scan_(std::move(scan)),
      fine_creases_(std::move(fine_creases)),
      planes_(std::move(planes)),
      wanted_(std::move(wanted)),
      options_(options) {
  sizing_.triangles = wanted_.triangles;
  sizing_.sizing = options.sizing;
  sizing_.gradation = options.gradation;
}

Candidate SurfaceSearch::run(const Progress& progress) {
  most_to_mend_ = wanted_.is_of_curved ? few_curves_beyond : few_beyond;
  Trial latest = make_first(progress);
  if (are_creases_noise(latest)) try_without_creases(latest, progress);
  Trial best = latest;
  first_work_ = work_;
  most_work_ = std::max(most_work * (wanted_.deviation ? first_work_ : wanted_.triangles),
                        wanted_.is_of_curved ? curved_work_for_small : work_for_small);
  if (options_.method != SimplifyMethod::lattice) return std::move(best.candidate);
  bool was_by_shape = false;
  int in_vain = 0;
  const auto is_missing = [&] { return wanted_.deviation && wanted_.deviation->required && !holds(best); };
  while (!order().is_accepted(latest) &&
         ((is_missing() && !wanted_.is_of_curved) || in_vain <= patience(latest.candidate.faces())) &&
         progress.may_improve()) {
    Asked before = asked();
    lower_lengths(latest);
    if (!ask_for_lower_lengths(most_triangles())) {
      ask_again(std::move(before));  // whoever asks for shorter ones goes on from what was made
      break;
    }
    // The creases of free forms are specks and folds: smaller triangles are no reason to keep them.
    if (wanted_.deviation && fine_creases_.left_out() > 0 && &scan_->mesh == &first_scan_->mesh &&
        is_part(scan_->given))
      scan_ = fine_creases_.with_those_kept_by(length_, scan_);
    try {
      const bool by_shape = latest.failed() && wanted_.deviation && !was_by_shape && is_part(scan_->given);
      was_by_shape |= by_shape;
      const Progress in_time = best.failed() ? progress : progress.for_improvement();
      latest = by_shape ? make_by_shape(in_time) : make(best.gave_way() && !best.failed(), in_time);
    } catch (const NotMeshable&) {
      break;
    }
    in_vain = order().gains(latest, best) ? 0 : in_vain + 1;
    if (order().is_better(latest, best)) best = latest;
  }
  if (best.failed()) best = make(true, progress);
  if (!holds(best))
    progress.improve([&](const Progress& in_time) {
      // The places of a contraction are not what keeps it far.
      if (best.share_beyond <= most_beyond && (!best.gave_way() || wanted_.deviation->required))
        is_missing() ? bring_within(best, 1, best.candidate.faces(), in_time)
                     : bring_within(best, most_stuck, most_in_vain, in_time);
      mend_shape(best, in_time);
    });
  if (wanted_.is_of_curved && !holds(best)) throw no_gain_of_curves();
  if (is_missing())
    throw NotMeshable({.what = "the deviation was not reached",
                       .where = {},
                       .value = std::to_string(best.candidate.largest_deviation / wanted_.deviation->distance) +
                                " times as far, with " + count(static_cast<double>(best.candidate.faces())) +
                                " triangles",
                       .limit = {},
                       .advice = std::string(progress.may_improve() ? "" : "a longer --time-limit, ") +
                                 "a larger --deviation, or --faces"});
  most_work_ = std::max(most_work_, work_ + work_for_small);
  put_on_planes(best);
  return (last_ = std::move(best)).candidate;
}

std::optional<Candidate> SurfaceSearch::run_again(std::span<const ShorterEdges> places, double most_triangles,
                                                  const Progress& progress) {
  most_to_mend_ = few_beyond;
  if (length_.empty()) length_ = scan_->wanted_lengths(sizing_);
  shorten_around(places, scan_->mesh, length_);
  if (!ask_for_lower_lengths(most_triangles)) return {};
  try {
    Trial made = make(last_.gave_way(), progress);
    if (made.failed()) {
      lower_lengths(made);
      if (!ask_for_lower_lengths(most_triangles)) return {};
      made = make(last_.gave_way(), progress);
      if (made.failed()) return {};
    }
    if (!holds(made)) mend_shape(made, progress);
    put_on_planes(made);
    // What was asked for first comes before what is asked for now.
    if (holds(last_) && !holds(made)) return {};
    last_ = std::move(made);
    return last_.candidate;
  } catch (const NotMeshable&) {
    return {};
  }
}

std::optional<Candidate> SurfaceSearch::run_moved(const std::vector<Vec3>& places) {
  const PreparedScan& scan = *last_.candidate.scan;
  Trial moved = last_;
  SurfaceMesh& mesh = moved.candidate.mesh;
  move_clear(mesh, places);
  if (scan.is_closed()) preserve_volume_clear(mesh, scan.mesh, held_lines(moved.candidate.net, mesh.vertices.size()));
  if (wanted_.deviation) note_deviation(moved);
  put_on_planes(moved);
  if (holds(last_) && !holds(moved)) return {};
  last_ = std::move(moved);
  return last_.candidate;
}

std::vector<bool> SurfaceSearch::held() const {
  std::vector<bool> held(last_.candidate.mesh.vertices.size(), false);
  for (const FeatureEdge& edge : edges_of(last_.candidate.net))
    for (const std::uint32_t v : edge) held[v] = true;
  return held;
}

void SurfaceSearch::set_first_sizing(const Progress& progress) {
  if (wanted_.deviation) {
    const double of_shape = wanted_.deviation->distance - wanted_.left_to_noise;
    length_ = lengths_for_deviation(scan_->mesh, straight_over_curved_ * of_shape, wanted_.left_to_noise,
                                    options_.gradation, scan_->has_features() ? &scan_->features().cut : nullptr);
    // With nodes in their middles the longest edges have them as near to one another as straight ones have.
    const double longest = 2 * longest_over_deviation * of_shape;
    if (wanted_.is_of_curved)
      for (double& l : length_) l = std::min(l, longest);
    ask_for_lower_lengths(most_triangles());
    return;
  }
  if (options_.sizing == Sizing::error) {
    // A quick first surface shows where edges of the curvature's lengths come too far from the scan.
    sizing_.sizing = Sizing::curvature;
    const Candidate first = make_surface(scan_, sizing_, options_, Effort::low, {}, progress);
    if (first.lengths_by_shape.empty()) {
      scan_ = first.scan;  // creases that it could not keep are not asked for again
      error_factors_ = scan_->by_vertex(error_factors(first.mesh, scan_->reference(), error_renewal),
                                        [](double a, double b) { return std::min(a, b); });
      sizing_.factors = error_factors_;
    }
  }
  if (wanted_.longest.empty()) return;
  const bool keeps_count = !std::holds_alternative<MeanEdgeLength>(options_.size);
  length_ = within_limits(scan_->mesh, scan_->wanted_lengths(sizing_), wanted_.longest, options_.gradation,
                          keeps_count ? std::optional(wanted_.triangles) : std::nullopt);
  ask_for_lengths(scan_->mesh, length_, sizing_);
  if (keeps_count && sizing_.triangles > 1.01 * wanted_.triangles)
    size_remark_ = "boxes, balls and elements across walls need about " + count(sizing_.triangles) +
                   " triangles instead of " + count(wanted_.triangles);
  wanted_.triangles = sizing_.triangles;
}

// Of curved triangles it is not known before how much larger they may be: much, where the scan is smooth.
SurfaceSearch::Trial SurfaceSearch::make_first(const Progress& progress) {
  if (!wanted_.is_of_curved) {
    set_first_sizing(progress);
    return make(!wanted_.deviation, progress);
  }
  for (const double factor : straight_over_curved) {
    straight_over_curved_ = factor;
    set_first_sizing(progress);
    Trial first = make(false, progress);
    if (!first.failed() && first.share_beyond <= most_curves_beyond) return first;
  }
  throw no_gain_of_curves();
}

// Under noise creases are found in pieces, beside where they are, and triangles between them are poor.
bool SurfaceSearch::are_creases_noise(const Trial& first) const {
  const bool may_drop = !options_.given_features || options_.may_drop_given;
  return may_drop && wanted_.left_to_noise > 0 && scan_->has_creases() && !first.failed() &&
         first.shape.sharpest() < usable_deg;
}

void SurfaceSearch::try_without_creases(Trial& latest, const Progress& progress) {
  Asked before = asked();
  const PreparedScanPointer with = std::exchange(scan_, with_creases(scan_, {}));
  try {
    Trial without = make_first(progress.for_improvement());
    if (order().is_better(without, latest)) {
      latest = std::move(without);
      return;
    }
  } catch (const NotMeshable&) {  // for want of time, too
  }
  scan_ = with;
  ask_again(std::move(before));
}

SurfaceSearch::Asked SurfaceSearch::asked() const {
  return {length_, sizing_};
}

void SurfaceSearch::ask_again(Asked before) {
  length_ = std::move(before.length);
  sizing_ = before.sizing;
  if (!length_.empty()) sizing_.factors = length_;  // which they refer to
}

SurfaceSearch::Trial SurfaceSearch::make(bool may_contract, const Progress& progress) {
  progress.announce("a surface of about " + count(sizing_.triangles) + " triangles",
                    processor_seconds_of_surface(sizing_.triangles, scan_->mesh.triangles.size(), options_.effort));
  // What the shape needs does not change from one surface to the next.
  const WaysOut ways{.by_shape = work_ == 0, .contraction = may_contract};
  return judged(make_surface(scan_, sizing_, options_, options_.effort, ways, progress), progress);
}

// Where no lattice of the wanted lengths came out: edges as short as the scan's shape needs.
SurfaceSearch::Trial SurfaceSearch::make_by_shape(const Progress& progress) {
  Candidate made = make_surface_by_shape(*scan_, sizing_, options_, options_.effort,
                                         shape_budget(sizing_.triangles, true), progress);
  return made.failure.empty() ? judged(std::move(made), progress) : make(false, progress);
}

SurfaceSearch::Trial SurfaceSearch::judged(Candidate candidate, const Progress& progress) {
  Trial made{.candidate = std::move(candidate)};
  if (!made.candidate.lengths_by_shape.empty()) {
    scan_ = made.candidate.scan;
    length_ = made.candidate.lengths_by_shape;
    sizing_.factors = length_;
    wanted_.longest.clear();  // of another mesh's vertices, and in these lengths already
  }
  work_ += static_cast<double>(made.candidate.faces());
  if (made.failed()) {
    progress.explain(order().verdict(made));
    return made;
  }
  // A bound is found first, and planes as far as it allows at the end.
  if (!wanted_.deviation || !wanted_.deviation->required) put_on_planes(made);
  if (wanted_.deviation)
    judge_deviation(made, progress);
  else if (made.candidate.method == SimplifyMethod::lattice)
    progress.improve([&](const Progress& in_time) { lower_worst(made.candidate, options_.effort, in_time); });
  if (holds(made))  // else it is made again
    progress.improve([&](const Progress& in_time) { mend_shape(made, in_time); });
  made.mean_edge_ratio = measure_triangles(made.candidate.mesh).edge_ratio.mean;
  const bool few = made.candidate.faces() < many_triangles && !wanted_.deviation;
  made.shape = find_shape_defects(made.candidate, few ? good_of_few_deg : good_of_many_deg);
  made.is_other_part = made.lost_creases(*scan_) && wanted_.triangles < few_triangles_of_part && !wanted_.deviation;
  progress.explain(order().verdict(made));
  return made;
}

void SurfaceSearch::judge_deviation(Trial& made, const Progress& progress) {
  made.share_beyond = share_beyond(note_deviation(made).to_reference, wanted_.deviation->distance);
  made.mean_edge_ratio = measure_triangles(made.candidate.mesh).edge_ratio.mean;
  if (holds(made) || made.gave_way() || !order().is_shapely(made) || made.share_beyond > most_to_mend_) return;
  progress.improve([&](const Progress& in_time) { bring_within(made, most_stuck, few_in_vain, in_time); });
  if (!holds(made) && !wanted_.deviation->required)
    most_to_mend_ = made.share_beyond / 2;  // more of the kind cannot either
}

// The creases to ask for after this surface: none where they would ask for smaller triangles everywhere though few are
// bad without them, and no corners too narrow for a triangle.
void SurfaceSearch::keep_creases_after(const Trial& latest) {
  if (wanted_.deviation && !latest.gave_way()) scan_ = latest.candidate.scan;
  if (latest.lost_creases(*scan_) && !latest.gave_way() && !latest.has_many_bad() && !latest.is_other_part)
    scan_ = with_creases(scan_, {});
  else
    scan_ = with_creases(scan_, without_narrow_corners(scan_->mesh, scan_->creases(), latest.shape.sharp_corners));
}

// Around what is bad, or everywhere where that is the surface as a whole.
void SurfaceSearch::lower_lengths(const Trial& latest) {
  if (length_.empty()) length_ = latest.candidate.scan->wanted_lengths(sizing_);
  const bool lost = latest.lost_creases(*scan_);
  keep_creases_after(latest);
  double everywhere = 1;
  const std::vector<ShorterEdges> failed = latest.failed_places();
  if (!failed.empty()) {
    shorten_around(failed, scan_->mesh, length_);
  } else if (latest.gave_way() || (lost && latest.has_many_bad()) || latest.is_other_part) {
    everywhere = least_shortening;
  } else {
    if (!holds(latest))
      shorten_by_deviation(latest.deviation, wanted_.deviation->distance, latest.was_mended ? least_shortening : 1,
                           length_);
    if (!order().is_shapely(latest)) everywhere = shortening_for_shape(latest.mean_edge_ratio);
    if (holds(latest) && order().is_shapely(latest)) shorten_around(latest.shape.bad, scan_->mesh, length_);
  }
  for (double& l : length_) l *= everywhere;
}

// False where these lengths are not worth another surface.
bool SurfaceSearch::ask_for_lower_lengths(double most_triangles) {
  for (std::size_t v = 0; v < wanted_.longest.size(); ++v) length_[v] = std::min(length_[v], wanted_.longest[v]);
  limit_gradation(scan_->mesh, (wanted_.deviation ? 1 : gradation_around_bad) * options_.gradation, length_);
  const double before = sizing_.triangles;
  ask_for_lengths(scan_->mesh, length_, sizing_);
  if (wanted_.deviation) {
    const bool had_most = before >= most_triangles && first_work_ > 0;
    sizing_.triangles = std::clamp(sizing_.triangles, fewest_faces, most_triangles);
    if (had_most) return false;
  } else if (sizing_.triangles < room_for_places * wanted_.triangles) {
    sizing_.triangles = wanted_.triangles;  // a few places cost the others little
  }
  return sizing_.triangles <= most_triangles && (work_ == 0 || work_ + sizing_.triangles <= most_work_);
}

double SurfaceSearch::straight_distance() const {
  return (wanted_.is_of_curved ? straight_over_curved_ : 1) * wanted_.deviation->distance;
}

double SurfaceSearch::most_triangles() const {
  if (wanted_.deviation) return most_of_scan * static_cast<double>(scan_->mesh.triangles.size());
  return std::max(most_growth * wanted_.triangles, std::min(few_triangles, most_growth_of_small * wanted_.triangles));
}

}  // namespace scan2fea
