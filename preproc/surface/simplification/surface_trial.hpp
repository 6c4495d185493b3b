// One surface that the search made, what its judges say of it, and which of two is better.
#pragma once

#include "preproc/surface/simplification/shape_check.hpp"
#include "preproc/surface/simplification/surface_candidate.hpp"
#include "preproc/surface/sizing/shorter_edges.hpp"

#include <optional>
#include <string>
#include <vector>

namespace scan2fea {

// Solvers warn of smaller angles: then a surface farther from the scan is better.
inline constexpr double usable_deg = 5;

// Where triangles as large as the deviation allows are too large for the part's edges, smaller ones keep their shape.
// The bound is where isotropic remeshing with kept edges ends (CGAL: 1.18 to 1.21 on plates, cubes and cylinders).
inline constexpr double worst_mean_edge_ratio = 1.18;

struct SurfaceTrial {
  Candidate candidate = {};
  ShapeDefects shape = {};
  double mean_edge_ratio = 1;
  double share_beyond = 0;             // of the faces, farther from the scan than wanted, before places were mended
  std::vector<double> deviation = {};  // around each vertex of the scan, where it is beyond what was asked for
  bool was_mended = false;             // place by place
  bool is_other_part = false;          // a small part without its edges is another part

  bool failed() const { return !candidate.failure.empty(); }  // then there is no more to it than that
  bool gave_way() const { return failed() || !candidate.fallback_reason.empty(); }
  bool lost_creases(const PreparedScan& scan) const { return scan.has_creases() && candidate.feature_edges() == 0; }
  bool has_many_bad() const;
  std::vector<ShorterEdges> failed_places() const;  // of the lattice; empty where they are many
};

// What counts, in the order in which it does.
struct TrialOrder {
  const std::optional<LargestDeviation>& deviation;  // that is wanted
  bool takes_any_shape;                              // no more triangles are allowed that might mend it

  bool is_aim() const { return deviation && !deviation->required; }
  bool holds(const SurfaceTrial& made) const;  // the deviation
  bool is_shapely(const SurfaceTrial& made) const;
  bool is_accepted(const SurfaceTrial& made) const;
  bool is_better(const SurfaceTrial& made, const SurfaceTrial& other) const;
  bool gains(const SurfaceTrial& made, const SurfaceTrial& best) const;  // by more than chance
  std::string verdict(const SurfaceTrial& made) const;                   // why it is accepted or not, for people
};

}  // namespace scan2fea
