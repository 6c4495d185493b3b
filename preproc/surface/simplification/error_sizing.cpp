#include "preproc/surface/simplification/error_sizing.hpp"

#include "preproc/surface/kernel/locate.hpp"
#include "preproc/surface/kernel/nearest.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

using Range = tbb::blocked_range<std::size_t>;

// One step of averaging over each vertex' star, weighted by area.
std::vector<double> averaged(const SurfaceMesh& mesh, const std::vector<double>& area,
                             const std::vector<double>& values) {
  std::vector<double> sum(values.size(), 0);
  std::vector<double> weight(values.size(), 0);
  for (std::size_t f = 0; f < area.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    const double mean = (values[t[0]] + values[t[1]] + values[t[2]]) / 3;
    for (const std::uint32_t v : t) {
      sum[v] += area[f] * mean;
      weight[v] += area[f];
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v) {
    if (weight[v] > 0) sum[v] /= weight[v];
  }
  return sum;
}

}  // namespace

std::vector<double> error_factors(const SurfaceMesh& mesh, const ReferenceSurface& scan, double exponent,
                                  double least) {
  const MeshAdjacency adjacency(mesh);
  const VertexStars& stars = adjacency.stars;
  const std::vector<Triangle>& neighbours = adjacency.neighbours;
  const std::vector<Vec3> normals = face_normals(mesh);
  const WalkableMesh on{mesh, stars, neighbours, normals};
  const double edge = scan.mean_edge(mesh.triangles.size());
  const std::vector<std::uint32_t> nearest = nearest_vertices(scan.mesh.vertices, scan.vertex_normals, mesh, edge);
  std::vector<Location> location(scan.mesh.vertices.size());
  tbb::parallel_for(Range(0, location.size(), 1024), [&](const Range& range) {
    for (std::size_t v = range.begin(); v < range.end(); ++v) {
      location[v] = locate(on, {scan.mesh.vertices[v], scan.vertex_normals[v], 0},
                           stars.corners(nearest[v]).front() / 3, 0.2 * edge);
    }
  });

  // Squared distance by mesh vertex: the scan vertices' own areas, spread over the corners of the face they lie on.
  std::vector<double> scan_area(scan.mesh.vertices.size(), 0);
  for (const Triangle& t : scan.mesh.triangles) {
    for (const std::uint32_t v : t) scan_area[v] += area_vector(scan.mesh, t).norm() / 6;
  }
  std::vector<double> squared(mesh.vertices.size(), 0);
  std::vector<double> weight(mesh.vertices.size(), 0);
  double total = 0;
  for (std::size_t v = 0; v < location.size(); ++v) {
    const double d = (scan.mesh.vertices[v] - point_at(mesh, location[v])).squaredNorm() * scan_area[v];
    total += d;
    const Triangle& t = mesh.triangles[location[v].face];
    for (std::size_t k = 0; k < 3; ++k) {
      squared[t[k]] += location[v].barycentric[k] * d;
      weight[t[k]] += location[v].barycentric[k] * scan_area[v];
    }
  }
  const double mean = total / scan.area;
  for (std::size_t v = 0; v < squared.size(); ++v) squared[v] = weight[v] > 0 ? squared[v] / weight[v] : mean;
  std::vector<double> area(mesh.triangles.size());
  for (std::size_t f = 0; f < area.size(); ++f) area[f] = area_vector(mesh, mesh.triangles[f]).norm() / 2;
  for (int ring = 0; ring < 2; ++ring) squared = averaged(mesh, area, squared);

  std::vector<double> factors(location.size());
  for (std::size_t v = 0; v < factors.size(); ++v) {
    const Triangle& t = mesh.triangles[location[v].face];
    double local = 0;
    for (std::size_t k = 0; k < 3; ++k) local += location[v].barycentric[k] * squared[t[k]];
    // Squares of distances: half of the exponent.
    const double ratio = mean > 0 ? local / mean : 1;
    factors[v] = std::clamp(std::pow(std::max(ratio, 1e-12), -0.5 * exponent), least, 1 / least);
  }
  return factors;
}

}  // namespace scan2fea
