// Where tetrahedra came out poor: for the surface there to be made finer.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/mesh/tet_mesh.hpp"

#include <vector>

namespace scan2fea {

struct PoorElement {
  double min_dihedral_deg;
  Vec3 centre;
  double longest_edge;
  double surface_edge;  // the surface's edge length around its nodes
};

// Elements with a dihedral angle below `least_dihedral_deg` that have nodes on the surface, whose vertices are the
// first nodes of `mesh`; in their order. About others the surface has no say. O(n).
std::vector<PoorElement> find_poor_elements(const TetMesh& mesh, const SurfaceMesh& surface, double least_dihedral_deg);

}  // namespace scan2fea
