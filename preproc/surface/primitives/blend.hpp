// Roundings that are tangent to the two shapes that they join: one radius, and nothing else, is unknown of them.
#pragma once

#include "preproc/surface/primitives/fit_shape.hpp"
#include "preproc/surface/primitives/shape.hpp"

#include <optional>

namespace scan2fea {

// All shapes that a ball touching both sides sweeps: a cylinder between two planes, a torus between a plane and a
// cylinder or cone's end on the same axis. The ball's centre moves linearly with its radius.
class Blend {
 public:
  // `inner`: of an inner edge, which it fills (a fillet); else of an outer one, which it takes off. Nothing where the
  // sides are parallel, or of other kinds or places.
  static std::optional<Blend> between(const Shape& one, const Shape& other, bool inner, const Vec3& near);

  Shape with_radius(double radius) const;
  // How the shape changes with its radius.
  ShapeFreedom freedom() const;
  // The radius with which it passes through a point, if any.
  std::optional<double> radius_through(const Vec3& p) const;

 private:
  Shape limit_;         // of radius zero, on the sharp edge
  ShapeChange change_;  // per radius
};

// Of cylinders the radius, of tori that of the tube.
double blend_radius(const Shape& shape);

}  // namespace scan2fea
