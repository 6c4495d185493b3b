// Sharp edges and borders of a scan, joined into curves between corners.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

// A polyline along edges of the scan.
struct FeatureCurve {
  // Of the scan, in order. Closed: the last joins the first, which is not repeated. Open: both ends are corners, and
  // may be the same one, which is then there twice.
  std::vector<std::uint32_t> vertices;
  bool closed = false;
  bool border = false;  // along the scan's border
};

struct FeatureCurves {
  std::vector<FeatureCurve> curves;    // each feature and border edge is in exactly one
  std::vector<std::uint32_t> corners;  // vertices of the scan, sorted
};

struct CornerOptions {
  // A curve that turns by more than this, measured over `reach` wanted edge lengths to either side, has a corner there;
  // degrees, 0 to 180.
  double turn_deg = 40;
  double reach = 0.4;
  // The same for curves that zigzag from vertex to vertex, such as the rims that a scanner leaves.
  double jagged_turn_deg = 70;
  double jagged_reach = 0.6;
};

// `points`: the scan's vertices; `sharp` and `border`: its edges, see find_features and boundary_edges, none in both;
// `edge_length`: wanted, per vertex, model units. Corners are the vertices at which other than two of these edges end,
// or one of either kind, and those where a curve turns sharply. Linear but for sorts.
FeatureCurves trace_feature_curves(const std::vector<Vec3>& points, const std::vector<FeatureEdge>& sharp,
                                   const std::vector<FeatureEdge>& border, const std::vector<double>& edge_length,
                                   const CornerOptions& options = {});

}  // namespace scan2fea
