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

// The same where nearly all of it is independent from one vertex to the next, as a scanner's noise is, and waves, grain
// and facets are not; else 0. Of independent noise the residuals of two neighbours have a known covariance, since each
// has a part in the other's quadric: a negative one, where whatever is wider than an edge makes it positive. By that
// covariance, within about 20 %. Noise that folds faces is not told.
double estimate_independent_noise(const SurfaceMesh& scan, const VertexStars& stars);

}  // namespace scan2fea
