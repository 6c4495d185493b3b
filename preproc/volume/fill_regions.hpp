// From a tetrahedral mesh of everything within a surface's outermost shells to that of the bodies it bounds.
#pragma once

#include "preproc/mesh/tet_mesh.hpp"

namespace scan2fea {

// `tetrahedra` may be of either orientation; their faces contain every surface triangle. The triangles cut them into
// regions. A region is filled where it lies behind its triangles, and empty where it lies in front of them, so that
// cavities stay empty and several bodies, one in another's cavity too, are all filled.
// The result has positive tetrahedra, `boundary[i]` is `triangles[i]`, and of the nodes from `surface_nodes` on only
// those that are used.
// Throws MeshingFailed, with the place: a triangle that is not a face of the mesh; a region that lies behind some of
// its triangles and in front of others (a body within a body, not a cavity); a surface inside out. O(n).
TetMesh fill_regions(std::vector<Vec3> nodes, std::vector<Tetrahedron> tetrahedra,
                     const std::vector<Triangle>& triangles, std::size_t surface_nodes);

}  // namespace scan2fea
