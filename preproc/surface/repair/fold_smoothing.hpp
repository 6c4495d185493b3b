// Small moves of vertices that free a surface of intersections without the loss of a face.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/repair/repair_result.hpp"
#include "quality/self_intersections.hpp"

#include <vector>

namespace scan2fea {

// Shells that touch others at vertices or along edges, moved away as they are by a millionth of the surface's diagonal:
// of two the one of less area, so that planes stay planes. One that crosses anything thereafter stays where it was.
// Returns whether any moved. Precondition: `pairs` are the surface's intersecting pairs; manifold.
bool part_touching_shells(SurfaceMesh& mesh, const std::vector<FacePair>& pairs, RepairResult& result);

// Vertices of intersecting faces that lie at the very same place are drawn towards the mean of their neighbours by a
// millionth of the surface's diagonal, but no more than a hundredth of the way. Returns whether there were any.
// Precondition: `pairs` are the surface's intersecting pairs; manifold.
bool part_touching_vertices(SurfaceMesh& mesh, const std::vector<FacePair>& pairs, RepairResult& result);

// Vertices of intersecting faces move half way to the mean of their neighbours until their faces are clear, no farther
// than an edge or a hundredth of the surface's diagonal, beyond which the shape would change. This undoes the folds of
// a noisy scan; then they go back towards the places that were measured, as far as nothing meets. Sheets that cross it
// does not part: where more than half of a fold's pairs remain, it is put back. Returns the pairs that remain.
// Precondition: `pairs` are the surface's intersecting pairs; manifold.
std::vector<FacePair> smooth_folds(SurfaceMesh& mesh, std::vector<FacePair> pairs, RepairResult& result);

}  // namespace scan2fea
