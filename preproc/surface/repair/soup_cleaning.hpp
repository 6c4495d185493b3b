// Steps of the repair that need no adjacency beyond counting the faces of an edge: what a file's triangle soup holds
// that no surface does. Each leaves a mesh without such things bit for bit as it was, and logs what it changed.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/repair/repair_result.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

// Throws InvalidInput: no faces, an index out of range, a coordinate that is not finite.
void check_input(const SurfaceMesh& mesh);

// Faces that name a vertex twice.
void drop_collapsed_faces(SurfaceMesh& mesh, RepairResult& result);

// Faces on the same three vertices. Of an odd number of them one stays. Of an even number one stays where its
// neighbours need it (the patch of such faces borders mostly on edges of one other face, or on nothing), and none where
// the patch is a double wall between closed parts. O(n).
void drop_duplicate_faces(SurfaceMesh& mesh, RepairResult& result);

// Joins border edges whose end points coincide exactly, as in files that store each part or each face by itself.
// O(b log b) for b border edges.
void weld_borders(SurfaceMesh& mesh, RepairResult& result);

// Sheets, bounded by borders and non-manifold edges, without which each of their edges would have an even number of
// faces or none: walls that divide a part's inside, and flaps. Smallest area first.
void drop_inner_walls(SurfaceMesh& mesh, RepairResult& result);

// The steps above in their order, with borders that all but meet stitched (border_stitching.hpp).
void clean_soup(SurfaceMesh& mesh, RepairResult& result);

}  // namespace scan2fea
