#include "preproc/surface/scan_noise.hpp"

#include "preproc/surface/tangent_frame.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace scan2fea {
namespace {

constexpr std::size_t sampled_vertices = 1000;  // the median of so many is within about 4 %
constexpr double crease_cosine = 0.7;           // a normal more than 45° from the vertex's own tells of a crease
constexpr double sigma_of_median = 1.4826;      // of a normal distribution's absolute value

std::vector<std::uint32_t> two_rings(const SurfaceMesh& scan, const VertexStars& stars, std::uint32_t v) {
  std::vector<std::uint32_t> rings;
  for (const std::uint32_t c : stars.corners(v))
    for (const std::uint32_t w : scan.triangles[c / 3])
      for (const std::uint32_t d : stars.corners(w))
        for (const std::uint32_t u : scan.triangles[d / 3]) rings.push_back(u);
  std::sort(rings.begin(), rings.end());
  rings.erase(std::unique(rings.begin(), rings.end()), rings.end());
  return rings;
}

// Whether a crease passes through the star of the vertex or of a neighbour.
bool near_crease(const SurfaceMesh& scan, const VertexStars& stars, std::uint32_t v, const Vec3& normal) {
  for (const std::uint32_t c : stars.corners(v))
    for (const std::uint32_t w : scan.triangles[c / 3])
      for (const std::uint32_t d : stars.corners(w)) {
        const Vec3 n = area_vector(scan, scan.triangles[d / 3]);
        if (n.dot(normal) < crease_cosine * n.norm()) return true;
      }
  return false;
}

// The vertex's height over the quadric, in standard deviations of a single vertex. Nothing near creases and where the
// fit is not determined, or leaves the vertex no freedom.
std::optional<double> residual(const SurfaceMesh& scan, const VertexStars& stars, std::uint32_t v) {
  using Row = Eigen::Matrix<double, 6, 1>;
  const std::vector<std::uint32_t> points = two_rings(scan, stars, v);
  if (points.size() < 9) return {};
  Vec3 normal = Vec3::Zero();
  for (const std::uint32_t c : stars.corners(v)) normal += area_vector(scan, scan.triangles[c / 3]);
  if (normal.norm() == 0) return {};
  normal.normalize();
  if (near_crease(scan, stars, v, normal)) return {};
  const TangentFrame frame(normal);
  double radius = 0;
  for (const std::uint32_t p : points) radius = std::max(radius, (scan.vertices[p] - scan.vertices[v]).norm());
  if (radius == 0) return {};

  Eigen::Matrix<double, 6, 6> a = Eigen::Matrix<double, 6, 6>::Zero();
  Row b = Row::Zero();
  for (const std::uint32_t p : points) {
    const Vec3 d = scan.vertices[p] - scan.vertices[v];
    const double x = d.dot(frame.x) / radius, y = d.dot(frame.y) / radius;
    const Row row{1, x, y, x * x, x * y, y * y};
    a += row * row.transpose();
    b += row * d.dot(normal);
  }
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver(a);
  if (solver.rcond() < 1e-9) return {};
  Row at_vertex = Row::Zero();
  at_vertex[0] = 1;
  const double freedom = 1 - solver.solve(at_vertex)[0];  // variance of the residual over that of a vertex
  if (freedom < 0.05) return {};
  return solver.solve(b)[0] / std::sqrt(freedom);
}

}  // namespace

double estimate_noise(const SurfaceMesh& scan, const VertexStars& stars) {
  const std::size_t n = stars.vertex_count();
  const std::size_t stride = std::max<std::size_t>(1, n / sampled_vertices);
  std::vector<double> residuals;
  for (std::size_t v = 0; v < n; v += stride)
    if (const auto r = residual(scan, stars, static_cast<std::uint32_t>(v))) residuals.push_back(std::abs(*r));
  if (residuals.empty()) return 0;
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(residuals.begin(), middle, residuals.end());
  return sigma_of_median * *middle;
}

}  // namespace scan2fea
