#include "preproc/surface/features/scan_noise.hpp"

#include "preproc/surface/kernel/tangent_frame.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace scan2fea {
namespace {

// The median and the first decile of a normal distribution's absolute value, in standard deviations.
constexpr double median_size = 0.6745, first_decile = 0.1257;
constexpr std::size_t sampled = 500;  // the median of so many is within about 6 %
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

// A vertex's height over the quadric through its two rings, in standard deviations of a single vertex.
struct QuadricResidual {
  double height;
  std::vector<std::uint32_t> points;  // ascending
  std::vector<double> weights;        // of their heights in it
};

// Nothing where the quadric is not determined, or leaves the vertex no freedom.
std::optional<QuadricResidual> quadric_residual(const SurfaceMesh& scan, const VertexStars& stars, std::uint32_t v) {
  using Row = Eigen::Matrix<double, 6, 1>;
  using Square = Eigen::Matrix<double, 6, 6>;
  const std::vector<std::uint32_t> points = two_rings(scan, stars, v);
  const Vec3 normal = normal_at(scan, stars, v);
  if (points.size() < 9 || normal.isZero()) return {};
  const TangentFrame frame(normal);
  double radius = 0;
  for (const std::uint32_t p : points) radius = std::max(radius, (scan.vertices[p] - scan.vertices[v]).norm());
  if (radius == 0) return {};
  Square a = Square::Zero();
  std::vector<Row> rows;
  for (const std::uint32_t p : points) {
    const Vec3 d = scan.vertices[p] - scan.vertices[v];
    const double x = d.dot(frame.x) / radius, y = d.dot(frame.y) / radius;
    rows.emplace_back(Row{1, x, y, x * x, x * y, y * y});
    a += rows.back() * rows.back().transpose();
  }
  const Eigen::LDLT<Square> solver(a);
  if (solver.rcond() < 1e-9) return {};
  Row at_vertex = Row::Zero();
  at_vertex[0] = 1;
  const Row hat = solver.solve(at_vertex);
  const double freedom = 1 - hat[0];  // variance of the residual over that of a vertex
  if (!(freedom > 0.05)) return {};
  QuadricResidual result{0, points, {}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    result.weights.push_back(((points[i] == v ? 1.0 : 0.0) - hat.dot(rows[i])) / std::sqrt(freedom));
    result.height += result.weights[i] * (scan.vertices[points[i]] - scan.vertices[v]).dot(normal);
  }
  return result;
}

// Of two residuals, over the variance of a vertex, where nothing but independent noise is in them.
double covariance_of_noise(const QuadricResidual& a, const QuadricResidual& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    const auto at = std::lower_bound(b.points.begin(), b.points.end(), a.points[i]);
    if (at != b.points.end() && *at == a.points[i])
      sum += a.weights[i] * b.weights[static_cast<std::size_t>(at - b.points.begin())];
  }
  return sum;
}

// The sizes of the residuals from quadrics of a sample of vertices, those near creases aside, in standard deviations of
// a single vertex.
std::vector<double> quadric_residuals(const SurfaceMesh& scan, const VertexStars& stars) {
  std::vector<double> result;
  const std::size_t n = stars.vertex_count();
  for (std::size_t i = 0; i < n; i += std::max<std::size_t>(1, n / sampled)) {
    const auto v = static_cast<std::uint32_t>(i);
    if (has_wide_fan(scan, stars, v) || near_crease(scan, stars, v)) continue;
    if (const auto r = quadric_residual(scan, stars, v)) result.push_back(std::abs(r->height));
  }
  return result;
}

// The heights of corners over the planes of faces that they are not of but whose edge they see, likewise.
std::vector<double> heights_over_neighbours(const SurfaceMesh& scan, const std::vector<Triangle>& neighbours) {
  std::vector<double> result;
  const std::size_t n = scan.triangles.size();
  for (std::size_t f = 0; f < n; f += std::max<std::size_t>(1, n / sampled)) {
    const Vec3 area = area_vector(scan, scan.triangles[f]);
    for (const std::uint32_t g : neighbours[f]) {
      if (g == no_face || area.norm() == 0) continue;
      for (const std::uint32_t v : scan.triangles[g]) {
        const Triangle& t = scan.triangles[f];
        if (v == t[0] || v == t[1] || v == t[2]) continue;
        // Its weights on the four corners, and so its deviation: the corner's place in barycentric coordinates.
        const Vec3 d = scan.vertices[v] - scan.vertices[t[0]];
        const Vec3 u = scan.vertices[t[1]] - scan.vertices[t[0]], w = scan.vertices[t[2]] - scan.vertices[t[0]];
        const double b = d.cross(w).dot(area) / area.squaredNorm(), c = u.cross(d).dot(area) / area.squaredNorm();
        const double a = 1 - b - c;
        result.push_back(std::abs(d.dot(area.normalized())) / std::sqrt(1 + a * a + b * b + c * c));
      }
    }
  }
  return result;
}

// A covariance is known less well than a median.
constexpr std::size_t pairs = 4 * sampled, fewest_pairs = 50;

// Residuals of two vertices that share an edge, and their covariance where they are of independent noise alone.
struct NeighbourPair {
  double a, b, covariance;
};

std::vector<NeighbourPair> neighbour_pairs(const SurfaceMesh& scan, const VertexStars& stars, bool near_creases) {
  const auto is_out = [&](std::uint32_t v) {
    return has_wide_fan(scan, stars, v) || (!near_creases && near_crease(scan, stars, v));
  };
  std::vector<NeighbourPair> found;
  const std::size_t n = stars.vertex_count();
  for (std::size_t i = 0; i < n; i += std::max<std::size_t>(1, n / pairs)) {
    const auto v = static_cast<std::uint32_t>(i);
    if (stars.corners(v).empty()) continue;
    const std::uint32_t corner = stars.corners(v)[0];
    const std::uint32_t w = scan.triangles[corner / 3][(corner + 1) % 3];
    if (is_out(v) || is_out(w)) continue;
    const auto a = quadric_residual(scan, stars, v), b = quadric_residual(scan, stars, w);
    if (a && b) found.push_back({a->height, b->height, covariance_of_noise(*a, *b)});
  }
  return found;
}

double quantile(std::vector<double>& values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

double estimate_noise(const SurfaceMesh& scan, const MeshAdjacency& adjacency) {
  std::vector<double> heights = quadric_residuals(scan, adjacency.stars);
  if (heights.size() >= std::min(adjacency.stars.vertex_count(), sampled) / 20 && !heights.empty())
    return quantile(heights, 0.5) / median_size;
  // Creases, or noise that looks like them, are everywhere: judge by the flattest of pairs of faces, of which a part
  // made of facets has many.
  heights = heights_over_neighbours(scan, adjacency.neighbours);
  return heights.empty() ? 0 : quantile(heights, 0.1) / first_decile;
}

double estimate_independent_noise(const SurfaceMesh& scan, const VertexStars& stars) {
  constexpr double largest = 3;  // times the median, which is 2 standard deviations: beyond are spikes
  // Along a crease residuals go one way; but where noise tilts faces as much, creases are few among what looks like
  // one.
  constexpr std::size_t many = 4;
  // Of the residuals' own size. Shapes of which noise was made have 0.75 to 1.1 of it; meshes of libcgal-demo without
  // noise up to 0.4, and 1.4 where facets alternate.
  constexpr double least_of_all = 0.6, most_of_all = 1.25;
  std::vector<NeighbourPair> found = neighbour_pairs(scan, stars, false);
  if (many * found.size() < std::min(stars.vertex_count(), pairs)) found = neighbour_pairs(scan, stars, true);
  if (found.size() < fewest_pairs) return 0;
  std::vector<double> heights;
  for (const NeighbourPair& pair : found) heights.insert(heights.end(), {std::abs(pair.a), std::abs(pair.b)});
  const double middle = quantile(heights, 0.5), most = largest * middle;
  double measured = 0, expected = 0;
  for (const NeighbourPair& pair : found) {
    measured += pair.covariance * std::clamp(pair.a, -most, most) * std::clamp(pair.b, -most, most);
    expected += pair.covariance * pair.covariance;
  }
  if (!(measured > 0 && expected > 0)) return 0;
  const double noise = std::sqrt(measured / expected), all = middle / median_size;
  return noise > least_of_all * all && noise < most_of_all * all ? noise : 0;
}

}  // namespace scan2fea
