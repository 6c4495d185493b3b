// Patches over holes of a manifold surface, by CGAL's Polygon Mesh Processing: Liepa, "Filling Holes in Meshes" (2003).
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/repair/soup_adjacency.hpp"

namespace scan2fea {

enum class PatchShape {
  Faired,     // refined to the density of the border and faired: as the scan would have been
  Membrane,   // refined, and faired without regard to the tangents at the border: stays near the border's hull
  Triangles,  // the border's vertices alone
};

struct Patch {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::uint32_t first_vertex = 0;  // the mesh's vertex count: indices from here on are the patch's own
};

// A patch over the hole inside `loop`. The triangulation has the least worst dihedral angle, then the least area.
// `Faired` continues the surface's tangents, but where the border is a sharp edge (a mean angle above 50 degrees
// between the faces about the hole and a plain patch) it is a membrane, so that a box lacking a side gets a plane and
// not a dome. Precondition: the mesh is manifold, and `twins` its adjacency. Where no triangulation of the border alone
// keeps the mesh manifold, or where its border of more than 150 edges has none of Delaunay triangles, the patch is a
// fan about the loop's centre, refined and faired as the others. b border edges cost about O(b^2), below 150 edges up
// to O(b^3).
Patch make_patch(const SurfaceMesh& mesh, const Twins& twins, const BorderLoop& loop, PatchShape shape);

// To the mesh that the patch was made for, or to that mesh with other patches appended.
void append_patch(SurfaceMesh& mesh, const Patch& patch);

}  // namespace scan2fea
