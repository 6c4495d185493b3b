#include "preproc/surface/local_refinement.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/locate.hpp"
#include "preproc/surface/nearest_vertices.hpp"
#include "preproc/surface/refinement_patch.hpp"
#include "quality/deviation_bound.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace scan2fea {
namespace {

// Around a place: with fewer rings the rim holds what should move, with more the fit costs more.
constexpr int rings_of_patch = 1;
constexpr int most_rings = 3;
// Of the limit: what rounding and the exact volume's shift may take.
constexpr double reserve = 0.01;

struct Place {
  std::uint32_t face;  // of the mesh
  double deviation;
};

// Faces that are too far or to which the scan is, the worst first.
std::vector<Place> places_beyond(const SurfaceMesh& mesh, const ReferenceSurface& scan, const DeviationBound& bound,
                                 double limit, double edge) {
  std::vector<double> deviation(mesh.triangles.size(), 0);
  for (std::size_t f = 0; f < deviation.size(); ++f) deviation[f] = bound.to_reference.upper[f];

  std::vector<std::uint32_t> scan_faces;
  std::vector<Vec3> points, normals;
  for (std::uint32_t f = 0; f < scan.mesh.triangles.size(); ++f) {
    if (bound.to_mesh.upper[f] <= limit) continue;
    scan_faces.push_back(f);
    points.push_back(bound.to_mesh.farthest[f]);
    normals.push_back(scan.face_normals[f]);
  }
  const VertexStars stars(mesh);
  const std::vector<Triangle> neighbours = face_neighbours(mesh, stars);
  const std::vector<Vec3> face_normals_of_mesh = face_normals(mesh);
  const WalkableMesh on{mesh, stars, neighbours, face_normals_of_mesh};
  const std::vector<std::uint32_t> start = nearest_vertices(points, normals, mesh, edge);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t f =
        descend_to_nearest(on, {points[i], normals[i], 0}, stars.corners(start[i]).front() / 3).face;
    deviation[f] = std::max(deviation[f], bound.to_mesh.upper[scan_faces[i]]);
  }

  std::vector<Place> places;
  for (std::uint32_t f = 0; f < deviation.size(); ++f)
    if (deviation[f] > limit) places.push_back({f, deviation[f]});
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& a, const Place& b) { return a.deviation > b.deviation; });
  return places;
}

bool apart(const BoundingBox& a, const BoundingBox& b) {
  return (a.low.array() > b.high.array()).any() || (b.low.array() > a.high.array()).any();
}

// Those at once that are apart from each other, until each has had its turn. Returns whether any came nearer.
bool mend(SurfaceMesh& mesh, const SearchedScan& scan, std::vector<Place> places, int rings, const PatchGoal& goal,
          std::size_t most_vertices, LocalRefinementResult& result) {
  const std::size_t before = result.patches;
  while (!places.empty()) {
    const VertexStars stars(mesh);
    std::vector<RefinementPatch> batch;
    std::vector<Place> later;
    for (const Place& place : places) {
      RefinementPatch patch(mesh, stars, place.face, rings, 1.1 * place.deviation + 0.3 * goal.edge);
      const bool is_apart = std::all_of(batch.begin(), batch.end(),
                                        [&](const RefinementPatch& other) { return apart(patch.box(), other.box()); });
      if (is_apart)
        batch.push_back(std::move(patch));
      else
        later.push_back(place);
    }
    // What is left may all be used up by one of them: then a few vertices more than allowed would come together.
    PatchGoal part = goal;
    part.most_vertices = most_vertices > result.inserted ? most_vertices - result.inserted : 0;
    if (part.most_vertices < 6 * batch.size()) part.most_vertices /= batch.size();
    std::vector<char> improved(batch.size());
    tbb::parallel_for(std::size_t{0}, batch.size(),
                      [&](std::size_t i) { improved[i] = batch[i].improve(mesh, scan, part) ? 1 : 0; });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (!improved[i]) continue;
      batch[i].write(mesh);
      result.inserted += batch[i].inserted();
      ++result.patches;
    }
    places = std::move(later);
  }
  return result.patches > before;
}

}  // namespace

LocalRefinementResult refine_within(SurfaceMesh& mesh, const ReferenceSurface& scan,
                                    const LocalRefinementOptions& options, const Progress& progress) {
  if (!(options.limit > 0) || !(options.least_angle_deg >= 0 && options.least_angle_deg < 60) || options.rounds < 1)
    throw WrongUsage({.what = "local refinement's options out of range",
                      .where = {},
                      .value = "limit " + std::to_string(options.limit) + ", " +
                               std::to_string(options.least_angle_deg) + " degrees, " + std::to_string(options.rounds) +
                               " rounds",
                      .limit = "above 0, 0 to 60 degrees, at least 1 round",
                      .advice = {}});
  const TriangleTree tree(scan.mesh);
  const double edge = std::sqrt(4 / std::numbers::sqrt3 * scan.area / static_cast<double>(mesh.triangles.size()));
  PatchGoal goal;
  goal.limit = (1 - reserve) * options.limit;
  goal.fidelity = options.fidelity_of_diagonal * scan.diagonal;
  goal.least_angle_deg = options.least_angle_deg;
  goal.edge = edge;
  LocalRefinementResult result;
  int rings = rings_of_patch;
  for (int round = 0; round < options.rounds && rings <= most_rings; ++round) {
    progress("local refinement", static_cast<double>(round) / options.rounds);
    const DeviationBound bound = bound_deviation(mesh, scan.mesh, tree, {.limit = goal.limit});
    result.deviation_before_last_round = bound.upper();
    if (result.deviation_before_last_round <= goal.limit) break;
    const std::vector<Place> places = places_beyond(mesh, scan, bound, goal.limit, edge);
    if (!mend(mesh, {scan, tree}, places, rings, goal, options.most_vertices, result)) ++rings;
  }
  return result;
}

}  // namespace scan2fea
