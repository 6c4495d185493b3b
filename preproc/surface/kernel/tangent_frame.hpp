// Directions in tangent planes as complex numbers, and their transport from plane to plane.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cmath>
#include <complex>
#include <numbers>

namespace scan2fea {

using Complex = std::complex<double>;

// In these loops std::abs costs too much: it guards against overflow.
inline double length(const Complex& z) {
  return std::sqrt(std::norm(z));
}

inline Complex sixth_power(const Complex& z) {
  const Complex square = z * z;
  return square * square * square;
}

// z / |z|; 1 where there is no direction.
inline Complex unit(const Complex& z) {
  const double l = length(z);
  return l > 1e-150 ? z * (1 / l) : Complex(1, 0);
}

// A right-handed frame (x, y, normal), a function of the normal alone, so that it need not be stored: Duff et al.,
// "Building an Orthonormal Basis, Revisited" (JCGT 2017).
struct TangentFrame {
  explicit TangentFrame(const Vec3& n) {
    const double sign = std::copysign(1.0, n[2]);
    const double a = -1 / (sign + n[2]);
    const double b = n[0] * n[1] * a;
    x = {1 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]};
    y = {b, sign + n[1] * n[1] * a, -n[1]};
  }

  Vec3 x;
  Vec3 y;

  Complex coordinates(const Vec3& v) const { return {v.dot(x), v.dot(y)}; }
  Vec3 vector(const Complex& c) const { return c.real() * x + c.imag() * y; }
};

// The complex number that turns coordinates in `from` to those in `to` by the smallest rotation that takes the one
// normal to the other, times 1 + the cosine of the angle between the normals. With (x, y) and (x', y') the two frames
// it is x.x' + y.y' + i (y.x' - x.y').
inline Complex scaled_transport(const TangentFrame& from, const TangentFrame& to) {
  return {to.x.dot(from.x) + to.y.dot(from.y), to.y.dot(from.x) - to.x.dot(from.y)};
}

// The turn alone, a unit number. Where normals are opposed it is arbitrary.
inline Complex transport(const TangentFrame& from, const TangentFrame& to) {
  return unit(scaled_transport(from, to));
}

// A direction as a multiple of 60° and a remainder of at most 30°.
struct SixthTurn {
  int turns;          // 0 to 5
  Complex remainder;  // unit
};

// Sector tests instead of an arctangent: the limits are odd multiples of 30°. Precondition: unit.
inline SixthTurn sixth_turn(const Complex& direction) {
  constexpr double half = 0.5, height = std::numbers::sqrt3 / 2;  // cosine and sine of 60°
  static constexpr double cosines[6] = {1, half, -half, -1, -half, half};
  static constexpr double sines[6] = {0, height, height, 0, -height, -height};
  const double c = direction.real(), s = direction.imag();
  const int upper = c > 0 ? 1 : 2, lower = c > 0 ? 5 : 4, level = c > 0 ? 0 : 3;
  const int turns = std::abs(c) >= height ? level : s > 0 ? upper : lower;
  return {turns, direction * Complex(cosines[turns], -sines[turns])};
}

// The angle of a remainder, in radians, to 1e-4: the first terms of the arcsine.
inline double small_angle(const Complex& remainder) {
  const double x = remainder.imag(), xx = x * x;
  return x * (1 + xx * (1.0 / 6 + xx * (3.0 / 40 + xx * (5.0 / 112 + xx * (35.0 / 1152)))));
}

}  // namespace scan2fea
