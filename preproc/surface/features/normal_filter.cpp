#include "preproc/surface/features/normal_filter.hpp"

#include "preproc/surface/kernel/parallel_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {}  // namespace

NormalFilter::NormalFilter(const SurfaceMesh& scan, const VertexStars& stars, std::vector<std::uint32_t> faces)
    : faces_(std::move(faces)), first_{0} {
  double distances = 0;
  for (const std::uint32_t f : faces_) {
    areas_.push_back(area_vector(scan, scan.triangles[f]).norm());
    const Vec3 centre = centroid(scan, scan.triangles[f]);
    const auto begin = static_cast<std::ptrdiff_t>(ring_.size());
    for (const std::uint32_t v : scan.triangles[f])
      for (const std::uint32_t c : stars.corners(v))
        if (c / 3 != f) ring_.push_back(c / 3);
    std::sort(ring_.begin() + begin, ring_.end());
    ring_.erase(std::unique(ring_.begin() + begin, ring_.end()), ring_.end());
    for (std::size_t i = first_.back(); i < ring_.size(); ++i) {
      weight_.push_back((centre - centroid(scan, scan.triangles[ring_[i]])).norm());
      distances += weight_.back();
    }
    first_.push_back(ring_.size());
  }
  const double spacing = distances > 0 ? distances / static_cast<double>(ring_.size()) : 1;
  for (std::size_t i = 0; i < ring_.size(); ++i) {
    const double d = weight_[i] / spacing;
    weight_[i] = std::exp(-0.5 * d * d) * area_vector(scan, scan.triangles[ring_[i]]).norm();
  }
}

void NormalFilter::apply(std::vector<Vec3>& normals, const NormalFilterOptions& options) const {
  const double sigma = 2 * std::sin(options.same_side_deg * std::numbers::pi / 360);  // of the chord between normals
  const double falloff = -0.5 / (sigma * sigma);
  std::vector<Vec3> filtered(faces_.size());
  for (int pass = 0; pass < options.passes; ++pass) {
    for_each_block(faces_.size(), [&](std::size_t first, std::size_t last) {
      for (std::size_t k = first; k < last; ++k) {
        const Vec3& own = normals[faces_[k]];
        Vec3 sum = areas_[k] * own;
        for (std::size_t i = first_[k]; i < first_[k + 1]; ++i) {
          const Vec3& n = normals[ring_[i]];
          sum += weight_[i] * std::exp(falloff * (n - own).squaredNorm()) * n;
        }
        const double length = sum.norm();
        filtered[k] = length > 0 ? Vec3(sum / length) : own;
      }
    });
    for (std::size_t k = 0; k < faces_.size(); ++k) normals[faces_[k]] = filtered[k];
  }
}

}  // namespace scan2fea
