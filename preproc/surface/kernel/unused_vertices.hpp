// Vertices that no face names.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <vector>

namespace scan2fea {

// The others keep their order. Returns those dropped. O(n).
std::vector<Vec3> drop_unused_vertices(SurfaceMesh& mesh);

}  // namespace scan2fea
