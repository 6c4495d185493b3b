#include "preproc/surface/primitives/shape.hpp"

#include "preproc/mesh/names.hpp"

#include <cmath>

namespace scan2fea {
namespace {

constexpr NameTable<ShapeKind, 5> names{{
    {ShapeKind::plane, "plane"},
    {ShapeKind::cylinder, "cylinder"},
    {ShapeKind::cone, "cone"},
    {ShapeKind::sphere, "sphere"},
    {ShapeKind::torus, "torus"},
}};

// A point seen from the axis.
struct AxialPlace {
  AxialPlace(const Shape& shape, const Vec3& p) {
    const Vec3 q = p - shape.origin;
    height = q.dot(shape.axis);
    const Vec3 across = q - height * shape.axis;
    distance = across.norm();
    outwards = distance > 1e-300 ? Vec3(across / distance) : shape.axis.unitOrthogonal();
  }

  double distance, height;
  Vec3 outwards;  // unit, from the axis
};

// The distance to the shape's profile in the half-plane of (distance from the axis, height), outside of it positive,
// and how it changes.
struct Profile {
  double value, by_distance, by_height, by_radius, by_second;
};

Profile profile(const Shape& s, double distance, double height) {
  switch (s.kind) {
    case ShapeKind::plane:
      return {height, 0, 1, 0, 0};
    case ShapeKind::cylinder:
      return {distance - s.radius, 1, 0, -1, 0};
    case ShapeKind::cone: {
      const double c = std::cos(s.half_angle), t = std::sin(s.half_angle), x = distance - s.radius;
      return {x * c - height * t, c, -t, -c, -x * t - height * c};
    }
    case ShapeKind::sphere: {
      const double n = std::max(std::hypot(distance, height), 1e-300);
      return {n - s.radius, distance / n, height / n, -1, 0};
    }
    case ShapeKind::torus: {
      const double x = distance - s.radius, n = std::max(std::hypot(x, height), 1e-300);
      return {n - s.tube_radius, x / n, height / n, -x / n, -1};
    }
  }
  return {};
}

}  // namespace

std::string_view name_of(ShapeKind kind) {
  return name_in(names, kind);
}

int degrees_of_freedom(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::plane:
      return 3;
    case ShapeKind::cylinder:
      return 5;
    case ShapeKind::cone:
      return 6;
    case ShapeKind::sphere:
      return 4;
    case ShapeKind::torus:
      return 7;
  }
  return 0;
}

// Searches ask for little else than distances from planes.
double Shape::signed_distance(const Vec3& p) const {
  const Vec3 q = p - origin;
  const double height = q.dot(axis);
  const double d = kind == ShapeKind::plane ? height : profile(*this, (q - height * axis).norm(), height).value;
  return hollow ? -d : d;
}

Vec3 Shape::normal(const Vec3& p) const {
  if (kind == ShapeKind::plane) return hollow ? Vec3(-axis) : axis;
  const AxialPlace at(*this, p);
  const Profile f = profile(*this, at.distance, at.height);
  const Vec3 n = f.by_distance * at.outwards + f.by_height * axis;
  return hollow ? Vec3(-n) : n;
}

Vec3 Shape::foot(const Vec3& p) const {
  return p - signed_distance(p) * normal(p);
}

ShapeDerivatives derivatives(const Shape& shape, const Vec3& p) {
  const AxialPlace at(shape, p);
  const Profile f = profile(shape, at.distance, at.height);
  const double sign = shape.hollow ? -1 : 1;
  return {.distance = sign * f.value,
          .shift = -sign * (f.by_distance * at.outwards + f.by_height * shape.axis),
          // The axis turned by u: the point's distance from it changes by -height u, its height by distance u.
          .tilt = sign * (f.by_height * at.distance - f.by_distance * at.height) * at.outwards,
          .radius = sign * f.by_radius,
          .second = sign * f.by_second};
}

}  // namespace scan2fea
