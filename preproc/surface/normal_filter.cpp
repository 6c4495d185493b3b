#include "preproc/surface/normal_filter.hpp"

#include "preproc/surface/parallel_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

// The faces around each face's vertices, without itself, and their weights that stay through the passes.
struct FaceRings {
  std::vector<std::size_t> first;
  std::vector<std::uint32_t> face;
  std::vector<double> weight;
};

FaceRings face_rings(const SurfaceMesh& scan, const VertexStars& stars) {
  const std::size_t n = scan.triangles.size();
  FaceRings rings;
  rings.first.push_back(0);
  std::vector<Vec3> centroids(n);
  for (std::size_t f = 0; f < n; ++f) {
    const Triangle& t = scan.triangles[f];
    centroids[f] = (scan.vertices[t[0]] + scan.vertices[t[1]] + scan.vertices[t[2]]) / 3;
  }
  double distances = 0;
  std::vector<std::uint32_t> ring;
  for (std::uint32_t f = 0; f < n; ++f) {
    ring.clear();
    for (const std::uint32_t v : scan.triangles[f])
      for (const std::uint32_t c : stars.corners(v))
        if (c / 3 != f) ring.push_back(c / 3);
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    for (const std::uint32_t g : ring) {
      rings.face.push_back(g);
      rings.weight.push_back((centroids[f] - centroids[g]).norm());
      distances += rings.weight.back();
    }
    rings.first.push_back(rings.face.size());
  }
  const double spacing = rings.face.empty() ? 1 : distances / static_cast<double>(rings.face.size());
  for (std::size_t i = 0; i < rings.face.size(); ++i) {
    const double d = rings.weight[i] / spacing;
    rings.weight[i] = std::exp(-0.5 * d * d) * area_vector(scan, scan.triangles[rings.face[i]]).norm();
  }
  return rings;
}

}  // namespace

void filter_normals(const SurfaceMesh& scan, const VertexStars& stars, std::vector<Vec3>& normals,
                    const NormalFilterOptions& options) {
  const FaceRings rings = face_rings(scan, stars);
  // Of the chord between unit normals.
  const double sigma = 2 * std::sin(options.same_side_deg * std::numbers::pi / 360);
  const double falloff = -0.5 / (sigma * sigma);
  std::vector<Vec3> filtered(normals.size());
  for (int pass = 0; pass < options.passes; ++pass) {
    for_each_block(normals.size(), [&](std::size_t first, std::size_t last) {
      for (std::size_t f = first; f < last; ++f) {
        Vec3 sum = area_vector(scan, scan.triangles[f]).norm() * normals[f];
        for (std::size_t i = rings.first[f]; i < rings.first[f + 1]; ++i) {
          const Vec3& n = normals[rings.face[i]];
          sum += rings.weight[i] * std::exp(falloff * (n - normals[f]).squaredNorm()) * n;
        }
        const double length = sum.norm();
        filtered[f] = length > 0 ? Vec3(sum / length) : normals[f];
      }
    });
    std::swap(normals, filtered);
  }
}

}  // namespace scan2fea
