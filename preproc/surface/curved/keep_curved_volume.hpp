// Gives a closed curved surface the volume that it should have.
#pragma once

#include "preproc/surface/curved/curved_surface.hpp"

#include <vector>

namespace scan2fea {

// Per connected component of the corners' surface its straight triangles' volume.
std::vector<double> volumes_of_components(const SurfaceMesh& surface);

// Moves the nodes of each component by one distance along their directions (unit, or zero for nodes that stay), so that
// it encloses its volume to 1e-12 of it: Newton's method on a cubic that is nearly linear. Nodes in the middle of plane
// faces stay unless that leaves less than a twentieth of the component's area to move. Where the shift would exceed a
// tenth of the mean edge, which no fit asks for, and where nothing can move, the component stays as it is: false then.
[[nodiscard]] bool keep_curved_volume(CurvedSurface& surface, const std::vector<double>& volumes,
                                      std::vector<Vec3> directions);

}  // namespace scan2fea
