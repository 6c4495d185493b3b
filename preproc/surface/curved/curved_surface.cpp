#include "preproc/surface/curved/curved_surface.hpp"

#include <algorithm>
#include <utility>

namespace scan2fea {
namespace {

// Symmetric, exact for polynomials of degree four (Dunavant, "High degree efficient symmetrical Gaussian quadrature
// rules for the triangle", 1985): the enclosed volume's integrand, x . (x_u x x_v), is of that degree. Weights sum to
// one.
struct QuadraturePoint {
  std::array<double, 3> barycentric;
  double weight;
};
constexpr double a1 = 0.445948490915965, w1 = 0.223381589678011, a2 = 0.091576213509771, w2 = 0.109951743655322;
constexpr std::array<QuadraturePoint, 6> degree_four{{{{1 - 2 * a1, a1, a1}, w1},
                                                      {{a1, 1 - 2 * a1, a1}, w1},
                                                      {{a1, a1, 1 - 2 * a1}, w1},
                                                      {{1 - 2 * a2, a2, a2}, w2},
                                                      {{a2, 1 - 2 * a2, a2}, w2},
                                                      {{a2, a2, 1 - 2 * a2}, w2}}};

}  // namespace

CurvedSurface::CurvedSurface(SurfaceMesh surface) : corners(std::move(surface)), mid_of_face(corners.triangles.size()) {
  for (const Triangle& t : corners.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(feature_edge(t[k], t[(k + 1) % 3]));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (std::size_t f = 0; f < mid_of_face.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const Triangle& t = corners.triangles[f];
      const auto at = std::lower_bound(edges.begin(), edges.end(), feature_edge(t[k], t[(k + 1) % 3]));
      mid_of_face[f][k] = static_cast<std::uint32_t>(at - edges.begin());
    }
  mid.resize(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) mid[e] = middle(e);
}

Vec3 CurvedSurface::middle(std::size_t edge) const {
  return (corners.vertices[edges[edge][0]] + corners.vertices[edges[edge][1]]) / 2;
}

std::array<std::size_t, 6> CurvedSurface::nodes_of(std::size_t face) const {
  const Triangle &t = corners.triangles[face], &e = mid_of_face[face];
  const std::size_t first = corners.vertices.size();
  return {t[0], t[1], t[2], first + e[0], first + e[1], first + e[2]};
}

SixNodeTriangle CurvedSurface::triangle(std::size_t face) const {
  const Triangle &t = corners.triangles[face], &e = mid_of_face[face];
  return {corners.vertices[t[0]], corners.vertices[t[1]], corners.vertices[t[2]], mid[e[0]], mid[e[1]], mid[e[2]]};
}

double curved_volume(const CurvedSurface& surface, const std::vector<std::uint32_t>& faces, const Vec3& centre) {
  double six_volumes = 0;
  for (const std::uint32_t f : faces) {
    SixNodeTriangle x = surface.triangle(f);
    for (Vec3& p : x) p -= centre;
    for (const QuadraturePoint& q : degree_four) {
      const auto [u, v] = tangents(x, q.barycentric);
      six_volumes += q.weight * point_on(x, q.barycentric).dot(u.cross(v));
    }
  }
  return six_volumes / 6;
}

void add_volume_gradient(const CurvedSurface& surface, const std::vector<std::uint32_t>& faces,
                         std::vector<Vec3>& gradient) {
  for (const std::uint32_t f : faces) {
    const SixNodeTriangle x = surface.triangle(f);
    const std::array<std::size_t, 6> nodes = surface.nodes_of(f);
    for (const QuadraturePoint& q : degree_four) {
      const auto [u, v] = tangents(x, q.barycentric);
      const Vec3 area = q.weight / 2 * u.cross(v);
      const std::array<double, 6> share = shape_functions(q.barycentric);
      for (std::size_t i = 0; i < 6; ++i) gradient[nodes[i]] += share[i] * area;
    }
  }
}

SurfaceMesh in_four(const CurvedSurface& surface) {
  SurfaceMesh fine{surface.corners.vertices, {}};
  fine.vertices.insert(fine.vertices.end(), surface.mid.begin(), surface.mid.end());
  fine.triangles.reserve(4 * surface.corners.triangles.size());
  for (std::size_t f = 0; f < surface.corners.triangles.size(); ++f) {
    const auto n = surface.nodes_of(f);
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
      fine.triangles.push_back(
          {static_cast<std::uint32_t>(n[a]), static_cast<std::uint32_t>(n[b]), static_cast<std::uint32_t>(n[c])});
    };
    add(0, 3, 5);
    add(1, 4, 3);
    add(2, 5, 4);
    add(3, 4, 5);
  }
  return fine;
}

std::array<double, 3> in_whole(std::size_t quarter, const std::array<double, 3>& b) {
  switch (quarter) {
    case 0:
      return {b[0] + (b[1] + b[2]) / 2, b[1] / 2, b[2] / 2};
    case 1:
      return {b[2] / 2, b[0] + (b[1] + b[2]) / 2, b[1] / 2};
    case 2:
      return {b[1] / 2, b[2] / 2, b[0] + (b[1] + b[2]) / 2};
    default:
      return {(b[0] + b[2]) / 2, (b[0] + b[1]) / 2, (b[1] + b[2]) / 2};
  }
}

}  // namespace scan2fea
