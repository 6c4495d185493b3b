#include "preproc/surface/primitives/fit_shape.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

constexpr double tukey = 4.685;          // in sigmas: 95 % efficiency for Gaussian residuals
constexpr double median_sigma = 1.4826;  // a Gaussian's sigma over its median absolute value

using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 8, 1>;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 8, 8>;

void move(Shape& shape, const ShapeFreedom& freedom, const Vector& step) {
  Vec3 axis = shape.axis;
  for (Eigen::Index i = 0; i < step.size(); ++i) {
    const ShapeChange& change = freedom[static_cast<std::size_t>(i)];
    shape.origin += step[i] * change.shift;
    axis += step[i] * change.tilt;
    shape.radius += step[i] * change.radius;
    (shape.kind == ShapeKind::cone ? shape.half_angle : shape.tube_radius) += step[i] * change.second;
  }
  shape.axis = axis.normalized();
}

bool sensible(const Shape& shape) {
  if (!shape.origin.allFinite() || !shape.axis.allFinite()) return false;
  switch (shape.kind) {
    case ShapeKind::plane:
      return true;
    case ShapeKind::cone:
      return std::isfinite(shape.radius) && std::abs(shape.half_angle) < 1.45;
    case ShapeKind::torus:
      return shape.radius > 0 && shape.tube_radius > 0 && std::isfinite(shape.radius + shape.tube_radius);
    default:
      return shape.radius > 0 && std::isfinite(shape.radius);
  }
}

double scale_of(std::vector<double>& absolute, double least_sigma) {
  const auto middle = absolute.begin() + static_cast<std::ptrdiff_t>(absolute.size() / 2);
  std::nth_element(absolute.begin(), middle, absolute.end());
  return std::max(median_sigma * *middle, least_sigma);
}

Eigen::Index size_of(const ShapeFreedom& freedom) {
  return static_cast<Eigen::Index>(freedom.size());
}

// One step's normal equations.
struct Equations {
  Equations(const Shape& shape, const ShapeFreedom& freedom, const std::vector<Vec3>& points,
            std::span<const std::uint32_t> which, double least_sigma)
      : matrix(Matrix::Zero(size_of(freedom), size_of(freedom))), right(Vector::Zero(size_of(freedom))) {
    std::vector<ShapeDerivatives> rows;
    std::vector<double> absolute;
    rows.reserve(which.size());
    absolute.reserve(which.size());
    for (const std::uint32_t i : which) {
      rows.push_back(derivatives(shape, points[i]));
      absolute.push_back(std::abs(rows.back().distance));
    }
    const double limit = tukey * scale_of(absolute, least_sigma);
    Vector row(size_of(freedom));
    double weights = 0, squares = 0;
    for (const ShapeDerivatives& d : rows) {
      const double t = d.distance / limit;
      fit.squared_sum += std::min(d.distance * d.distance, limit * limit);
      if (std::abs(t) >= 1) continue;
      const double weight = (1 - t * t) * (1 - t * t);
      for (Eigen::Index i = 0; i < row.size(); ++i) {
        const ShapeChange& change = freedom[static_cast<std::size_t>(i)];
        row[i] =
            d.shift.dot(change.shift) + d.tilt.dot(change.tilt) + d.radius * change.radius + d.second * change.second;
      }
      for (Eigen::Index i = 0; i < row.size(); ++i) {
        const double weighed = weight * row[i];
        for (Eigen::Index j = 0; j <= i; ++j) matrix(i, j) += weighed * row[j];
        right[i] -= weighed * d.distance;
      }
      weights += weight;
      squares += weight * d.distance * d.distance;
    }
    matrix.triangularView<Eigen::StrictlyUpper>() = matrix.transpose();
    fit.rms = weights > 0 ? std::sqrt(squares / weights) : 0;
  }

  Matrix matrix;
  Vector right;
  ShapeFit fit;
};

}  // namespace

ShapeFreedom freedom_on_axis(const Shape& shape) {
  ShapeFreedom freedom;
  if (shape.kind == ShapeKind::plane || shape.kind == ShapeKind::torus || shape.kind == ShapeKind::sphere)
    freedom.push_back({.shift = shape.axis});
  if (shape.kind != ShapeKind::plane) freedom.push_back({.radius = 1});
  if (shape.kind == ShapeKind::cone || shape.kind == ShapeKind::torus) freedom.push_back({.second = 1});
  return freedom;
}

ShapeFreedom freedom_on_direction(const Shape& shape) {
  ShapeFreedom freedom = freedom_on_axis(shape);
  if (shape.kind == ShapeKind::plane) return freedom;
  const Vec3 x = shape.axis.unitOrthogonal();
  freedom.push_back({.shift = x});
  freedom.push_back({.shift = shape.axis.cross(x)});
  return freedom;
}

ShapeFreedom full_freedom(const Shape& shape) {
  ShapeFreedom freedom = freedom_on_direction(shape);
  if (shape.kind == ShapeKind::sphere) return freedom;
  const Vec3 x = shape.axis.unitOrthogonal();
  freedom.push_back({.tilt = x});
  freedom.push_back({.tilt = shape.axis.cross(x)});
  return freedom;
}

void centre_on(Shape& shape, const std::vector<Vec3>& points, std::span<const std::uint32_t> which) {
  if (shape.kind == ShapeKind::sphere || shape.kind == ShapeKind::torus || which.empty()) return;
  Vec3 middle = Vec3::Zero();
  for (const std::uint32_t i : which) middle += points[i];
  middle /= static_cast<double>(which.size());
  const double height = (middle - shape.origin).dot(shape.axis);
  if (shape.kind == ShapeKind::plane) {
    shape.origin = middle - height * shape.axis;
    return;
  }
  shape.origin += height * shape.axis;
  if (shape.kind == ShapeKind::cone) shape.radius += height * std::tan(shape.half_angle);
}

ShapeFit fit_shape(Shape& shape, const ShapeFreedom& freedom, const std::vector<Vec3>& points,
                   std::span<const std::uint32_t> which, double least_sigma, int most_steps) {
  centre_on(shape, points, which);
  Shape trial = shape;
  ShapeFreedom here = freedom;
  ShapeFit fit;
  for (int step = 0; step < most_steps; ++step) {
    // A tilted axis has other normal directions.
    for (ShapeChange& change : here) change.tilt -= change.tilt.dot(trial.axis) * trial.axis;
    Equations equations(trial, here, points, which, least_sigma);
    fit = equations.fit;
    if (here.empty()) break;
    // Where points leave a number open it stays: what is added is far below any weight that they have.
    equations.matrix.diagonal() *= 1 + 1e-9;
    equations.matrix.diagonal().array() += 1e-12 * equations.matrix.trace() + 1e-300;
    const Vector change = equations.matrix.ldlt().solve(equations.right);
    if (!change.allFinite()) return {};
    move(trial, here, change);
    if (!sensible(trial)) return {};
    const double gain = change.dot(equations.right);
    if (gain <= 1e-8 * fit.squared_sum + 1e-20 * least_sigma * least_sigma) break;
  }
  fit.found = true;
  shape = trial;
  return fit;
}

}  // namespace scan2fea
