// The surfaces that machines make: planes, cylinders, cones, spheres, tori; each a surface of revolution, so that one
// description serves all: a distance is a function of the distance from the axis and of the height along it.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace scan2fea {

enum class ShapeKind { plane, cylinder, cone, sphere, torus };

// "plane", "cylinder", "cone", "sphere", "torus".
std::string_view name_of(ShapeKind kind);

// Unbounded. Lengths in model units.
struct Shape {
  ShapeKind kind = ShapeKind::plane;
  Vec3 origin = Vec3::Zero();  // on the plane; on the axis; the centre of a sphere or torus
  Vec3 axis = Vec3::UnitZ();   // unit: the plane's normal, out of the material; else the axis (any for a sphere)
  double radius = 0;           // of cylinder or sphere; of the cone at the origin; of the torus's centre circle
  double tube_radius = 0;      // of the torus
  double half_angle = 0;       // of the cone, radians: it widens along the axis where this is positive
  bool hollow = false;         // the material is outside: a hole, the rounding of an inner edge

  // Along the outward normal: positive outside the material.
  double signed_distance(const Vec3& p) const;
  // Unit, out of the material, at the foot of p.
  Vec3 normal(const Vec3& p) const;
  // The nearest point of the shape (of a cone's nearer generator, beyond its apex as well).
  Vec3 foot(const Vec3& p) const;
};

// Numbers that describe the shape where nothing is known of it: 3 for a plane, 5, 6, 4, 7.
int degrees_of_freedom(ShapeKind kind);

// What a shape has from others, as places in a list of shapes.
struct ShapeRelations {
  std::optional<std::array<std::uint32_t, 2>> tangent_to;  // it then follows from these and its radius
  std::optional<std::uint32_t> parallel_to;
  std::optional<std::uint32_t> coaxial_to;
  std::optional<std::uint32_t> same_radius_as;
};

// How the distance of a point changes with the shape, for fits.
struct ShapeDerivatives {
  double distance = 0;
  Vec3 shift = Vec3::Zero();  // by moves of the origin
  Vec3 tilt = Vec3::Zero();   // by changes of the axis; normal to the axis
  double radius = 0;
  double second = 0;  // by tube_radius or half_angle
};
ShapeDerivatives derivatives(const Shape& shape, const Vec3& p);

}  // namespace scan2fea
