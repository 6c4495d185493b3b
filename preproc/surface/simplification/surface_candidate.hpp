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

struct Candidate {
  SurfaceMesh mesh;
  FeatureNet net;
  std::size_t crossings_mended = 0;
  std::string failure;          // empty where `mesh` is valid
  std::vector<Vec3> failed_at;  // places of what is wrong
  ShapeFitResult fit;
};

// By the method asked for or, where the lattice fails, by contraction; the result's method and remarks say which, and
// what became of the creases. Exact volume, and nothing that crosses itself. Throws NotMeshable where no way is left.
Candidate make_surface(PreparedScan& scan, const SizingOptions& sizing, const SimplifyOptions& options, Effort effort,
                       SimplifyResult& result, const Progress& progress);

// The largest distances are at a few fins and folds thinner than the triangles, far from all others: these places get
// triangles of their own, so few that the count stays within what was asked for. Where the effort asks for it.
void lower_worst(Candidate& candidate, PreparedScan& scan, Effort effort, SimplifyResult& result,
                 const Progress& progress);

// What bounds the tetrahedra's angles, where that is asked for (see wedges.hpp); what is sharp in the scan stays so.
// Whether something was opened.
bool open_wedges(Candidate& candidate, PreparedScan& scan, const SimplifyOptions& options);

}  // namespace scan2fea
