// feature_distance PART RESULT: how far the feature edges of PART are from those of RESULT, at most, as JSON. Edges of
// PART whose faces' normals differ by 40 degrees or more and its borders, sampled finely; of RESULT by more than 25,
// since its triangles bend creases a little.
#include "preproc/mesh/read_surface.hpp"
#include "preproc/surface/adjacency.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <numbers>
#include <vector>

namespace {

using namespace scan2fea;
using Segment = std::array<Vec3, 2>;

std::vector<Segment> feature_edges(const SurfaceMesh& mesh, double angle_deg) {
  const double cosine = std::cos(angle_deg * std::numbers::pi / 180);
  const std::vector<Vec3> normals = face_normals(mesh);
  const std::vector<Triangle> neighbours = face_neighbours(mesh, VertexStars(mesh));
  std::vector<Segment> edges;
  for (std::uint32_t f = 0; f < normals.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t g = neighbours[f][k];
      if (g != no_face && (g < f || normals[f].dot(normals[g]) > cosine)) continue;
      const Triangle& t = mesh.triangles[f];
      edges.push_back({mesh.vertices[t[(k + 1) % 3]], mesh.vertices[t[(k + 2) % 3]]});
    }
  return edges;
}

double squared_distance(const Vec3& p, const Segment& s) {
  const Vec3 d = s[1] - s[0];
  const double dd = d.squaredNorm();
  const double t = dd > 0 ? std::clamp(d.dot(p - s[0]) / dd, 0.0, 1.0) : 0;
  return (p - s[0] - t * d).squaredNorm();
}

double farthest(const std::vector<Segment>& from, const std::vector<Segment>& to, double spacing) {
  double farthest = 0;
  for (const Segment& s : from) {
    const double pieces = std::max(1.0, std::ceil((s[1] - s[0]).norm() / spacing));
    for (double i = 0; i <= pieces; ++i) {
      const Vec3 p = s[0] + i / pieces * (s[1] - s[0]);
      double nearest = std::numeric_limits<double>::infinity();
      for (const Segment& other : to) {
        nearest = std::min(nearest, squared_distance(p, other));
        if (nearest <= farthest) break;  // it will not be the farthest
      }
      farthest = std::max(farthest, nearest);
    }
  }
  return std::sqrt(farthest);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: feature_distance PART RESULT\n");
    return 2;
  }
  try {
    const SurfaceMesh part = read_surface(argv[1]), result = read_surface(argv[2]);
    const double diagonal = bounding_box(part.vertices).diagonal();
    const std::vector<Segment> of_part = feature_edges(part, 40), of_result = feature_edges(result, 25);
    const double distance = farthest(of_part, of_result, diagonal / 2000);
    // JSON knows no infinity: a result without any feature is a whole diagonal away.
    std::printf("{\"feature_edges\": %zu, \"farthest_pct_diagonal\": %.6g}\n", of_part.size(),
                100 * (std::isfinite(distance) ? distance / diagonal : 1));
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "feature_distance: %s\n", e.what());
    return 1;
  }
}
