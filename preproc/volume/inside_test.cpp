#include "preproc/volume/inside_test.hpp"

#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace scan2fea {
namespace {

struct Edge {
  std::uint32_t low, high, triangle, opposite;
};

std::vector<Edge> sorted_edges(const SurfaceMesh& surface) {
  std::vector<Edge> edges;
  edges.reserve(surface.triangles.size() * 3);
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(surface.triangles[t][(k + 1) % 3], surface.triangles[t][(k + 2) % 3]);
      edges.push_back({low, high, t, k});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return edges;
}

}  // namespace

InsideTest::InsideTest(const SurfaceMesh& surface)
    : surface_(surface),
      tree_(surface),
      edge_normals_(surface.triangles.size(), {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}),
      vertex_normals_(surface.vertices.size(), Vec3::Zero()) {
  std::vector<Vec3> normals;
  normals.reserve(surface.triangles.size());
  for (const Triangle& t : surface.triangles) normals.push_back(area_vector(surface, t).normalized());

  const std::vector<Edge> edges = sorted_edges(surface);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i;
    Vec3 sum = Vec3::Zero();
    for (; j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high; ++j)
      sum += normals[edges[j].triangle];
    for (; i < j; ++i) edge_normals_[edges[i].triangle][edges[i].opposite] = sum;
  }
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Triangle& corners = surface.triangles[t];
      const Vec3 u = surface.vertices[corners[(k + 1) % 3]] - surface.vertices[corners[k]];
      const Vec3 v = surface.vertices[corners[(k + 2) % 3]] - surface.vertices[corners[k]];
      vertex_normals_[corners[k]] += angle_between(u, v) * normals[t];
    }
}

InsideTest::Answer InsideTest::operator()(const Vec3& p, std::uint32_t hint) const {
  const ClosestPoint nearest = tree_.closest(p, hint);
  const Triangle& t = surface_.triangles[nearest.triangle];
  const Vec3 normal = area_vector(surface_, t);
  // Barycentric coordinates of the nearest point tell whether it is on the face, an edge or a vertex.
  constexpr double rounding = 1e-9;
  int on_edges = 0;
  std::array<bool, 3> zero;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &b = surface_.vertices[t[(k + 1) % 3]], &c = surface_.vertices[t[(k + 2) % 3]];
    zero[k] = (c - b).cross(nearest.point - b).dot(normal) <= rounding * normal.squaredNorm();
    on_edges += zero[k];
  }
  Vec3 pseudonormal = normal;
  for (std::size_t k = 0; k < 3; ++k) {
    if (on_edges == 1 && zero[k]) pseudonormal = edge_normals_[nearest.triangle][k];
    if (on_edges >= 2 && !zero[k]) pseudonormal = vertex_normals_[t[k]];
  }
  return {std::sqrt(nearest.squared_distance), pseudonormal.dot(p - nearest.point) < 0, nearest.triangle};
}

}  // namespace scan2fea
