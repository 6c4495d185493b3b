// Lifting: the height of a surface over a point of a tangent plane, from measured points near it.
// Source: [1], section 2 (Shepard interpolation with Wendland's compactly supported radial basis function as its
// weight; README.md lists the sources), and three ways that make fewer bumps: Renka's modified quadratic Shepard method
// (ACM TOMS 14, 1988), and moving least squares with a quadric, on heights alone or on heights and normals (Hermite).
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <span>
#include <string_view>

namespace scan2fea {

enum class Lifting {
  triharmonic,                 // the smoothest surface through all points at once: see enrichment/triharmonic_lift.hpp
  shepard,                     // that of [1]: the weighted mean of the heights; pulls towards flat steps
  modified_quadratic_shepard,  // the weighted mean of quadrics through the samples
  moving_least_squares,        // one quadric, fitted with weights that interpolate
  hermite,                     // the same, fitted to the samples' normals as well
};

// "triharmonic", "mls", "quadratic-shepard", "hermite", "shepard".
std::string_view name_of(Lifting lifting);

// A measured point and the surface's unit normal there.
struct SurfaceSample {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::Zero();
};

// Wendland's function of smoothness C2, (1 - r)^4 (4 r + 1) for r < 1, 0 beyond: r is the distance over the radius.
double wendland(double r);

// The height over `base` along `normal` (unit), in model units. Samples count within `radius` of the base, measured in
// the plane. All but `shepard` leave out samples whose normal turns more than 75 degrees from `normal`: the surface is
// not a height over this plane there. 0 where no sample counts.
// They interpolate: at a sample's foot the height is the sample's (`shepard` alone does not, its weight being finite).
// Where the samples do not settle a quadric (too few, or in line), the curvature that they leave open is taken as 0.
// O(n) for n samples, O(n^2) for modified_quadratic_shepard. 0 for `triharmonic`,
// which no single point tells. Not guaranteed: a bound on the height. Callers that
// extrapolate limit it.
double lifted_height(Lifting lifting, std::span<const SurfaceSample> samples, const Vec3& base, const Vec3& normal,
                     double radius);

}  // namespace scan2fea
