// A scanner in the computer: points on any closed surface as an instrument would measure them, with what goes wrong.
#pragma once

#include "preproc/mesh/point_cloud.hpp"
#include "preproc/mesh/surface_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace scan2fea {

enum class OutlierKind {
  along_view,    // 1 to 4 % of the diagonal before or behind the surface
  near_surface,  // 0.5 to 1.5 %: at few points no farther than these are from one another
  in_box,        // anywhere in the bounding box
};

struct ScannerOptions {
  std::size_t points = 50'000;
  int positions = 6;      // of the scanner, about the part: its sides first, then between them
  double line_ratio = 2;  // distance of scan lines over that of points along them
  double noise = 0;       // standard deviation along the view, of the diagonal
  double outliers = 0;    // share of points
  OutlierKind outlier_kind = OutlierKind::along_view;
  int thinned_patches = 0;  // balls of 5 to 11 % of the diagonal in which few points stay
  double thinned_to = 0.2;  // share of points that stay there
  double grazing = 0.2;     // no return where the cosine between view and normal is less
  std::uint64_t seed = 1;
};

struct ScannedCloud {
  PointCloud cloud;              // with the true normals, and the scanner of each point
  std::vector<bool> is_outlier;  // of each point
};

// Each position sees the part in perspective, along lines that are neither even nor aligned with it; what is hidden is
// not measured, and positions overlap as those of real scans do. `points` are left in the end, or all that were seen
// where that is fewer. Seeded; about a microsecond a point and triangle row.
ScannedCloud scan_surface(const SurfaceMesh& surface, const ScannerOptions& options);

}  // namespace scan2fea
