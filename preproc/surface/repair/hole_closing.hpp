// Which holes of a surface are closed, and how their patches are kept from crossing the surface and one another.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/repair/repair_result.hpp"

#include <optional>

namespace scan2fea {

struct HoleClosingOptions {
  std::optional<double> largest_of_diagonal;  // see RepairOptions::largest_hole_of_diagonal
  double fragment_of_area = 0;                // see RepairOptions::fragment_of_area
};

// A hole's size is the diagonal of its border's bounding box. Components with a hole that is too large are dropped if
// they are fragments; NotMeshable names the hole otherwise. All other holes are filled (see make_patch): faired, and
// where such a patch crosses something, as a membrane, and at last by triangles of its border alone, which may still
// cross. Precondition: manifold, oriented. Nothing happens to a closed surface but one pass over its edges.
void close_holes(SurfaceMesh& mesh, const HoleClosingOptions& options, RepairResult& result, const Progress& progress);

}  // namespace scan2fea
