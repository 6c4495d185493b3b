#include "preproc/surface/fit/sample_surface.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

// Into how many parts an edge of this triangle is split. Bounded, since a single huge triangle may come with a tiny
// `longest_edge`; the cap on the number of samples has the last word anyhow.
int parts(const SurfaceMesh& mesh, const Triangle& t, double longest_edge) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    longest = std::max(longest, (mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]).norm());
  }
  return static_cast<int>(std::clamp(std::ceil(longest / longest_edge), 1.0, 1000.0));
}

// Centroids of the sub-triangles and the lattice points between them, each with its share; the triangle's own corners
// are left to the vertices.
void sample_triangle(const ReferenceSurface& scan, std::uint32_t f, int n, SurfaceSamples& out) {
  const Triangle& t = scan.mesh.triangles[f];
  const Vec3& a = scan.mesh.vertices[t[0]];
  const Vec3 u = (scan.mesh.vertices[t[1]] - a) / n;
  const Vec3 v = (scan.mesh.vertices[t[2]] - a) / n;
  const double share = u.cross(v).norm() / 2;
  const Vec3& normal = scan.face_normals[f];
  const auto add = [&](double i, double j, double weight) {
    out.samples.push_back({a + i * u + j * v, normal, weight});
    const double k = n - i - j;
    out.vertex.push_back(k >= i && k >= j ? t[0] : i >= j ? t[1] : t[2]);
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; i + j < n; ++j) {
      add(i + 1. / 3, j + 1. / 3, 0.75 * share);
      if (i + j + 1 < n) add(i + 2. / 3, j + 2. / 3, 0.75 * share);
    }
  }
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; i + j <= n; ++j) {
      const int k = n - i - j;
      const int zeros = (i == 0) + (j == 0) + (k == 0);
      if (zeros == 2) continue;
      add(i, j, (zeros == 1 ? 3 : 6) * share / 12);
    }
  }
}

SurfaceSamples all_samples(const ReferenceSurface& scan, const std::vector<int>& split, std::size_t count) {
  SurfaceSamples out;
  out.samples.reserve(count);
  out.vertex.reserve(count);
  std::vector<double> vertex_weight(scan.mesh.vertices.size(), 0);
  for (std::uint32_t f = 0; f < scan.mesh.triangles.size(); ++f) {
    const Triangle& t = scan.mesh.triangles[f];
    const double area = area_vector(scan.mesh, t).norm() / 2;
    for (const std::uint32_t v : t) vertex_weight[v] += area / (12.0 * split[f] * split[f]);
  }
  std::vector<bool> done(scan.mesh.vertices.size(), false);
  for (std::uint32_t f = 0; f < scan.mesh.triangles.size(); ++f) {
    sample_triangle(scan, f, split[f], out);
    for (const std::uint32_t v : scan.mesh.triangles[f]) {
      if (done[v]) continue;
      done[v] = true;
      out.samples.push_back({scan.mesh.vertices[v], scan.vertex_normals[v], vertex_weight[v]});
      out.vertex.push_back(v);
    }
  }
  return out;
}

// Stratified sampling: one sample somewhere in each unit of a running measure (somewhere, not always at its start: the
// order of the triangles may be periodic), spread over its triangle. Additive recurrences, of the golden ratio and of
// the plastic number, take the place of random numbers: even, and reproducible.
template <class MeasureOfTriangle>
SurfaceSamples stratified_samples(const ReferenceSurface& scan, double unit, const MeasureOfTriangle& measure_of) {
  SurfaceSamples out;
  double stratum = 0;
  double phase = 0.5;
  double passed = 0;
  double x = 0.5;
  double y = 0.5;
  for (std::uint32_t f = 0; f < scan.mesh.triangles.size(); ++f) {
    const Triangle& t = scan.mesh.triangles[f];
    const double area = area_vector(scan.mesh, t).norm() / 2, measure = measure_of(f, area);
    passed += measure;
    for (; (stratum + phase) * unit < passed; ++stratum, phase = std::fmod(phase + 0.6180339887498949, 1.0)) {
      x = std::fmod(x + 0.7548776662466927, 1.0);
      y = std::fmod(y + 0.5698402909980532, 1.0);
      const bool beyond = x + y > 1;
      const double b = beyond ? 1 - x : x;
      const double c = beyond ? 1 - y : y;
      const double a = 1 - b - c;
      out.samples.push_back({a * scan.mesh.vertices[t[0]] + b * scan.mesh.vertices[t[1]] + c * scan.mesh.vertices[t[2]],
                             scan.face_normals[f], area / measure * unit});
      out.vertex.push_back(a >= b && a >= c ? t[0] : b >= c ? t[1] : t[2]);
    }
  }
  return out;
}

}  // namespace

SurfaceSamples sample_surface(const ReferenceSurface& scan, double longest_edge, std::size_t most) {
  std::vector<int> split(scan.mesh.triangles.size());
  std::size_t count = scan.mesh.vertices.size();
  for (std::size_t f = 0; f < split.size(); ++f) {
    split[f] = parts(scan.mesh, scan.mesh.triangles[f], longest_edge);
    const auto n = static_cast<std::size_t>(split[f]);
    count += n * n + (n + 1) * (n + 2) / 2 - 3;
  }
  if (count <= most) return all_samples(scan, split, count);
  const double share = scan.area / static_cast<double>(most);
  return stratified_samples(scan, share, [](std::uint32_t, double area) { return area; });
}

SurfaceSamples sample_surface(const ReferenceSurface& scan, const std::vector<double>& count_of_triangle) {
  return stratified_samples(scan, 1, [&](std::uint32_t f, double) { return count_of_triangle[f]; });
}

}  // namespace scan2fea
