#include "preproc/surface/reconstruction/surface_outliers.hpp"

#include "preproc/mesh/median.hpp"
#include "preproc/surface/kernel/parallel_blocks.hpp"
#include "preproc/surface/kernel/point_neighbours.hpp"
#include "preproc/surface/primitives/find_primitives.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

namespace scan2fea {
namespace {

constexpr std::size_t of_quadric = 16;  // neighbours of a quadric: its six numbers, and enough to check them
constexpr double of_gauss = 1.4826;     // standard deviation over median distance
constexpr double beyond_noise = 3.5;    // one point in two thousand of Gaussian noise

using Row = Eigen::Matrix<double, 6, 1>;

Row row_of(const Vec3& p) {
  return Row(1, p[1], p[2], p[1] * p[1], p[1] * p[2], p[2] * p[2]);
}

// How far p is from the quadric through `others`, by Tukey's weights, over what that is unsure of; model units.
double distance_from_quadric(const Vec3& p, std::span<const Vec3> others) {
  const auto count = static_cast<double>(others.size());
  Vec3 centre = Vec3::Zero();
  for (const Vec3& q : others) centre += q / count;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Vec3& q : others) covariance += (q - centre) * (q - centre).transpose() / count;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.computeDirect(covariance);
  const double unit = std::sqrt(axes.eigenvalues()[2]);
  if (!(unit > 0)) return 0;
  const Eigen::Matrix3d frame = axes.eigenvectors().transpose() / unit;
  std::array<Vec3, of_quadric> at;
  std::array<double, of_quadric> weight;
  for (std::size_t k = 0; k < others.size(); ++k) at[k] = frame * (others[k] - centre), weight[k] = 1;
  const Vec3 place = frame * (p - centre);
  const Row row = row_of(place);
  double distance = 0;
  for (int round = 0; round < 3; ++round) {
    Eigen::Matrix<double, 6, 6> matrix = 1e-9 * count * Eigen::Matrix<double, 6, 6>::Identity();
    Row right = Row::Zero();
    for (std::size_t k = 0; k < others.size(); ++k) {
      const Row r = row_of(at[k]);
      matrix += weight[k] * r * r.transpose();
      right += weight[k] * at[k][0] * r;
    }
    const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> factors(matrix);
    const Row quadric = factors.solve(right);
    distance = std::abs(place[0] - quadric.dot(row)) / std::sqrt(1 + std::max(0.0, row.dot(factors.solve(row))));
    std::array<double, of_quadric> off;
    for (std::size_t k = 0; k < others.size(); ++k) off[k] = std::abs(at[k][0] - quadric.dot(row_of(at[k])));
    constexpr double tukey = 4.7, least = 1e-3;
    const double freedom = std::sqrt(count / std::max(1.0, count - 6));
    const double sigma = of_gauss * freedom * median({off.begin(), off.begin() + std::ptrdiff_t(others.size())});
    if (!(sigma > 0)) break;
    for (std::size_t k = 0; k < others.size(); ++k) {
      const double share = off[k] / (tukey * sigma);
      weight[k] = share < 1 ? std::max(least, (1 - share * share) * (1 - share * share)) : least;
    }
  }
  return unit * distance;
}

class SecondLook {
 public:
  SecondLook(const SurfaceMesh& surface, const Primitives& shapes, const std::vector<Vec3>& points)
      : surface_(surface), points_(points), found_(shapes), near_(nearest_on_surface(surface, of_quadric)) {
    find_places();
    find_distances();
  }

  std::vector<bool> run() const {
    std::vector<char> is_outlier(points_.size());
    for_each_block(points_.size(), [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) is_outlier[i] = judge(i);
    });
    std::vector<bool> result(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i)
      result[i] = is_outlier[i] && (is_far_[i] || is_alone(i, is_outlier));
    return result;
  }

 private:
  // The vertex of the surface that a point is, or else the nearest one, and its neighbours without the point.
  struct Ring {
    std::array<std::uint32_t, of_quadric + 1> points;
    std::size_t count = 0;
  };
  Ring ring(std::size_t i) const {
    Ring result;
    const std::uint32_t v = place_[i];
    if (v != i) result.points[result.count++] = v;
    for (const std::uint32_t w : near_.of(v)) result.points[result.count++] = w;
    result.count = std::min(result.count, of_quadric);
    return result;
  }

  void find_places();
  void find_distances();
  bool judge(std::size_t i) const;
  bool is_alone(std::size_t i, const std::vector<char>& is_outlier) const;
  bool is_off_quadric(std::size_t i) const;
  std::optional<bool> is_off_shapes(std::size_t i) const;

  const SurfaceMesh& surface_;
  const std::vector<Vec3>& points_;
  const Primitives& found_;
  Neighbours near_;
  std::vector<std::uint32_t> place_;
  std::vector<bool> is_far_;      // from any vertex, for the spacing there
  std::vector<double> distance_;  // from quadrics; of each point
  double noise_ = 0;
};

void SecondLook::find_places() {
  constexpr double far = 2;  // spacings
  std::vector<Vec3> used;
  std::vector<std::uint32_t> number;
  for (std::uint32_t v = 0; v < surface_.vertices.size(); ++v)
    if (!near_.of(v).empty()) used.push_back(surface_.vertices[v]), number.push_back(v);
  const PointNeighbours neighbours(used);
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    if (i < surface_.vertices.size() && !near_.of(i).empty()) {
      place_.push_back(i);
      is_far_.push_back(false);
      continue;
    }
    std::array<PointNeighbours::Neighbour, 1> found;
    const auto nearest = neighbours.nearest(points_[i], found)[0];
    place_.push_back(number[nearest.point]);
    double spacing = 0;
    const auto near = near_.of(place_.back());
    constexpr std::size_t ring = 6;
    for (std::size_t k = 0; k < std::min(ring, near.size()); ++k)
      spacing += (points_[near[k]] - points_[place_.back()]).norm() / static_cast<double>(std::min(ring, near.size()));
    is_far_.push_back(nearest.distance > far * spacing);
  }
}

void SecondLook::find_distances() {
  distance_.resize(points_.size());
  for_each_block(points_.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const Ring near = ring(i);
      std::array<Vec3, of_quadric> others;
      for (std::size_t k = 0; k < near.count; ++k) others[k] = points_[near.points[k]];
      constexpr std::size_t fewest = 8;
      distance_[i] = near.count < fewest ? 0 : distance_from_quadric(points_[i], {others.data(), near.count});
    }
  });
  noise_ = of_gauss * median(distance_);
}

bool SecondLook::is_off_quadric(std::size_t i) const {
  constexpr double beyond_neighbours = 3.3;
  if (distance_[i] <= beyond_noise * noise_) return false;
  const Ring near = ring(i);
  std::vector<double> theirs;
  for (std::size_t k = 0; k < near.count; ++k) theirs.push_back(distance_[near.points[k]]);
  return distance_[i] > beyond_neighbours * of_gauss * median(std::move(theirs));
}

std::optional<bool> SecondLook::is_off_shapes(std::size_t i) const {
  if (found_.list.empty()) return std::nullopt;
  const Ring near = ring(i);
  std::size_t unlabelled = 0;
  double least = std::numeric_limits<double>::infinity();
  const auto try_label = [&](std::uint32_t v) {
    const std::uint32_t label = found_.labels[v];
    if (label != no_primitive) least = std::min(least, std::abs(found_.list[label].shape.signed_distance(points_[i])));
    return label != no_primitive;
  };
  if (i < surface_.vertices.size()) try_label(static_cast<std::uint32_t>(i));
  for (std::size_t k = 0; k < near.count; ++k) unlabelled += !try_label(near.points[k]);
  if (least <= beyond_noise * found_.sigma) return false;
  constexpr std::size_t crowd = 3;
  if (unlabelled >= crowd) return std::nullopt;
  return true;
}

bool SecondLook::judge(std::size_t i) const {
  if (is_far_[i]) return true;
  return is_off_shapes(i).value_or(is_off_quadric(i));
}

// Where many neighbours are said to be outliers, too, the surface is at fault.
bool SecondLook::is_alone(std::size_t i, const std::vector<char>& is_outlier) const {
  constexpr std::ptrdiff_t crowd = 3;
  const Ring near = ring(i);
  return std::count_if(near.points.begin(), near.points.begin() + std::ptrdiff_t(near.count),
                       [&](std::uint32_t v) { return is_outlier[v] != 0; }) < crowd;
}

}  // namespace

std::vector<bool> find_surface_outliers(const SurfaceMesh& surface, const Primitives& shapes,
                                        const std::vector<Vec3>& points) {
  return SecondLook(surface, shapes, points).run();
}

}  // namespace scan2fea
