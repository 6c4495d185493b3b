#include "preproc/surface/primitives/point_normals.hpp"

#include "preproc/mesh/median.hpp"
#include "preproc/surface/kernel/tangent_frame.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

namespace scan2fea {
namespace {

// With the point itself the plane is over eight.
constexpr std::size_t plane_neighbours = 7;
// Cosine of 40 degrees.
constexpr double same_side_cosine = 0.766;

struct PlaneOfNeighbours {
  Vec3 normal = Vec3::Zero();
  double variance = std::numeric_limits<double>::infinity();  // of the distances
};

std::span<const std::uint32_t> nearest_of(const Neighbours& neighbours, std::uint32_t i) {
  const auto list = neighbours.of(i);
  return list.first(std::min(list.size(), plane_neighbours));
}

PlaneOfNeighbours plane_around(const std::vector<Vec3>& points, const Neighbours& neighbours, std::uint32_t i,
                               const std::vector<Vec3>& outwards) {
  const auto near = nearest_of(neighbours, i);
  if (near.size() < 3) return {};
  Vec3 sum = Vec3::Zero(), out = outwards[i];
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (const std::uint32_t j : near) {
    const Vec3 d = points[j] - points[i];
    sum += d;
    products += d * d.transpose();
    out += outwards[j];
  }
  const double count = static_cast<double>(near.size() + 1);
  products -= sum * sum.transpose() / count;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(products);
  const Vec3 normal = solver.eigenvectors().col(0);
  return {normal.dot(out) < 0 ? Vec3(-normal) : normal, std::max(solver.eigenvalues()[0], 0.0) / count};
}

std::vector<Vec3> flattest_normals(const std::vector<Vec3>& points, const Neighbours& neighbours,
                                   const std::vector<Vec3>& outwards) {
  std::vector<PlaneOfNeighbours> planes(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) planes[i] = plane_around(points, neighbours, i, outwards);
  std::vector<PlaneOfNeighbours> best = planes;
  for (std::uint32_t j = 0; j < points.size(); ++j)
    for (const std::uint32_t i : nearest_of(neighbours, j))
      if (planes[j].variance < best[i].variance) best[i] = planes[j];
  std::vector<Vec3> normals(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) normals[i] = best[i].normal;
  return normals;
}

// A quadric a + b u + c v + d u^2 + e u v + f v^2 over a tangent plane, lengths over `unit`.
class Quadric {
 public:
  using Row = Eigen::Matrix<double, 6, 1>;

  void add(double u, double v, double height) {
    const Row row(1, u, v, u * u, u * v, v * v);
    matrix_ += row * row.transpose();
    right_ += height * row;
    ++count_;
  }

  // Curvature that the points leave open is drawn to zero.
  void solve() {
    const double total = matrix_(0, 0);
    matrix_.diagonal().array() += 1e-9 * total;
    matrix_.diagonal().tail<3>().array() += 1e-4 * total;
    const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> factors(matrix_);
    coefficients_ = factors.solve(right_);
    leverage_ = factors.solve(Row::Unit(0))[0];
  }

  int count() const { return count_; }
  double height() const { return coefficients_[0]; }
  Vec3 normal(const TangentFrame& frame, const Vec3& up) const {
    return (up - coefficients_[1] * frame.x - coefficients_[2] * frame.y).normalized();
  }
  // The variance of the height at the origin, over that of one point.
  double leverage() const { return leverage_; }

 private:
  Eigen::Matrix<double, 6, 6> matrix_ = Eigen::Matrix<double, 6, 6>::Zero();
  Row right_ = Row::Zero(), coefficients_ = Row::Zero();
  double leverage_ = 0;
  int count_ = 0;
};

}  // namespace

PointNormals own_side_normals(const std::vector<Vec3>& points, const Neighbours& neighbours,
                              const std::vector<Vec3>& outwards) {
  // Fewer points than these leave a quadric without a check, or a plane its slope.
  constexpr int least_for_quadric = 9;
  const std::vector<Vec3> planes = flattest_normals(points, neighbours, outwards);
  PointNormals result;
  result.normals = planes;
  std::vector<double> residuals, spacings;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const auto near = neighbours.of(i);
    if (near.size() >= 6) spacings.push_back((points[near[5]] - points[i]).norm());
    if (near.empty() || planes[i].isZero()) continue;
    const TangentFrame frame(planes[i]);
    const double unit = (points[near.back()] - points[i]).norm();
    if (!(unit > 0)) continue;
    Quadric others;
    for (const std::uint32_t j : near) {
      if (planes[j].dot(planes[i]) < same_side_cosine) continue;
      const Vec3 d = (points[j] - points[i]) / unit;
      others.add(d.dot(frame.x), d.dot(frame.y), d.dot(planes[i]));
    }
    if (others.count() < least_for_quadric) continue;
    Quadric all = others;
    others.solve();
    residuals.push_back(unit * std::abs(others.height()) / std::sqrt(1 + others.leverage()));
    all.add(0, 0, 0);
    all.solve();
    result.normals[i] = all.normal(frame, planes[i]);
  }
  result.noise = 1.4826 * median(std::move(residuals));
  result.spacing = median(std::move(spacings));
  return result;
}

}  // namespace scan2fea
