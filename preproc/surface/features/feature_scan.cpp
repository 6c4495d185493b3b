#include "preproc/surface/features/feature_scan.hpp"

#include <algorithm>

namespace scan2fea {

FeatureScan::FeatureScan(const SurfaceMesh& mesh, std::vector<FeatureEdge> sharp_edges,
                         const CurveTolerance& curve_tolerance, std::vector<bool> held)
    : scan(mesh),
      sharp(std::move(sharp_edges)),
      border(boundary_edges(mesh)),
      tolerance(curve_tolerance),
      held_border(std::move(held)) {
  std::sort(sharp.begin(), sharp.end());
  if (empty()) return;
  cut = cut_along(mesh, sharp);
  patches = find_components(cut.mesh);
}

}  // namespace scan2fea
