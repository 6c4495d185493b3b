// Which side of a cloud's points is out, by the normals and scanner positions that came with them.
#pragma once

#include "preproc/mesh/point_cloud.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace scan2fea {

// One a point each, or none at all.
struct PointViews {
  std::vector<Vec3> normals;   // unit, outwards; zero where unknown
  std::vector<Vec3> scanners;  // not finite where unknown
  double noise = 0;            // of the points along the view, model units

  bool is_empty() const { return normals.empty() && scanners.empty(); }
};

inline constexpr std::uint32_t no_point = ~std::uint32_t{0};

// What of a cloud's normals and scanners holds.
class TrustedViews {
 public:
  // Held against the points, 20,000 of them at most. Normals must be normal to planes through the neighbours (those at
  // random are not), no two points of one plane may have opposed ones (mixed signs), and at the ends of the cloud they
  // must point out of it; where all point into it they are turned. Scanners must be before such planes, too, all on one
  // side of each, and outside at the ends. What fails is left out. `positions`: instead of the cloud's own scanners: a
  // point was seen from any of these, and has a side where all that may have seen it are on one. A second for two
  // million points.
  TrustedViews(const PointCloud& cloud, const std::vector<Vec3>& positions);

  // Of all given points a direction outwards, unit, zero where unknown; or none at all.
  std::vector<Vec3> outwards() const;

  // Of points that were made of the given ones `from`, no_point where nobody knows. Where there are no normals they are
  // estimated, on the scanner's side.
  PointViews of(const std::vector<Vec3>& points, const std::vector<std::uint32_t>& from) const;

  // What was used and what not, and why: sentences without a full stop.
  const std::vector<std::string>& told() const { return told_; }

 private:
  std::vector<Vec3> seen_from(const std::vector<Vec3>& points, const std::vector<std::uint32_t>& from) const;
  void judge_normals();
  void judge_scanners();

  const PointCloud& cloud_;
  const std::vector<Vec3>& positions_;
  bool has_normals_ = false, has_scanners_ = false;
  double turn_ = 1;  // of the normals
  std::vector<std::string> told_;
};

}  // namespace scan2fea
