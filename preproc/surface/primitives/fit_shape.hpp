// Shapes fitted to points by least squares that outliers do not pull.
#pragma once

#include "preproc/surface/primitives/shape.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

// One way in which a shape may change, per unit of an unknown of the fit.
struct ShapeChange {
  Vec3 shift = Vec3::Zero();  // of the origin
  Vec3 tilt = Vec3::Zero();   // of the axis; normal to it
  double radius = 0;
  double second = 0;  // of the tube's radius, the half angle
};

// What a fit may change: independent of one another.
using ShapeFreedom = std::vector<ShapeChange>;

// All that the kind has.
ShapeFreedom full_freedom(const Shape& shape);
// The same but for the axis's direction.
ShapeFreedom freedom_on_direction(const Shape& shape);
// The same but for the axis, along which alone the shape may slide.
ShapeFreedom freedom_on_axis(const Shape& shape);

struct ShapeFit {
  bool found = false;      // it came to an end with finite numbers and positive radii
  double rms = 0;          // of the points that were not outvoted, model units
  double squared_sum = 0;  // of all residuals, each capped where Tukey's weight ends
};

// Gauss-Newton with Tukey's biweight, whose scale is the median residual's, but at least `least_sigma` (model units,
// > 0). The origin slides along the axis to the points' middle. O(points) a step.
ShapeFit fit_shape(Shape& shape, const ShapeFreedom& freedom, const std::vector<Vec3>& points,
                   std::span<const std::uint32_t> which, double least_sigma, int most_steps = 12);

// Slides the origin of plane, cylinder or cone to the middle of the points, which changes the description alone.
void centre_on(Shape& shape, const std::vector<Vec3>& points, std::span<const std::uint32_t> which);

}  // namespace scan2fea
