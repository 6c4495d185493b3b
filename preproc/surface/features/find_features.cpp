#include "preproc/surface/features/find_features.hpp"

#include "preproc/surface/features/crease_support.hpp"
#include "preproc/surface/features/feature_chains.hpp"
#include "preproc/surface/features/normal_filter.hpp"
#include "preproc/surface/features/scan_noise.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

// Noise above this share of the mean edge length tilts faces by about 1.5°: more than the creases of organic scans
// bear.
constexpr double noise_to_filter = 0.005;

// A small loop or net whose edges are sharper than this times the limit, in the mean, is a small part's: 70°.
constexpr double sharper_than_noise = 1.75;

// Noise flattens some edges of a crease, but not all of them in a row, to below this share of the limit.
constexpr double near_crease_of_angle = 0.6;

// The share of a weak crease's angle that the filter leaves.
constexpr double continuation_left_by_filter = 0.75;

double angle_deg(const Vec3& a, const Vec3& b) {
  return angle_between(a, b) * (180 / std::numbers::pi);
}

// Faces within three rings of an edge that is sharper than the angle.
std::vector<std::uint32_t> faces_near_sharp_edges(const SurfaceMesh& scan, const VertexStars& stars,
                                                  const std::vector<Triangle>& neighbours,
                                                  const std::vector<Vec3>& normals, double above_deg) {
  const double cosine = std::cos(above_deg * std::numbers::pi / 180);
  std::vector<char> near(scan.triangles.size(), 0);
  std::vector<std::uint32_t> faces;
  const auto add = [&](std::uint32_t f) {
    if (!near[f]) faces.push_back(f);
    near[f] = 1;
  };
  for (std::uint32_t f = 0; f < near.size(); ++f)
    for (const std::uint32_t g : neighbours[f])
      if (g != no_face && normals[f].dot(normals[g]) < cosine) add(f);
  std::size_t ring_begin = 0;
  for (int ring = 0; ring < 3; ++ring) {
    const std::size_t ring_end = faces.size();
    for (; ring_begin < ring_end; ++ring_begin)
      for (const std::uint32_t v : scan.triangles[faces[ring_begin]])
        for (const std::uint32_t c : stars.corners(v)) add(c / 3);
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

// Those of the interior edges that are sharper than the angle, sorted; continuations are judged by whichever of both
// sets of normals tells more.
std::vector<CreaseEdge> crease_edges(const SurfaceMesh& scan, const std::vector<Triangle>& neighbours,
                                     const std::vector<Vec3>& normals, const std::vector<Vec3>& finer_normals,
                                     double above_deg) {
  const double cosine = std::cos(above_deg * std::numbers::pi / 180);
  std::vector<CreaseEdge> edges;
  for (std::uint32_t f = 0; f < scan.triangles.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t g = neighbours[f][k];
      if (g == no_face || g < f) continue;
      if (normals[f].dot(normals[g]) >= cosine && finer_normals[f].dot(finer_normals[g]) >= cosine) continue;
      const auto [low, high] = std::minmax(scan.triangles[f][(k + 1) % 3], scan.triangles[f][(k + 2) % 3]);
      const double angle = angle_deg(normals[f], normals[g]);
      edges.push_back({{low, high}, angle, std::max(angle, angle_deg(finer_normals[f], finer_normals[g]))});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const CreaseEdge& a, const CreaseEdge& b) { return a.ends < b.ends; });
  return edges;
}

}  // namespace

Features find_features(const SurfaceMesh& scan, const FeatureOptions& options) {
  const MeshAdjacency adjacency(scan);
  const VertexStars& stars = adjacency.stars;
  const std::vector<Triangle>& neighbours = adjacency.neighbours;
  Features result;
  result.noise = estimate_noise(scan, adjacency);
  if (!options.angle_deg) return result;

  double continuation_deg = std::min(options.continuation_angle_deg, *options.angle_deg);
  std::vector<Vec3> normals = face_normals(scan);
  std::vector<Vec3> finer_normals = normals;
  const bool noisy = result.noise > noise_to_filter * mean_edge_length(scan);
  if (noisy) {
    // Normals that are filtered strongly tell sharp edges from noise; those that are filtered less still show the weak
    // ones, where chains tell which to believe.
    continuation_deg *= continuation_left_by_filter;
    const NormalFilter filter(
        scan, stars,
        faces_near_sharp_edges(scan, stars, neighbours, normals, near_crease_of_angle * *options.angle_deg));
    filter.apply(normals, {.passes = 5, .same_side_deg = 20});
    filter.apply(finer_normals, {.passes = 5, .same_side_deg = 10});
  }

  CreaseChains chains(scan, neighbours, crease_edges(scan, neighbours, normals, finer_normals, continuation_deg));
  chains.mark_above(*options.angle_deg);
  chains.continue_ends(continuation_deg);
  const double shortest = options.shortest_chain_of_diagonal * bounding_box(scan.vertices).diagonal();
  chains.drop_free_ends(shortest);
  if (noisy) chains.drop_small_nets(shortest, sharper_than_noise * *options.angle_deg);
  JudgedCreases judged = judge_creases({scan, neighbours, face_normals(scan), result.noise}, chains.marked());
  result.edges = std::move(judged.kept);
  result.dropped = std::move(judged.dropped);
  return result;
}

}  // namespace scan2fea
