#include "preproc/surface/scan_noise.hpp"

#include "preproc/surface/tangent_frame.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

namespace scan2fea {
namespace {

constexpr std::size_t sampled_vertices = 500;  // the median of so many is within about 6 %
// A normal that is further from the vertex's own tells of a crease, or of facets that no quadric follows: 30°.
constexpr double crease_cosine = 0.866;

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

Vec3 normal_at(const SurfaceMesh& scan, const VertexStars& stars, std::uint32_t v) {
  Vec3 normal = Vec3::Zero();
  for (const std::uint32_t c : stars.corners(v)) normal += area_vector(scan, scan.triangles[c / 3]);
  return normal.norm() > 0 ? Vec3(normal.normalized()) : Vec3::Zero();
}

// Whether it or a neighbour has so many triangles that its two rings are no surrounding; they would cost much, too.
bool has_wide_fan(const SurfaceMesh& scan, const VertexStars& stars, std::uint32_t v) {
  constexpr std::size_t wide = 24;
  if (stars.corners(v).size() > wide) return true;
  for (const std::uint32_t c : stars.corners(v))
    for (const std::uint32_t w : scan.triangles[c / 3])
      if (stars.corners(w).size() > wide) return true;
  return false;
}

// Whether a crease passes through the star of the vertex or of a neighbour.
bool near_crease(const SurfaceMesh& scan, const VertexStars& stars, std::uint32_t v) {
  const Vec3 normal = normal_at(scan, stars, v);
  for (const std::uint32_t c : stars.corners(v))
    for (const std::uint32_t w : scan.triangles[c / 3])
      for (const std::uint32_t d : stars.corners(w)) {
        const Vec3 n = area_vector(scan, scan.triangles[d / 3]);
        if (n.dot(normal) < crease_cosine * n.norm()) return true;
      }
  return false;
}

// Adds `factor` times the weights whose products with the vertices sum up to a vertex's height over the quadric through
// its two rings; false where the quadric is not determined.
bool add_residual(const SurfaceMesh& scan, const VertexStars& stars, std::uint32_t v, double factor,
                  std::map<std::uint32_t, Vec3>& weights) {
  using Row = Eigen::Matrix<double, 6, 1>;
  using Square = Eigen::Matrix<double, 6, 6>;
  const std::vector<std::uint32_t> points = two_rings(scan, stars, v);
  const Vec3 normal = normal_at(scan, stars, v);
  if (points.size() < 9 || normal.isZero()) return false;
  const TangentFrame frame(normal);
  double radius = 0;
  for (const std::uint32_t p : points) radius = std::max(radius, (scan.vertices[p] - scan.vertices[v]).norm());
  if (radius == 0) return false;
  std::vector<Row> rows;
  Square a = Square::Zero();
  for (const std::uint32_t p : points) {
    const Vec3 d = scan.vertices[p] - scan.vertices[v];
    const double x = d.dot(frame.x) / radius, y = d.dot(frame.y) / radius;
    rows.push_back(Row{1, x, y, x * x, x * y, y * y});
    a += rows.back() * rows.back().transpose();
  }
  const Eigen::LDLT<Square> solver(a);
  if (solver.rcond() < 1e-9) return false;
  Row at_vertex = Row::Zero();
  at_vertex[0] = 1;
  const Row fit = solver.solve(at_vertex);
  const auto add = [&](std::uint32_t p, double weight) {
    weights.try_emplace(p, Vec3::Zero()).first->second += factor * weight * normal;
  };
  add(v, 1);
  for (std::size_t i = 0; i < points.size(); ++i) add(points[i], -rows[i].dot(fit));
  return true;
}

// A vertex's height over its quadric, in standard deviations of a single vertex, or what it differs from its
// neighbours', which is noise even where a quadric misses the shape, since it misses much the same for all. Nothing
// where it is not determined.
std::optional<double> residual(const SurfaceMesh& scan, const VertexStars& stars, std::uint32_t v,
                               bool less_neighbours) {
  std::map<std::uint32_t, Vec3> weights;
  if (!add_residual(scan, stars, v, 1, weights)) return {};
  if (less_neighbours) {
    std::vector<std::uint32_t> ring;
    for (const std::uint32_t c : stars.corners(v))
      for (const std::uint32_t w : scan.triangles[c / 3])
        if (w != v) ring.push_back(w);
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    for (const std::uint32_t w : ring)
      if (!add_residual(scan, stars, w, -1.0 / static_cast<double>(ring.size()), weights)) return {};
  }
  double height = 0, squares = 0;
  for (const auto& [p, weight] : weights) {
    height += weight.dot(scan.vertices[p] - scan.vertices[v]);
    squares += weight.squaredNorm();
  }
  return squares > 0.05 ? std::optional(height / std::sqrt(squares)) : std::nullopt;
}

// The sizes of the residuals of a sample of vertices.
std::vector<double> residuals(const SurfaceMesh& scan, const VertexStars& stars, bool near_creases) {
  const std::size_t n = stars.vertex_count();
  std::vector<double> result;
  for (std::size_t v = 0; v < n; v += std::max<std::size_t>(1, n / sampled_vertices)) {
    const auto vertex = static_cast<std::uint32_t>(v);
    if (has_wide_fan(scan, stars, vertex) || (!near_creases && near_crease(scan, stars, vertex))) continue;
    if (const auto r = residual(scan, stars, vertex, near_creases)) result.push_back(std::abs(*r));
  }
  return result;
}

double quantile(std::vector<double>& values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

double estimate_noise(const SurfaceMesh& scan, const VertexStars& stars) {
  // The median and the first decile of a normal distribution's absolute value, in standard deviations.
  constexpr double median = 0.6745, first_decile = 0.1257;
  std::vector<double> heights = residuals(scan, stars, false);
  if (heights.size() >= std::min(stars.vertex_count(), sampled_vertices) / 20 && !heights.empty())
    return quantile(heights, 0.5) / median;
  // Creases, or noise that looks like them, are everywhere: judge by the least of what is there.
  heights = residuals(scan, stars, true);
  return heights.empty() ? 0 : quantile(heights, 0.1) / first_decile;
}

}  // namespace scan2fea
