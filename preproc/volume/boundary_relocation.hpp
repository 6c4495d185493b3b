// Where the vertices of a boundary would have to be for its worst tetrahedra to be better.
//
// Elements of a thin place, or in a wedge, are as flat as the boundary makes them, whatever their other nodes do; a
// small part of an edge there gives them more than shorter edges do.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/mesh/tet_mesh.hpp"

#include <vector>

namespace scan2fea {

// Nodes around elements with a dihedral angle below `least_dihedral_deg` go where the worst element around them is best
// (see max_min_relocation.hpp), by turns; those of the boundary, the first nodes of the mesh in its vertices' order, by
// no more than a quarter of the edges there, by no more than `most_off` along its normals, and not those that are
// `held`. Returns the boundary's vertices. All elements stay positive, so that nothing crosses from inside; from
// outside it may. O(n), and some 50 us a poor element.
std::vector<Vec3> relocate_boundary(const TetMesh& mesh, const SurfaceMesh& boundary, const std::vector<bool>& held,
                                    double most_off, double least_dihedral_deg);

}  // namespace scan2fea
