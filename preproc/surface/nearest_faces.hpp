// The faces of a mesh that are nearest to points.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

// Per point the nearest face of `mesh`, whatever its orientation; the mesh must have one. Points that are neighbours in
// the list should be near each other: that makes the searches fast. O((n + m) log m), parallel; the same for any number
// of threads.
std::vector<std::uint32_t> nearest_faces(const std::vector<Vec3>& points, const SurfaceMesh& mesh);

}  // namespace scan2fea
