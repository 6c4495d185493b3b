// Folds of a triangulation, undone by turning edges.
#pragma once

#include "preproc/surface/enrichment/clear_surface.hpp"
#include "preproc/surface/enrichment/surface_labels.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <cstddef>

namespace scan2fea {

// Turns edges at which two faces lie nearly upon one another, where the sharpest bend around is less sharp afterwards
// and nothing meets. Restored creases stay. Returns the number of edges turned. Between the faces of points that a scan
// hardly saw, whose triangulation is chance, such folds are what a later fit runs through itself at.
std::size_t unfold(HalfedgeMesh& mesh, const SurfaceLabels& labels, ClearSurface& clear);

}  // namespace scan2fea
