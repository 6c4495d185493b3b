#include "preproc/surface/reconstruction/point_views.hpp"

#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh/median.hpp"
#include "preproc/surface/primitives/point_normals.hpp"
#include "preproc/surface/reconstruction/local_plane.hpp"
#include "preproc/surface/reconstruction/sided_neighbours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace scan2fea {
namespace {

constexpr std::size_t about = 9;  // points of a plane: the point and a ring of eight
// Cosine to the plane beyond which a scanner sees next to nothing of it: 78 degrees.
constexpr double grazing = 0.2;

const Vec3 unknown = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());

// Unit; zero where there is none.
std::vector<Vec3> directions_to(const std::vector<Vec3>& points, const std::vector<Vec3>& scanners) {
  std::vector<Vec3> directions;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 way = scanners[i] - points[i];
    const double distance = way.norm();
    directions.push_back(std::isfinite(distance) && distance > 0 ? Vec3(way / distance) : Vec3(Vec3::Zero()));
  }
  return directions;
}

// Estimated, on the side of the scanner; zero where it is unknown.
std::vector<Vec3> seen_normals(const std::vector<Vec3>& points, const std::vector<Vec3>& scanners) {
  constexpr std::size_t neighbours = 20;
  const std::vector<Vec3> towards = directions_to(points, scanners);
  std::vector<Vec3> normals = own_side_normals(points, nearest_in_space(points, towards, neighbours), towards).normals;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (std::abs(normals[i].dot(towards[i])) < grazing) normals[i].setZero();
  return normals;
}

Vec3 plane_normal(const SidedNeighbours& neighbours, const std::vector<Vec3>& points, std::size_t i) {
  std::array<SidedNeighbours::Neighbour, about> found;
  std::array<Vec3, about> used;
  std::size_t count = 0;
  for (const auto& n : neighbours.nearest(i, found)) used[count++] = points[n.point];
  constexpr std::size_t fewest = 4;
  return count < fewest ? Vec3(Vec3::Zero()) : fit_plane({used.data(), count}).normal;
}

// Of each point the only one of several positions that can have seen it, by the plane through its neighbours: where
// there are others, they are on the same side and see it less squarely. Unknown where both sides have some.
std::vector<Vec3> sole_scanners(const std::vector<Vec3>& points, const std::vector<Vec3>& positions) {
  const std::vector<Vec3> one_side;
  const SidedNeighbours neighbours(points, one_side);
  std::vector<Vec3> scanners(points.size(), unknown);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 n = plane_normal(neighbours, points, i);
    double most = 0, least = 0;
    for (const Vec3& position : positions) {
      const double cosine = n.dot((position - points[i]).normalized());
      if (std::abs(cosine) >= grazing && std::abs(cosine) > std::max(most, -least)) scanners[i] = position;
      most = std::max(most, cosine), least = std::min(least, cosine);
    }
    if (most >= grazing && -least >= grazing) scanners[i] = unknown;
  }
  return scanners;
}

// Directions out of the material held against the points: all by themselves, whatever surface goes through them.
class Directions {
 public:
  Directions(const std::vector<Vec3>& points, const std::vector<Vec3>& outwards)
      : points_(points), outwards_(outwards), neighbours_(points, outwards) {}

  // The median cosine between them and the normals of planes through the neighbours. Of directions at random 0.5.
  double agreement() const {
    std::vector<double> cosines;
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (const Vec3 n = plane_normal(neighbours_, points_, i); !n.isZero() && !outwards_[i].isZero())
        cosines.push_back(std::abs(n.dot(outwards_[i])));
    return cosines.empty() ? 0 : median(std::move(cosines));
  }

  // Of pairs of near points in one plane, those that are opposed. The sides of a wall lie in two planes.
  double opposed() const {
    constexpr double in_plane = 0.1, parallel = 0.8;  // of their distance; cosine
    constexpr std::size_t ring = 7;
    const SidedNeighbours all(points_, none_);
    std::size_t pairs = 0, bad = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      std::array<SidedNeighbours::Neighbour, ring> found;
      for (const auto& n : all.nearest(i, found)) {
        const double cosine = outwards_[i].dot(outwards_[n.point]);
        if (n.point == i || std::abs(cosine) < parallel) continue;
        if (std::abs(outwards_[i].dot(points_[n.point] - points_[i])) > in_plane * n.distance) continue;
        ++pairs;
        bad += cosine < 0;
      }
    }
    return pairs == 0 ? 0 : static_cast<double>(bad) / static_cast<double>(pairs);
  }

  // In directions all about, how much farther the points reach whose sides look that way than those that look back: the
  // sum of what it is, over that of its amounts, from 0, where all look in, to 1. Half of a cloud that looks in has
  // 0.5.
  double outwards_at_ends() const {
    constexpr int ends = 100;
    double all = 0, out = 0;
    for (int k = 0; k < ends; ++k) {
      // Fibonacci's spiral.
      const double z = 1 - (2 * k + 1.0) / ends, turn = k * 2.399963229728653;
      const Vec3 way(std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z);
      const double more = reach(way, 1) - reach(way, -1);
      if (!std::isfinite(more)) continue;
      all += std::abs(more);
      out += std::max(more, 0.0);
    }
    return all == 0 ? 0.5 : out / all;
  }

 private:
  // Of the points whose side times `sign` looks that way, how far the third reaches: one outlier or two do not count.
  double reach(const Vec3& way, double sign) const {
    std::array<double, 3> farthest;
    farthest.fill(-std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      // What is seen from the side says nothing.
      if (sign * outwards_[i].dot(way) < grazing) continue;
      const double at = points_[i].dot(way);
      if (at <= farthest[2]) continue;
      farthest[2] = at;
      std::ranges::sort(farthest, std::greater());
    }
    return farthest[2];
  }

  const std::vector<Vec3>& points_;
  const std::vector<Vec3>& outwards_;
  const std::vector<Vec3> none_;
  SidedNeighbours neighbours_;
};

struct Sample {
  std::vector<std::uint32_t> from;
  std::vector<Vec3> points;
};
Sample sample_of(const std::vector<Vec3>& points) {
  constexpr std::size_t most = 20'000;
  Sample sample;
  for (std::size_t k = 0, count = std::min(most, points.size()); k < count; ++k) {
    sample.from.push_back(static_cast<std::uint32_t>(k * points.size() / count));
    sample.points.push_back(points[sample.from.back()]);
  }
  return sample;
}

std::string per_cent(double share) {
  return error_text(100 * share, 3) + " %";
}

// Cosine of 37 degrees: half of the way from what random ones have to what creases leave of right ones.
constexpr double least_agreement = 0.8;
// Of pairs: when one point in twenty is turned.
constexpr double most_opposed = 0.1;
// What a thin sheet with few points still has.
constexpr double least_outwards = 0.8;

}  // namespace

TrustedViews::TrustedViews(const PointCloud& cloud, const std::vector<Vec3>& positions)
    : cloud_(cloud), positions_(positions) {
  if (!cloud.normals.empty()) judge_normals();
  if (!cloud.scanners.empty() || !positions.empty()) judge_scanners();
}

void TrustedViews::judge_normals() {
  const Sample sample = sample_of(cloud_.points);
  std::vector<Vec3> normals;
  for (const std::uint32_t i : sample.from) normals.push_back(cloud_.normals[i]);
  const Directions directions(sample.points, normals);
  const double agreement = directions.agreement(), opposed = directions.opposed(), out = directions.outwards_at_ends();
  if (agreement < least_agreement) {
    told_.push_back("the cloud's normals were not used: the median cosine to planes through the points is " +
                    error_text(agreement, 3) + " (limit: " + error_text(least_agreement, 3) + "; at random: 0.5)");
  } else if (opposed > most_opposed) {
    told_.push_back("the cloud's normals were not used: " + per_cent(opposed) +
                    " of neighbours in one plane have opposed ones (limit: " + per_cent(most_opposed) + ")");
  } else if (std::max(out, 1 - out) < least_outwards) {
    told_.push_back("the cloud's normals were not used: at its ends some point outwards, others inwards");
  } else {
    has_normals_ = true;
    turn_ = out < 0.5 ? -1 : 1;
    told_.push_back(out < 0.5 ? "the cloud's normals were used; they point inwards and were turned"
                              : "the cloud's normals were used");
  }
}

void TrustedViews::judge_scanners() {
  has_scanners_ = true;
  const Sample sample = sample_of(cloud_.points);
  const std::vector<Vec3> normals = seen_normals(sample.points, seen_from(sample.points, sample.from));
  const Directions directions(sample.points, normals);
  const double opposed = directions.opposed(), out = directions.outwards_at_ends();
  has_scanners_ = opposed <= most_opposed && out >= least_outwards;
  if (has_scanners_)
    told_.push_back("the scanner's positions were used");
  else if (opposed > most_opposed)
    told_.push_back(
        "the scanner's positions were not used: " + per_cent(opposed) +
        " of neighbours in one plane would have been seen from its two sides (limit: " + per_cent(most_opposed) + ")");
  else
    told_.push_back("the scanner's positions were not used: ends of the cloud would have been seen from inside");
}

std::vector<Vec3> TrustedViews::seen_from(const std::vector<Vec3>& points,
                                          const std::vector<std::uint32_t>& from) const {
  if (positions_.size() > 1) return sole_scanners(points, positions_);
  const std::vector<Vec3>& given = positions_.empty() ? cloud_.scanners : positions_;
  if (given.size() == 1) return std::vector<Vec3>(points.size(), given[0]);
  std::vector<Vec3> scanners;
  for (const std::uint32_t i : from) scanners.push_back(i == no_point ? unknown : given[i]);
  return scanners;
}

std::vector<Vec3> TrustedViews::outwards() const {
  std::vector<Vec3> directions;
  if (has_normals_) {
    for (const Vec3& n : cloud_.normals) directions.push_back(turn_ * n);
  } else if (has_scanners_ && positions_.size() < 2) {
    std::vector<std::uint32_t> all(cloud_.points.size());
    std::iota(all.begin(), all.end(), 0U);
    directions = directions_to(cloud_.points, seen_from(cloud_.points, all));
  }
  return directions;
}

PointViews TrustedViews::of(const std::vector<Vec3>& points, const std::vector<std::uint32_t>& from) const {
  PointViews views;
  if (has_scanners_) views.scanners = seen_from(points, from);
  if (has_normals_)
    for (const std::uint32_t i : from)
      views.normals.push_back(i == no_point ? Vec3(Vec3::Zero()) : Vec3(turn_ * cloud_.normals[i]));
  else if (has_scanners_)
    views.normals = seen_normals(points, views.scanners);
  return views;
}

}  // namespace scan2fea
