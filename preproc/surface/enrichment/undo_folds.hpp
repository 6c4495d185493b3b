// Moves taken back where they turned faces over or drove the surface through itself.
#pragma once

#include "preproc/surface/enrichment/surface_labels.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <cstddef>
#include <vector>

namespace scan2fea {

// `bases`: per vertex a place on the surface as it was. Vertices of faces that are turned over, against their primitive
// or against the faces around, or that cross others go half of the way back, then all of it, until there are none or
// none of these can go farther; they then lie on no primitive. Returns how many vertices went back.
// Not guaranteed: that a surface that crossed itself before is free of it.
std::size_t undo_folds(HalfedgeMesh& mesh, SurfaceLabels& labels, const std::vector<Vec3>& bases);

}  // namespace scan2fea
