#include "preproc/surface/features.hpp"

#include "preproc/surface/adjacency.hpp"
#include "preproc/surface/feature_chains.hpp"
#include "preproc/surface/normal_filter.hpp"
#include "preproc/surface/scan_noise.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

// Noise above this share of the mean edge length tilts faces by about 3°, and by more than 10° one in a hundred.
constexpr double noise_to_filter = 0.01;

double mean_edge_length(const SurfaceMesh& scan) {
  double sum = 0;
  for (const Triangle& t : scan.triangles)
    for (std::size_t k = 0; k < 3; ++k) sum += (scan.vertices[t[k]] - scan.vertices[t[(k + 1) % 3]]).norm();
  return scan.triangles.empty() ? 0 : sum / (3 * static_cast<double>(scan.triangles.size()));
}

// The manifold interior edges, sorted, with the angles between their faces' normals.
std::vector<CreaseEdge> interior_edges(const SurfaceMesh& scan, const std::vector<Triangle>& neighbours,
                                       const std::vector<Vec3>& normals) {
  std::vector<CreaseEdge> edges;
  for (std::uint32_t f = 0; f < scan.triangles.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t g = neighbours[f][k];
      if (g == no_face || g < f) continue;
      const auto [low, high] = std::minmax(scan.triangles[f][(k + 1) % 3], scan.triangles[f][(k + 2) % 3]);
      const double angle = std::atan2(normals[f].cross(normals[g]).norm(), normals[f].dot(normals[g]));
      edges.push_back({{low, high}, angle * (180 / std::numbers::pi)});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const CreaseEdge& a, const CreaseEdge& b) { return a.ends < b.ends; });
  return edges;
}

}  // namespace

Features find_features(const SurfaceMesh& scan, const FeatureOptions& options) {
  const VertexStars stars(scan);
  const std::vector<Triangle> neighbours = face_neighbours(scan, stars);
  Features result;
  result.noise = estimate_noise(scan, stars);
  if (!options.angle_deg) return result;

  std::vector<Vec3> normals = face_normals(scan);
  const bool noisy = result.noise > noise_to_filter * mean_edge_length(scan);
  if (noisy) filter_normals(scan, stars, normals);

  const double shortest = options.shortest_chain_of_diagonal * bounding_box(scan.vertices).diagonal();
  CreaseChains chains(scan, interior_edges(scan, neighbours, normals));
  chains.mark_above(*options.angle_deg);
  chains.continue_ends(std::min(options.continuation_angle_deg, *options.angle_deg));
  chains.drop_short(shortest, noisy);
  result.edges = chains.marked();
  return result;
}

}  // namespace scan2fea
