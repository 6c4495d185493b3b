// How noisy a scan is.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

namespace scan2fea {

// Estimated standard deviation of the vertices along normals, model units, within about 20 %: the median residual from
// quadrics through vertices' two rings, on a sample of some hundred, those near creases aside. Where creases, facets of
// more than 30° or noise of a fifth of an edge are everywhere it is a guess from the flattest pairs of faces. 0 where
// there is nothing to go by.
double estimate_noise(const SurfaceMesh& scan, const MeshAdjacency& adjacency);

}  // namespace scan2fea
