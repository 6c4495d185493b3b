// Given lines found again as edges of a scan.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/features/feature_file.hpp"
#include "preproc/surface/features/find_features.hpp"

#include <vector>

namespace scan2fea {

struct MatchOptions {
  // How far the edges of the scan may be from a given line, as a fraction of the bounding box's diagonal, above 0.
  // 0.005: what repair or noise moves is less, and what lies beside a line on a part is farther.
  double farthest_of_diagonal = 0.005;
};

// Per line the edges along which the scan's vertices nearest to its ends are joined by the shortest way that stays near
// the line; an edge of the scan is found again as itself. Border edges are left out, since they are kept anyway.
// Sorted, each once. Precondition: the scan is manifold. Throws InvalidInput naming the place of a line that no edges
// follow. Each line costs a search among the vertices near it.
std::vector<FeatureEdge> match_features(const SurfaceMesh& scan, const VertexStars& stars, const FeatureLines& lines,
                                        const MatchOptions& options = {});

}  // namespace scan2fea
