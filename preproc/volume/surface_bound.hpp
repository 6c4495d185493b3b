// The best that any tetrahedra can be on a given surface.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstdint>
#include <optional>

namespace scan2fea {

// Upper bounds on the smallest dihedral angle and the smallest scaled Jacobian of tetrahedra whose boundary is the
// surface, triangle by triangle, and where they come from. Necessary, not sufficient: bad edges side by side can ask
// for more than each does alone.
struct SurfaceBound {
  double min_dihedral_deg = 70.528779365509308;  // the regular tetrahedron's
  std::optional<Vec3> min_dihedral_at;           // the middle of an edge; unset: nowhere below the regular one
  double scaled_jacobian = 1;
  std::optional<Vec3> scaled_jacobian_at;
};

// At a convex edge of interior dihedral angle theta either several elements share the angle, so that one of them has
// theta / 2 at most, or one element fills it, and then its corners are those of the two triangles, and what it leaves
// of the angles at their other edges is for others: the better of both bounds the angle. The scaled Jacobian of an
// element with the dihedral angle phi at an edge is at most sqrt(2) sin(phi) h / m, with h the height of a triangle
// there over the edge and m the longer of its other two sides; and at a triangle's corner of angle alpha at most
// sqrt(2) sin(alpha). Behind a point of a triangle, d from the nearest of its sides, an element of the angle phi at
// each side reaches at least d tan(phi) deep, and no element reaches through the body: where the wall behind the point
// is t thick, no angle is above atan(t / d). Looked at behind the triangle's incentre and half way from there to its
// corners. The surface is closed and manifold. O(n log n).
SurfaceBound surface_bound(const SurfaceMesh& surface);

}  // namespace scan2fea
