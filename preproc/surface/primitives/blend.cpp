#include "preproc/surface/primitives/blend.hpp"

#include <Eigen/LU>

#include <cmath>

namespace scan2fea {
namespace {

// Sides within 15 degrees of one another, or of opposite, meet nowhere near.
constexpr double least_sine = 0.26;

std::optional<Vec3> solve(const Vec3& row1, const Vec3& row2, const Vec3& row3, const Vec3& right) {
  Eigen::Matrix3d matrix;
  matrix << row1.transpose(), row2.transpose(), row3.transpose();
  const Vec3 x = matrix.inverse() * right;
  if (!x.allFinite()) return std::nullopt;
  return x;
}

}  // namespace

double blend_radius(const Shape& shape) {
  return shape.kind == ShapeKind::torus ? shape.tube_radius : shape.radius;
}

std::optional<Blend> Blend::between(const Shape& one, const Shape& other, bool inner, const Vec3& near) {
  const double side = inner ? 1 : -1;  // along the outward normals
  if (one.kind != ShapeKind::plane) {
    if (other.kind != ShapeKind::plane) return std::nullopt;
    return between(other, one, inner, near);
  }
  Blend blend;
  blend.limit_.hollow = inner;
  if (other.kind == ShapeKind::plane) {
    const Vec3 across = one.axis.cross(other.axis);
    if (!(across.norm() > least_sine)) return std::nullopt;
    const Vec3 axis = across.normalized();
    const auto edge =
        solve(one.axis, other.axis, axis, {one.axis.dot(one.origin), other.axis.dot(other.origin), axis.dot(near)});
    const auto shift = solve(one.axis, other.axis, axis, {side, side, 0});
    if (!edge || !shift) return std::nullopt;
    blend.limit_.kind = ShapeKind::cylinder;
    blend.limit_.origin = *edge;
    blend.limit_.axis = axis;
    blend.change_ = {.shift = *shift, .radius = 1};
    return blend;
  }
  const double cosine = one.axis.dot(other.axis);
  if (other.kind != ShapeKind::cylinder || std::abs(cosine) < 0.9976) return std::nullopt;  // 4 degrees
  blend.limit_.kind = ShapeKind::torus;
  blend.limit_.axis = other.axis;
  blend.limit_.origin = other.origin + one.axis.dot(one.origin - other.origin) / cosine * other.axis;
  blend.limit_.radius = other.radius;
  blend.change_ = {
      .shift = std::copysign(1.0, cosine) * side * other.axis, .radius = other.hollow ? -side : side, .second = 1};
  return blend;
}

Shape Blend::with_radius(double radius) const {
  Shape shape = limit_;
  shape.origin += radius * change_.shift;
  shape.radius += radius * change_.radius;
  shape.tube_radius += radius * change_.second;
  return shape;
}

ShapeFreedom Blend::freedom() const {
  return {change_};
}

std::optional<double> Blend::radius_through(const Vec3& p) const {
  // In the plane across the ball's way, of (x, y): |place - radius * way| = radius.
  const Vec3 q = p - limit_.origin;
  const double height = q.dot(limit_.axis);
  const Vec3 across = q - height * limit_.axis;
  double place_place, place_way, way_way;
  if (limit_.kind == ShapeKind::cylinder) {
    place_place = across.squaredNorm();
    place_way = across.dot(change_.shift);
    way_way = change_.shift.squaredNorm();
  } else {
    const double x = across.norm() - limit_.radius, rise = change_.shift.dot(limit_.axis);
    place_place = x * x + height * height;
    place_way = x * change_.radius + height * rise;
    way_way = change_.radius * change_.radius + rise * rise;
  }
  // The larger root is that of the far side of the ball.
  const double a = way_way - 1, root = place_way * place_way - a * place_place;
  if (!(a > 1e-6) || !(root >= 0)) return std::nullopt;
  const double radius = (place_way + std::sqrt(root)) / a;
  if (!(radius > 0)) return std::nullopt;
  return radius;
}

}  // namespace scan2fea
