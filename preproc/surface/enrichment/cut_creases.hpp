// Creases and corners that a scan's points lie beside, put back where the primitives meet.
// A scanner rarely hits an edge of the part; a triangulation cuts it off, by triangles whose corners lie on different
// primitives. Each edge of theirs is split where the two primitives meet, so that afterwards every face lies on one.
#pragma once

#include "preproc/surface/enrichment/clear_surface.hpp"
#include "preproc/surface/enrichment/surface_labels.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <cstddef>
#include <vector>

namespace scan2fea {

struct CreaseCutResult {
  std::size_t snapped = 0;  // vertices moved onto their primitive
  std::vector<Vec3> bases;  // of each vertex that was added, on a crease or corner: the place on its edge
  std::size_t turned = 0;   // edges
  std::size_t moved = 0;    // vertices that were all but there, and now lie on two or three primitives
};

// First each vertex goes onto its primitive. No move, split or turn of an edge turns a face over or drives it through
// others: what would is left out, as are
// creases that the primitives do not reach near an edge (another face lies between, or they are tangent). New vertices
// follow the old ones. `labels` are those of `mesh`, and stay so.
CreaseCutResult cut_creases(HalfedgeMesh& mesh, SurfaceLabels& labels, ClearSurface& clear);

}  // namespace scan2fea
