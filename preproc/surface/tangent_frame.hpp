// Directions in tangent planes as complex numbers, and their transport from plane to plane.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cmath>
#include <complex>

namespace scan2fea {

using Complex = std::complex<double>;

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

// The unit complex number that turns coordinates in `from` to those in `to`, by the smallest rotation that takes the
// one normal to the other. With (x, y) and (x', y') the two frames, its real part is proportional to x.x' + y.y' and
// its imaginary part to y.x' - x.y'. Where normals are opposed it is arbitrary.
inline Complex transport(const TangentFrame& from, const TangentFrame& to) {
  const Complex t(to.x.dot(from.x) + to.y.dot(from.y), to.y.dot(from.x) - to.x.dot(from.y));
  const double length = std::abs(t);
  return length > 1e-12 ? t / length : Complex(1, 0);
}

}  // namespace scan2fea
