// Patches over holes of a manifold surface, by CGAL's Polygon Mesh Processing: Liepa, "Filling Holes in Meshes" (2003).
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/soup_adjacency.hpp"

namespace scan2fea {

enum class PatchShape {
  Faired,     // refined to the density of the border and faired: as the scan would have been
  Membrane,   // refined, and faired without regard to the tangents at the border: stays near the border's hull
  Triangles,  // the border's vertices alone
};

// Appends to the mesh the faces, and vertices, of a patch over the hole inside `loop`. The triangulation has the least
// worst dihedral angle, then the least area. `Faired` continues the surface's tangents, but where the border is a sharp
// edge (a mean angle above 50 degrees between the faces about the hole and a plain patch) it is a membrane, so that a
// box lacking a side gets a plane and not a dome.
// Preconditions: `twins` is the adjacency of the mesh before any hole was filled; the mesh was manifold.
// Where no triangulation of the border alone keeps the mesh manifold, the patch is a fan about the loop's centre.
// b border edges cost about O(b^2); a border that is not nearly planar and has no Delaunay triangulation O(b^3).
void fill_hole(SurfaceMesh& mesh, const Twins& twins, const BorderLoop& loop, PatchShape shape);

}  // namespace scan2fea
