// Primitives: the planes, cylinders, cones, spheres and tori that a scan's points lie on.
// On a machined part everything else follows from them: where a point that the scanner missed lies, where two faces
// meet, what is a hole and how wide it is.
// The noise is estimated and normals are, each of its own side (point_normals.hpp); shapes are grown on them, greedily,
// the best first (grow_shapes.hpp), fitted by Gauss-Newton with Tukey's weight, and kept where residuals look like
// noise and the description gets shorter; relations that a designer would have drawn (parallel, perpendicular, coaxial,
// equal radii, roundings tangent to what they join) are imposed where the points agree within the noise
// (shape_relations.hpp).
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/surface/primitives/neighbours.hpp"
#include "preproc/surface/primitives/shape.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace scan2fea {

// What an engineer calls it.
enum class PrimitiveUse {
  face,      // a plane, a cone, or part of another shape that is none of the below
  hole,      // an inner cylinder over half of its circumference; a third, where it is tangent to nothing
  boss,      // an outer one
  fillet,    // the rounding of an inner edge or corner: a hollow piece of cylinder, sphere or torus
  rounding,  // the same of an outer edge
};
std::string_view name_of(PrimitiveUse use);

struct Primitive {
  Shape shape;
  PrimitiveUse use = PrimitiveUse::face;
  std::size_t points = 0;      // that carry its label
  double fit = 0;              // RMS distance of these, model units
  double extent = 0;           // of its points along the axis (of a plane: across), model units
  double turn_deg = 0;         // that its points cover about the axis; 360 all around; 0 for planes and spheres
  int degrees_of_freedom = 0;  // numbers that the points alone decide, relations aside
  ShapeRelations relations;    // that were imposed, to others in the list
};

// "hole, radius 5.99, 18 points, fit 0.004".
std::string describe(const Primitive& primitive);

enum class ScanKind {
  part,     // few shapes describe most points
  organic,  // free-form: shapes are patches that happen to fit
};

struct PrimitiveOptions {
  // Least number of points that each degree of freedom of the shapes explains on a part. Parts have 25 to 60, organic
  // scans 8 to 12, dense or not.
  double points_per_freedom = 20;
};

inline constexpr std::uint32_t no_primitive = ~std::uint32_t{0};

struct Primitives {
  ScanKind kind = ScanKind::organic;
  double points_per_freedom = 0;
  std::vector<Primitive> list;        // empty for an organic scan
  std::vector<std::uint32_t> labels;  // per point its primitive, or no_primitive
  std::vector<Vec3> normals;          // per point, of its own side: unit, or zero where a point has no neighbours
  double noise = 0;                   // standard deviation of the points along normals, model units
  double sigma = 0;                   // of distances from shapes: the noise, or what facets and rounding leave
  double spacing = 0;                 // median distance of the sixth neighbour, model units
};

// `outwards`: per point a direction, of any length, that tells the two sides of the surface apart. `neighbours`: 16 to
// 24 a point. Deterministic, one thread; 0.1 to 0.5 s for 4,100 points. Throws Cancelled.
// Not guaranteed: every shape (a hole with fewer than seven points on its wall is not found); that shapes are those of
// the drawing where two describe the points equally well (a cone of 1 degree, a cylinder); the exact extent.
Primitives find_primitives(const std::vector<Vec3>& points, const Neighbours& neighbours,
                           const std::vector<Vec3>& outwards, const PrimitiveOptions& options = {},
                           const Progress& progress = {});

// Of a surface's vertices: neighbours along it, sides by its triangles.
Primitives find_primitives(const SurfaceMesh& mesh, const PrimitiveOptions& options = {},
                           const Progress& progress = {});

}  // namespace scan2fea
