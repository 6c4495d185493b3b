#include "preproc/surface/primitives/shape_guess.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <array>
#include <cmath>
#include <optional>

namespace scan2fea {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;

Vec3 least_direction(const Matrix3d& products) {
  Eigen::SelfAdjointEigenSolver<Matrix3d> solver;
  solver.computeDirect(products);
  return solver.eigenvectors().col(0);
}

class Patch {
 public:
  Patch(const OrientedPoints& cloud, std::span<const std::uint32_t> which) {
    for (const std::uint32_t i : which) {
      points_.push_back(cloud.points[i]);
      normals_.push_back(cloud.normals[i]);
      middle_ += cloud.points[i];
      mean_normal_ += cloud.normals[i];
    }
    middle_ /= static_cast<double>(points_.size());
    mean_normal_ /= static_cast<double>(points_.size());
  }

  Shape plane() const {
    Shape shape;
    shape.origin = middle_;
    Matrix3d products = Matrix3d::Zero();
    for (const Vec3& p : points_) products += (p - middle_) * (p - middle_).transpose();
    shape.axis = least_direction(products);
    if (shape.axis.dot(mean_normal_) < 0) shape.axis = -shape.axis;
    return shape;
  }

  // The radius r and centre c for which c + r n is nearest to the points.
  std::optional<Shape> sphere() const {
    double up = 0, down = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vec3 n = normals_[i] - mean_normal_;
      up += (points_[i] - middle_).dot(n);
      down += n.squaredNorm();
    }
    if (!(down > least_spread())) return std::nullopt;
    Shape shape{.kind = ShapeKind::sphere, .radius = std::abs(up / down), .hollow = up < 0};
    shape.origin = middle_ - up / down * mean_normal_;
    return shape;
  }

  // Directions in which an axis may run.
  std::array<Vec3, 4> likely_directions() const {
    Matrix3d about_zero = Matrix3d::Zero(), about_mean = Matrix3d::Zero();
    for (const Vec3& n : normals_) {
      about_zero += n * n.transpose();
      about_mean += (n - mean_normal_) * (n - mean_normal_).transpose();
    }
    const auto [r1, r2] = radii_of_curvature();
    return {least_direction(about_zero), least_direction(about_mean), normal_of_centres(r1), normal_of_centres(r2)};
  }

  // The cylinder whose circle is nearest to the points seen along the axis, whatever their normals: in a narrow hole
  // these are poor.
  std::optional<Shape> cylinder_along(const Vec3& direction) const {
    const Vec3 x = direction.unitOrthogonal(), y = direction.cross(x);
    Matrix3d matrix = Matrix3d::Zero();
    Vec3 right = Vec3::Zero();
    for (const Vec3& p : points_) {
      const double u = (p - middle_).dot(x), v = (p - middle_).dot(y);
      const Vec3 row(2 * u, 2 * v, 1);
      matrix += row * row.transpose();
      right += (u * u + v * v) * row;
    }
    const Vec3 s = matrix.ldlt().solve(right);
    const double square = s[2] + s[0] * s[0] + s[1] * s[1];
    if (!s.allFinite() || !(square > 0)) return std::nullopt;
    Shape shape{.kind = ShapeKind::cylinder, .origin = middle_ + s[0] * x + s[1] * y, .axis = direction};
    shape.radius = std::sqrt(square);
    double outwards = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vec3 d = points_[i] - shape.origin;
      outwards += normals_[i].dot((d - d.dot(direction) * direction).normalized());
    }
    shape.hollow = outwards < 0;
    return shape;
  }

  void add_about(const KnownAxis& axis, bool known, std::vector<ShapeGuess>& guesses) const {
    const Vec3& direction = axis.direction;
    const std::optional<Vec3> origin = axis.origin ? axis.origin : met_by_normals(direction);
    if (!origin) return;
    const auto add = [&](const Shape& found) { guesses.push_back({found, known, axis.origin.has_value()}); };
    Vector2d place = Vector2d::Zero(), normal = Vector2d::Zero();  // distance from the axis, height along it
    std::vector<Vector2d> places, slopes;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vec3 q = points_[i] - *origin;
      const double height = q.dot(direction);
      const Vec3 across = q - height * direction;
      const double distance = across.norm();
      if (!(distance > 0)) return;
      places.emplace_back(distance, height);
      slopes.emplace_back(normals_[i].dot(across) / distance, normals_[i].dot(direction));
      place += places.back();
      normal += slopes.back();
    }
    place /= static_cast<double>(points_.size());
    normal /= static_cast<double>(points_.size());
    Shape shape{.kind = ShapeKind::cylinder, .origin = *origin, .axis = direction};
    shape.hollow = normal[0] < 0;
    shape.radius = place[0];
    add(shape);

    const double angle = shape.hollow ? std::atan2(normal[1], -normal[0]) : std::atan2(-normal[1], normal[0]);
    // Between a cylinder and a plane lie the cones of 3 to 87 degrees.
    if (std::abs(angle) > 0.05 && std::abs(angle) < 1.52) {
      Shape cone = shape;
      cone.kind = ShapeKind::cone;
      cone.half_angle = angle;
      cone.radius = place[0] - place[1] * std::tan(angle);
      add(cone);
    }
    double up = 0, down = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      up += (places[i] - place).dot(slopes[i] - normal);
      down += (slopes[i] - normal).squaredNorm();
    }
    if (!(down > least_spread())) return;
    const Vector2d centre = place - up / down * normal;
    if (!(centre[0] > 0)) return;
    shape.kind = ShapeKind::torus;
    shape.origin += centre[1] * direction;
    shape.radius = centre[0];
    shape.tube_radius = std::abs(up / down);
    shape.hollow = up < 0;
    add(shape);
  }

 private:
  // Normals within about 2 degrees of one another tell no radius.
  double least_spread() const { return 1e-3 * static_cast<double>(points_.size()); }

  // The axis of this direction that all normals' lines come nearest to.
  std::optional<Vec3> met_by_normals(const Vec3& direction) const {
    const Vec3 x = direction.unitOrthogonal(), y = direction.cross(x);
    Matrix2d matrix = Matrix2d::Zero();
    Vector2d right = Vector2d::Zero();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vector2d side(-normals_[i].dot(y), normals_[i].dot(x));  // normal to the line
      const Vec3 d = points_[i] - middle_;
      matrix += side * side.transpose();
      right += side * side.dot(Vector2d(d.dot(x), d.dot(y)));
    }
    Eigen::SelfAdjointEigenSolver<Matrix2d> solver;
    solver.computeDirect(matrix);
    if (!(solver.eigenvalues()[0] > least_spread())) return std::nullopt;
    const Vector2d centre = matrix.inverse() * right;
    return middle_ + centre[0] * x + centre[1] * y;
  }

  // From the shape operator that turns steps in the tangent plane into turns of the normal.
  std::array<double, 2> radii_of_curvature() const {
    const Vec3 up = mean_normal_.normalized(), x = up.unitOrthogonal(), y = up.cross(x);
    Matrix3d matrix = Matrix3d::Zero();
    Vec3 right = Vec3::Zero();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vec3 d = points_[i] - middle_, n = normals_[i] - mean_normal_;
      const double u = d.dot(x), v = d.dot(y);
      const Vec3 first(u, v, 0), second(0, u, v);
      matrix += first * first.transpose() + second * second.transpose();
      right += n.dot(x) * first + n.dot(y) * second;
    }
    const Vec3 s = matrix.ldlt().solve(right);
    Matrix2d shape_operator;
    shape_operator << s[0], s[1], s[1], s[2];
    Eigen::SelfAdjointEigenSolver<Matrix2d> solver;
    solver.computeDirect(shape_operator);
    const auto radius = [](double curvature) { return std::abs(curvature) > 1e-300 ? 1 / curvature : 1e300; };
    return {radius(solver.eigenvalues()[0]), radius(solver.eigenvalues()[1])};
  }

  // Of the plane in which the centres of curvature lie, where the tube of a torus has this radius.
  Vec3 normal_of_centres(double radius) const {
    if (std::abs(radius) > 1e100) return mean_normal_.normalized();
    Vec3 middle = middle_ - radius * mean_normal_;
    Matrix3d products = Matrix3d::Zero();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vec3 d = points_[i] - radius * normals_[i] - middle;
      products += d * d.transpose();
    }
    return least_direction(products);
  }

  std::vector<Vec3> points_, normals_;
  Vec3 middle_ = Vec3::Zero(), mean_normal_ = Vec3::Zero();
};

// Through the point, if its normal runs that way within about 15 degrees.
std::optional<Shape> plane_across(const Vec3& direction, const OrientedPoints& cloud, std::uint32_t point) {
  const double cosine = direction.dot(cloud.normals[point]);
  if (std::abs(cosine) < 0.966) return std::nullopt;
  return Shape{
      .kind = ShapeKind::plane, .origin = cloud.points[point], .axis = cosine < 0 ? Vec3(-direction) : direction};
}

}  // namespace

std::vector<ShapeGuess> guess_shapes(const OrientedPoints& cloud, std::span<const std::uint32_t> patch,
                                     std::span<const KnownAxis> axes) {
  std::vector<ShapeGuess> guesses;
  if (patch.size() < 4) return guesses;
  const Patch view(cloud, patch);
  guesses.push_back({view.plane()});
  // The seed's own: the patch of one on a narrow face reaches over its edges.
  guesses.push_back(
      {Shape{.kind = ShapeKind::plane, .origin = cloud.points[patch[0]], .axis = cloud.normals[patch[0]]}});
  if (const auto sphere = view.sphere()) guesses.push_back({*sphere});
  for (const KnownAxis& axis : axes) {
    if (!axis.origin)
      if (const auto plane = plane_across(axis.direction, cloud, patch[0])) guesses.push_back({*plane, true});
    if (!axis.origin)
      if (const auto cylinder = view.cylinder_along(axis.direction)) guesses.push_back({*cylinder, true});
    view.add_about(axis, true, guesses);
  }
  for (const Vec3& direction : view.likely_directions()) view.add_about({direction, std::nullopt}, false, guesses);
  return guesses;
}

}  // namespace scan2fea
