// How noisy a scan is.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/adjacency.hpp"

namespace scan2fea {

// Estimated standard deviation of the vertices along normals, model units: the median residual from quadrics fitted to
// vertices' two rings, on a sample of about a thousand vertices, those near creases aside. Where curvature radii are a
// few edges, shape is taken for noise; 0 where nothing can be fitted.
double estimate_noise(const SurfaceMesh& scan, const VertexStars& stars);

}  // namespace scan2fea
