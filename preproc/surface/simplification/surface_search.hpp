// The search for a surface that all its judges accept: make one, judge it, lower the wanted edge lengths where a judge
// says so, make it again; the best is kept.
//
// The judges: the deviation from the scan, where that is the size; the triangles' shape (shape_check.hpp); creases that
// could not be kept; and whoever uses the surface (run_again). Each says where edges would have to be shorter, and by
// how much. The search ends when none asks for more, or when its budget is spent: of triangles in one surface, of tries
// without a gain, and of work, which is counted in triangles made, so that the result does not depend on the machine.
#pragma once

#include "preproc/surface/features/planes_of_scan.hpp"
#include "preproc/surface/simplification/fine_creases.hpp"
#include "preproc/surface/simplification/surface_trial.hpp"
#include "quality/deviation_bound.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace scan2fea {

// What is wanted: a count of triangles, or a largest deviation in model units and at most so many triangles.
struct WantedSurface {
  double triangles = 0;
  std::optional<LargestDeviation> deviation;
  double left_to_noise = 0;     // of that deviation, which edges are not to be long for
  bool is_of_curved = false;    // triangles, that deviation
  std::vector<double> longest;  // edges allowed, per vertex of the scan, or empty
};

class SurfaceSearch {
 public:
  // A deviation far below the scan's own facets asks for more triangles than these, over the scan's own; nothing is
  // known there.
  static constexpr double most_of_scan = 32;
  // How far straight triangles are from a scan whose curved ones are at the deviation that is wanted, over it, at the
  // least; of less curves are not worth it.
  static constexpr double least_straight_over_curved = 3;

  SurfaceSearch(PreparedScanPointer scan, FineCreases fine_creases, PlanesOfScan planes, WantedSurface wanted,
                const SimplifyOptions& options);
  SurfaceSearch(const SurfaceSearch&) = delete;

  // The best surface that the budget allows. Throws what make_surface throws where not even the first could be made,
  // and NotMeshable where a deviation is required and was not reached.
  Candidate run(const Progress& progress);

  // One more, with shorter edges at these places. None where the budget is spent or there is no such surface. At most
  // `most_triangles`. To be called after `run`.
  std::optional<Candidate> run_again(std::span<const ShorterEdges> places, double most_triangles,
                                     const Progress& progress);

  // The last one with its vertices at these places, or as far towards them as nothing meets, and the scan's volume.
  // None where it would lose a deviation that was asked for. To be called after `run`.
  std::optional<Candidate> run_moved(const std::vector<Vec3>& places);
  std::vector<bool> held() const;  // vertices of the last one that are on lines
  // How far its other vertices may go off it: as far as it is from the scan, where no deviation was asked for.
  double way_off() const { return wanted_.deviation ? 0 : last_.candidate.fit.largest_distance; }

  const PlanesOfScan& planes() const { return planes_; }
  // Where more triangles were asked for than wanted; empty where not.
  const std::string& size_remark() const { return size_remark_; }
  double wanted_triangles() const { return wanted_.triangles; }
  // Of the scan as it was given, that triangles of no size asked for could keep.
  std::size_t too_fine_creases() const { return fine_creases_.left_out(); }

 private:
  using Trial = SurfaceTrial;

  // What was asked for last.
  struct Asked {
    std::vector<double> length;
    SizingOptions sizing;
  };
  Asked asked() const;
  void ask_again(Asked before);

  void set_first_sizing(const Progress& progress);
  Trial make_first(const Progress& progress);
  bool are_creases_noise(const Trial& first) const;
  void try_without_creases(Trial& latest, const Progress& progress);
  Trial make(bool may_contract, const Progress& progress);
  Trial make_by_shape(const Progress& progress);
  Trial judged(Candidate candidate, const Progress& progress);
  void judge_deviation(Trial& made, const Progress& progress);
  DeviationBound deviation_of(const Candidate& made, const DeviationReference& scan) const;
  DeviationBound note_deviation(Trial& made) const;
  void bring_within(Trial& made, double share_to_yield, std::size_t in_vain, const Progress& progress) const;
  void bring_curves_within(Trial& made, const Progress& progress) const;
  void put_on_planes(Trial& made) const;
  void mend_shape(Trial& made, const Progress& progress) const;
  void lower_lengths(const Trial& latest);
  void keep_creases_after(const Trial& latest);
  bool ask_for_lower_lengths(double most_triangles);
  double most_triangles() const;
  double straight_distance() const;
  TrialOrder order() const { return {wanted_.deviation, sizing_.triangles >= most_triangles()}; }
  bool holds(const Trial& made) const { return order().holds(made); }

  PreparedScanPointer first_scan_;
  PreparedScanPointer scan_;  // with the creases to ask for
  FineCreases fine_creases_;
  PlanesOfScan planes_;
  WantedSurface wanted_;
  const SimplifyOptions& options_;
  SizingOptions sizing_;
  std::vector<double> error_factors_;
  std::vector<double> length_;  // per vertex of the scan, as asked for last; empty before something was lowered
  Trial last_;                  // given
  double straight_over_curved_ = 1;
  double most_to_mend_ = 0;  // the share of faces too far that is left to the mending of places
  double work_ = 0;          // triangles made
  double first_work_ = 0;
  double most_work_ = 0;  // triangles that may be made
  std::string size_remark_;
};

}  // namespace scan2fea
