#include "preproc/surface/simplification/fewer_creases.hpp"

#include "preproc/surface/features/feature_selection.hpp"
#include "preproc/surface/kernel/components.hpp"
#include "quality/triangle_measures.hpp"

namespace scan2fea {
namespace {

double mean_edge(const Candidate& candidate) {
  return equilateral_edge(surface_area(candidate.mesh), static_cast<double>(candidate.faces()));
}

}  // namespace

PreparedScanPointer without_short_creases(const Candidate& failed) {
  constexpr double longest = 0.5;  // of a body's diagonal: the folds of a scan, not the edges of a part
  constexpr double reach = 2;      // mean edges
  const PreparedScan& scan = *failed.scan;
  return with_creases(failed.scan,
                      without_short_creases_near(scan.mesh, scan.creases(), failed.failed_at, reach * mean_edge(failed),
                                                 longest * body_sizes(scan.mesh).largest));
}

PreparedScanPointer without_pieces(const Candidate& failed, const std::vector<Vec3>& places, double reach) {
  const PreparedScan& scan = *failed.scan;
  return with_creases(failed.scan, without_creases_near(scan.mesh, scan.creases(), places, reach * mean_edge(failed)));
}

}  // namespace scan2fea
