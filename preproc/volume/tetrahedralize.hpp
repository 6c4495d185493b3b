// Fills a closed surface with tetrahedra.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/tet_mesh.hpp"
#include "preproc/volume/run_tetgen.hpp"

#include <optional>
#include <vector>

namespace scan2fea {

struct TetrahedralizeOptions {
  // Largest volume of a tetrahedron, model units cubed, above 0. None: as large as the surface's triangles suggest.
  std::optional<double> max_volume;
  // TetGen's radius-edge ratio, 1.1 to 2: how fast tetrahedra grow away from small triangles. Below 1.2 TetGen may not
  // terminate; above 2 the shape suffers.
  double grading = 1.2;
  // TetGen may put nodes on the surface where that helps. Off: the triangles are those of the validated surface.
  bool split_boundary = false;
  TetgenLimits limits;
};

struct TetrahedralizeResult {
  TetMesh mesh;
  // Where the boundary was allowed to be split: the surface triangle that each boundary face lies on. Else empty:
  // boundary face i is triangle i.
  std::vector<std::uint32_t> boundary_parent;
};

// Source: Si, "TetGen, a Delaunay-based quality tetrahedral mesh generator", ACM TOMS 41 (2015).
// The surface is closed, manifold, free of self-intersections and faces outwards; shells within shells that face
// inwards are cavities and stay empty; disjoint bodies are all filled. Its triangles become `mesh.boundary` in their
// order (unless split), its vertices the first nodes.
// Throws MeshingFailed (see TetgenLimits and fill_regions), Cancelled. About 20 s for a million tetrahedra.
// Not guaranteed: any shape of the tetrahedra but that they are positive.
TetrahedralizeResult tetrahedralize(const SurfaceMesh& surface, const TetrahedralizeOptions& options = {},
                                    const Progress& progress = {});

}  // namespace scan2fea
