// How good a tetrahedron is, as the optimisation sees it.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <array>

namespace scan2fea {

// One number for three goals: the least of
//   sin(smallest dihedral angle) / sin 22 deg,
//   (1 + cos(largest dihedral angle)) / (1 + cos 138 deg),
//   scaled Jacobian (6V sqrt 2 over the largest product of three edges at a corner) / 0.28,
// so that 1 is good enough for a solver in all three and 2.3 is the body-centred cubic lattice's tetrahedron. Scale
// invariant for edges between 1e-15 and 1e15; not positive where (b - a) x (c - a) . (d - a) is not.
// Exact only above `floor`; below, some value that is not above it: most tetrahedra that the optimisation looks at are
// worse than what they would replace, and are found out early. Some 25 ns.
double goal_quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double floor = 0);

// What it is the least of: one term for each dihedral angle, and one for the three edges at each corner, times
// `jacobian_counts`. Smooth in the corners but where an angle passes 90 degrees, or 108. One is not positive where the
// tetrahedron is not. Some 60 ns.
using GoalTerms = std::array<double, 10>;
GoalTerms goal_terms(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double jacobian_counts);

}  // namespace scan2fea
