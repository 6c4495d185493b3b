// Reading a lattice off where its cells do not make a manifold: edge by edge, as far as topology allows.
#pragma once

#include "preproc/surface/lattice/lattice_clusters.hpp"

namespace scan2fea {

// Contracts edges of the scan inside the clusters while there are any that may be. Topology and features stay, always:
// vertices of a feature are contracted along it only, samples not at all; the net then has the vertices that are left
// on it. `scan` is the cut one. Nearly linear.
ExtractedLattice contract_clusters(const SurfaceMesh& scan, const Anchors& anchors, LatticeClusters& clusters);

}  // namespace scan2fea
