#include "preproc/surface/primitives/shape_rating.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <vector>

namespace scan2fea {
namespace {

using Index = std::uint32_t;
using Which = std::span<const Index>;

std::vector<double> distances(const OrientedPoints& cloud, const Shape& shape, Which which) {
  std::vector<double> all;
  all.reserve(which.size());
  for (const Index i : which) all.push_back(shape.signed_distance(cloud.points[i]));
  return all;
}

double rms_of(const std::vector<double>& values) {
  double squares = 0;
  for (const double v : values) squares += v * v;
  return std::sqrt(squares / std::max<double>(1, static_cast<double>(values.size())));
}

// Of distances that belong to `which`, between those that are neighbours.
double autocorrelation(const Neighbours& neighbours, Which which, const std::vector<double>& distance) {
  constexpr std::size_t ring = 6;
  double mean = 0, squares = 0, products = 0;
  for (const double d : distance) mean += d;
  mean /= static_cast<double>(which.size());
  std::size_t pairs = 0;
  for (std::size_t k = 0; k < which.size(); ++k) {
    const double r = distance[k] - mean;
    squares += r * r;
    const auto near = neighbours.of(which[k]);
    for (const Index j : near.first(std::min(ring, near.size()))) {
      const auto at = std::lower_bound(which.begin(), which.end(), j);
      if (at == which.end() || *at != j) continue;
      products += r * (distance[static_cast<std::size_t>(at - which.begin())] - mean);
      ++pairs;
    }
  }
  if (pairs == 0 || !(squares > 0)) return 0;
  return products / static_cast<double>(pairs) / (squares / static_cast<double>(which.size()));
}

// Whether a quadric over the plane explains so much of the distances from it that it is a strip of a rounding: by the
// F-test, and a fifth of the squares, since among a thousand points a few of an adjoining rounding are significant.
bool is_bent(const OrientedPoints& cloud, const Shape& plane, Which which, const std::vector<double>& distance) {
  constexpr double significant = 5, share_of_squares = 0.2;
  const auto count = static_cast<double>(which.size());
  if (which.size() < 9) return false;
  const Vec3 x = plane.axis.unitOrthogonal(), y = plane.axis.cross(x);
  using Row = Eigen::Matrix<double, 6, 1>;
  Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
  Row right = Row::Zero();
  double squares = 0, size = 0;
  for (const Index i : which) size = std::max(size, (cloud.points[i] - plane.origin).norm());
  for (std::size_t k = 0; k < which.size(); ++k) {
    const Vec3 d = (cloud.points[which[k]] - plane.origin) / size;
    const double u = d.dot(x), v = d.dot(y), r = distance[k] / size;
    const Row row(1, u, v, u * u, u * v, v * v);
    matrix += row * row.transpose();
    right += r * row;
    squares += r * r;
  }
  const double explained = right.dot(matrix.ldlt().solve(right)) / squares;
  return explained > share_of_squares && explained / 3 > significant * (1 - explained) / (count - 6);
}

// Those whose neighbours all belong to it too; all, where these are few. Beside a tangent rounding a shape ends in
// points that are as much the rounding's.
std::vector<Index> inner_points(const Neighbours& neighbours, Which which) {
  constexpr std::size_t ring = 6;
  std::vector<Index> inner;
  for (const Index i : which) {
    const auto near = neighbours.of(i).first(std::min(ring, neighbours.of(i).size()));
    if (std::ranges::all_of(near, [&](Index j) { return std::binary_search(which.begin(), which.end(), j); }))
      inner.push_back(i);
  }
  if (3 * inner.size() < 2 * which.size()) inner.assign(which.begin(), which.end());
  return inner;
}

// The root mean square distance from the points' own plane.
double rms_from_plane(const OrientedPoints& cloud, Which which) {
  Vec3 middle = Vec3::Zero();
  for (const Index i : which) middle += cloud.points[i];
  middle /= static_cast<double>(which.size());
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (const Index i : which) products += (cloud.points[i] - middle) * (cloud.points[i] - middle).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(products, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[0]) / static_cast<double>(which.size()));
}

}  // namespace

double cost_of(const OrientedPoints& cloud, const ShapeNoise& noise, const Shape& shape, Index i) {
  // Near a sharp edge normals are of neither side, so that the distance decides.
  constexpr double most_for_normal = 9;
  const double d = shape.signed_distance(cloud.points[i]) / noise.sigma;
  if (d * d >= most_cost) return d * d;
  const Vec3 normal = shape.normal(cloud.points[i]);
  // Beyond a right angle it is the other side of a wall.
  if (normal.dot(cloud.normals[i]) < 0) return 2 * most_cost;
  const double turn = (normal - cloud.normals[i]).squaredNorm() / (noise.sigma_angle * noise.sigma_angle);
  return d * d + std::min(most_for_normal, turn);
}

double rms_distance(const OrientedPoints& cloud, const Shape& shape, Which which) {
  return rms_of(distances(cloud, shape, which));
}

bool leaves_noise(const OrientedPoints& cloud, const Neighbours& neighbours, const ShapeNoise& noise,
                  const Shape& shape, Which which) {
  // A fifth more than the noise, since it is not the same everywhere, and what chance adds to few points.
  const double most = noise.sigma * (1.2 + 0.8 / std::sqrt(static_cast<double>(which.size())));
  constexpr double most_autocorrelation = 0.5;
  // Below this the points' bend is lost in the noise.
  constexpr double least_over_plane = 1.25;
  if (which.size() < 4) return false;
  const std::vector<double> distance = distances(cloud, shape, which);
  const double rms = rms_of(distance);
  if (rms > most) return false;
  if (shape.kind != ShapeKind::plane && rms_from_plane(cloud, which) < least_over_plane * std::max(rms, noise.sigma))
    return false;
  // Far below the noise residuals are rounding.
  if (rms < 0.5 * noise.sigma) return true;
  const std::vector<Index> inner = inner_points(neighbours, which);
  const std::vector<double> of_inner = distances(cloud, shape, inner);
  return autocorrelation(neighbours, inner, of_inner) < most_autocorrelation &&
         !(shape.kind == ShapeKind::plane && is_bent(cloud, shape, inner, of_inner));
}

}  // namespace scan2fea
