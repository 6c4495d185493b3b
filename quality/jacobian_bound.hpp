// Is a curved (10-node) tetrahedron valid, that is, is the Jacobian of its map positive everywhere?
//
// The Jacobian determinant of a quadratic tetrahedron is a cubic polynomial. Its 20 coefficients in the Bernstein basis
// bound it from both sides, and the four at the corners are its values there; halving the longest way along an edge (de
// Casteljau) tightens the bounds quadratically (Johnen, Remacle, Geuzaine, "Geometrical validity of curvilinear finite
// elements", 2013).
#pragma once

#include "preproc/mesh/tet_mesh.hpp"

namespace scan2fea {

struct JacobianBound {
  double lower;  // the Jacobian is nowhere less
  double upper;  // and somewhere at most this
};

enum class JacobianWanted { sign, value };

// Bounds on the smallest Jacobian over the element, in model units cubed (six times the volume where the edges are
// straight). Refined until the bounds differ by less than `tolerance` of the largest coefficient or, where that is all
// that is wanted, the sign is certain: lower > 0 proves the element valid, upper <= 0 that it is not. About 1 us where
// no refinement is needed, the rule.
JacobianBound min_jacobian_bound(const CurvedTetrahedron& nodes, double tolerance = 1e-3,
                                 JacobianWanted wanted = JacobianWanted::sign);

}  // namespace scan2fea
