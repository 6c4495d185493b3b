// The triangles of a surface that lie on another one.
#pragma once

#include "preproc/bodies/facing_surface.hpp"
#include "preproc/bodies/split_surface.hpp"

#include <vector>

namespace scan2fea {

// Per triangle of `surface` whether it lies on `other`, by its middle; of those listed alone. Pieces too narrow to
// tell, by the tolerance, are what is around them. `normals`: by triangle of the surface before it was cut.
std::vector<bool> contact_faces(const SplitSurface& surface, const std::vector<bool>& listed, const FacingSurface& own,
                                const FacingSurface& other, double tolerance);

}  // namespace scan2fea
