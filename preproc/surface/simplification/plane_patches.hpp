// What is plane on the scan is plane on the surface made of it.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/fit/reference_surface.hpp"

#include <cstddef>

namespace scan2fea {

// Puts the vertices within patches (see FeatureNet::patch_of_face) onto the plane of their scan, where that is one to a
// millionth of the diagonal; in three dimensions a fold of the plane looks like two good triangles that stand up. What
// then lies folded is relaxed in the plane. Vertices on lines stay. Returns how many triangles remain turned over.
std::size_t flatten_plane_patches(SurfaceMesh& mesh, const FeatureNet& net, const ReferenceSurface& scan);

}  // namespace scan2fea
