// Simplification of a piece of surface between borders that another surface has made already.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/simplification/simplify_options.hpp"

#include <memory>
#include <vector>

namespace scan2fea {

struct SimplifiedSheet {
  SurfaceMesh mesh;
  // Per vertex, whether it is one of the border; and whether of that or of a crease.
  std::vector<bool> on_border, on_line;
  std::shared_ptr<const SurfaceOnScan> on_scan;  // refers to the sheet that it was made of
};

// `held`, per vertex: those of the sheet's border that are the border of the result, in their places, to the bit; each
// of its loops has three or more. Creases between are kept as on a scan. `edge_length`: of the result where it does not
// bend, model units. Of the options the deviation, in model units, and those of features and effort count. Throws
// NotMeshable where no valid surface comes out, Cancelled. Not guaranteed: the deviation.
SimplifiedSheet simplify_sheet(const SurfaceMesh& sheet, const std::vector<bool>& held, double edge_length,
                               const SimplifyOptions& options, const Progress& progress = {});

}  // namespace scan2fea
