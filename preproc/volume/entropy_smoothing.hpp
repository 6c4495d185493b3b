// Moving a vertex by the entropy of its star in three dimensions.
#pragma once

#include "preproc/volume/vertex_star.hpp"

namespace scan2fea {

// One Newton step on sum of eta ln eta over the star, eta the inverse mean ratio of a tetrahedron,
//   eta = (sum of squared edges) / (12 (3 V)^(2/3)),
// 1 where it is regular and infinite where it is flat: the weighted entropy that places surface vertices (Phi), one
// dimension up. The Hessian is of closed form. The step is halved twice at most, and taken only if the star's least
// quality rises above `quality`, which it then updates with x. Returns whether x moved. Some 5 us.
bool smooth_by_entropy(const StarFaces& faces, Vec3& x, double& quality);

}  // namespace scan2fea
