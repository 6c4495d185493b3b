// The plane that a scan is the mirror image of itself in.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"

#include <optional>

namespace scan2fea {

struct MirrorPlane {
  Vec3 normal = Vec3::UnitX();  // unit; its largest component is positive
  double offset = 0;            // normal . p = offset on the plane
  // Of the scan's vertices and the middles of its triangles, once reflected, from the scan; model units.
  double rms_distance = 0, largest_distance = 0;
  Vec3 farthest = Vec3::Zero();  // where the largest is
};

// What the distances of a mirror image may be: twice the noise, and what facets of two sides may be apart, of which a
// twentieth of a per cent of the diagonal is a quarter of the deviation that a mesh has by default. The largest may be
// as much as that deviation and six times the noise: beyond it something is on one side alone.
struct MirrorLimits {
  double rms = 0, largest = 0;
};
MirrorLimits mirror_limits(const SurfaceMesh& scan);

// The best mirror plane, whether or not it keeps the limits. `axis`: only planes whose normal is within 5 degrees of
// this coordinate axis (0, 1, 2) are tried; else normals along the principal axes of the surface's second moments and,
// where two of these are equal, all around the third. A mirror plane goes through the centre of area; its place and
// normal are then fitted to the distances by Gauss-Newton steps on the nearest triangles' planes. A normal that is a
// coordinate axis within what the fit can tell is that axis exactly, so that coordinates mirror without rounding.
// Preconditions: closed. The same for any number of threads. Cost: 20 ms a direction that is tried, up to 180, and 2
// microseconds a vertex. Not guaranteed: of a ball, more than the planes across the coordinate axes.
MirrorPlane find_mirror_plane(const SurfaceMesh& scan, std::optional<int> axis = {}, const Progress& progress = {});

}  // namespace scan2fea
