// The best that any tetrahedra can be on a given surface.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstdint>

namespace scan2fea {

// Upper bounds on the smallest dihedral angle and the smallest scaled Jacobian of tetrahedra whose boundary is the
// surface, triangle by triangle, and where they come from. Necessary, not sufficient: two bad edges side by side can
// ask for more than either.
struct SurfaceBound {
  double min_dihedral_deg = 70.53;    // the regular tetrahedron's
  Vec3 sharpest_edge = Vec3::Zero();  // its middle
  std::uint32_t sharpest_edge_triangle = 0;
  double scaled_jacobian = 1;
  Vec3 worst_triangle_centre = Vec3::Zero();
  std::uint32_t worst_triangle = 0;
};

// At a convex edge of interior dihedral angle theta either several elements share the angle, so that one has theta / 2
// at most, or one element fills it, and then its four corners are those of the two triangles: the better of both bounds
// the angle. At a corner of angle alpha, 6V is at most sin(alpha) times the product of the three edges there, so
// sqrt(2) sin(alpha) bounds the scaled Jacobian. The surface is closed and manifold. O(n log n).
SurfaceBound surface_bound(const SurfaceMesh& surface);

}  // namespace scan2fea
