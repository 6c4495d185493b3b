// feature_figures PART RESULT, as JSON: how far the feature edges of PART are from those of RESULT, at most, and the
// smallest angle of RESULT that is not between two feature edges, which the part would have given. Feature edges: of
// PART borders and edges whose faces' normals differ by 40 degrees or more, sampled finely; of RESULT by more than 25,
// since its triangles bend creases a little.
#include "preproc/mesh/read_surface.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <numbers>
#include <set>
#include <vector>

namespace {

using namespace scan2fea;
using Segment = std::array<Vec3, 2>;
using IsFeature = std::vector<std::array<bool, 3>>;  // per face: its edge opposite corner k

IsFeature find_feature_edges(const SurfaceMesh& mesh, double angle_deg) {
  const double cosine = std::cos(angle_deg * std::numbers::pi / 180);
  const std::vector<Vec3> normals = face_normals(mesh);
  const std::vector<Triangle> neighbours = face_neighbours(mesh, VertexStars(mesh));
  IsFeature is_feature(mesh.triangles.size());
  for (std::size_t f = 0; f < is_feature.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t g = neighbours[f][k];
      is_feature[f][k] = g == no_face || normals[f].dot(normals[g]) <= cosine;
    }
  return is_feature;
}

std::vector<Segment> segments(const SurfaceMesh& mesh, const IsFeature& is_feature) {
  std::set<FeatureEdge> edges;  // most are seen from two faces
  for (std::size_t f = 0; f < is_feature.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const Triangle& t = mesh.triangles[f];
      if (is_feature[f][k]) edges.insert(feature_edge(t[(k + 1) % 3], t[(k + 2) % 3]));
    }
  std::vector<Segment> result;
  for (const auto& [a, b] : edges) result.push_back({mesh.vertices[a], mesh.vertices[b]});
  return result;
}

double smallest_angle_beside_features_deg(const SurfaceMesh& mesh, const IsFeature& is_feature) {
  double smallest = 60;
  for (std::size_t f = 0; f < is_feature.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      if (is_feature[f][(k + 1) % 3] && is_feature[f][(k + 2) % 3]) continue;
      const Triangle& t = mesh.triangles[f];
      const Vec3 a = mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]];
      const Vec3 b = mesh.vertices[t[(k + 2) % 3]] - mesh.vertices[t[k]];
      smallest = std::min(smallest, std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi);
    }
  return smallest;
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
    std::fprintf(stderr, "usage: feature_figures PART RESULT\n");
    return 2;
  }
  try {
    const SurfaceMesh part = read_surface(argv[1]), result = read_surface(argv[2]);
    const double diagonal = bounding_box(part.vertices).diagonal();
    const IsFeature features = find_feature_edges(result, 25);
    const double distance =
        farthest(segments(part, find_feature_edges(part, 40)), segments(result, features), diagonal / 2000);
    // JSON knows no infinity: a result without any feature is a whole diagonal away.
    std::printf("{\"farthest_pct_diagonal\": %.6g, \"smallest_angle_beside_features_deg\": %.6g}\n",
                100 * (std::isfinite(distance) ? distance / diagonal : 1),
                smallest_angle_beside_features_deg(result, features));
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "feature_figures: %s\n", e.what());
    return 1;
  }
}
