// One surface of given sizes, made of a scan: what `simplify` tries, and mends.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/fit/shape_fit.hpp"
#include "preproc/surface/simplification/prepared_scan.hpp"
#include "preproc/surface/simplification/simplify_options.hpp"

#include <string>
#include <vector>

namespace scan2fea {

// A closed surface needs four faces; fewer than this and no shape is left of anything.
inline constexpr double fewest_faces = 4;

// A surface that was made of a scan, and how.
struct Candidate {
  SurfaceMesh mesh;
  FeatureNet net;
  PreparedScanPointer scan;  // with the creases that `mesh` keeps
  SimplifyMethod method = SimplifyMethod::lattice;
  std::string fallback_reason = {};  // why `lattice` gave way to `collapse`; empty where it did not
  std::size_t crossings_mended = 0;
  std::string failure = {};          // empty where `mesh` is valid
  std::vector<Vec3> failed_at = {};  // places of what is wrong
  ShapeFitResult fit = {};
  // Per vertex of `scan`, where edges of the wanted size were too long for its shape and shorter ones were asked for:
  // then `scan` is another one, with smaller faces.
  std::vector<double> lengths_by_shape = {};
  double largest_deviation = 0;  // from the scan, two-sided, an upper bound; 0 where it was not bounded

  std::size_t faces() const { return mesh.triangles.size(); }
  std::size_t feature_edges() const { return edges_of(net).size(); }
};

// What may be done where a lattice of the wanted size is no good.
struct WaysOut {
  bool by_shape = true;     // more triangles for a part that does not keep its shape, unless a deviation is asked for
  bool contraction = true;  // instead of the lattice; else the candidate's failure says why it failed
};

// By the method asked for or, where the lattice fails, by contraction. Where triangles of this size are too large for
// the scan's creases, the candidate's scan has those that could be kept. Exact volume, and nothing that crosses itself
// unless `failure` says so. Throws NotMeshable where no way is left.
Candidate make_surface(const PreparedScanPointer& scan, const SizingOptions& sizing, const SimplifyOptions& options,
                       Effort effort, const WaysOut& ways, const Progress& progress);

// What a part's shape may take: triangles, about, and lattices. Three times the wanted triangles, or 8,000 but at most
// forty times as many; where the part would be lost, 40,000 but at most a thousand times as many.
struct ShapeBudget {
  double triangles;
  int trials;
};
ShapeBudget shape_budget(double wanted_triangles, bool lost_shape);

// By the lattice with edges as short as the scan's shape needs (shape_lengths.hpp), in places shorter where it fails.
// `failure` says so where none came out.
Candidate make_surface_by_shape(const PreparedScan& scan, const SizingOptions& sizing, const SimplifyOptions& options,
                                Effort effort, const ShapeBudget& budget, const Progress& progress);

// The largest distances are at a few fins and folds thinner than the triangles, far from all others: these places get
// triangles of their own, so few that the count stays within what was asked for. Where the effort asks for it, and not
// on scans with features.
void lower_worst(Candidate& candidate, Effort effort, const Progress& progress);

}  // namespace scan2fea
