// The ways of a surface's vertices along the scan that it stands for.
#pragma once

#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/features/planes_of_scan.hpp"
#include "preproc/surface/fit/reference_surface.hpp"
#include "preproc/volume/boundary_ways.hpp"

namespace scan2fea {

// Each vertex stays as far from the scan as it is: within its patch, on its line of the net where it is on one, and in
// its planes. Ends of lines, and vertices of several, stay. None goes farther than `most` from where it is, so that no
// point of the surface is farther than that from the surface given, nor the other way round. The meshes and the net
// must outlive the ways.
BoundaryWays ways_on_scan(const SurfaceMesh& surface, const FeatureNet& net, const ReferenceSurface& scan,
                          const PlanesOfScan& planes, double most);

}  // namespace scan2fea
