#include "preproc/surface/mending/local_refinement.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/kernel/locate.hpp"
#include "preproc/surface/kernel/nearest.hpp"
#include "preproc/surface/kernel/parallel_blocks.hpp"
#include "preproc/surface/mending/refinement_patch.hpp"
#include "quality/deviation_bound.hpp"
#include "quality/face_blocks.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace scan2fea {
namespace {

// Rings of faces around a place: with fewer the rim holds what should move, with more the fit costs more.
constexpr int fewest_rings = 1;
constexpr int most_rings = 3;
// So many vertices of the scan are asked for their distance: more of a dense scan tell little more.
constexpr std::size_t most_vertices_per_face = 6;
// The part of the limit that is kept free for the exact volume's shift.
constexpr double reserve = 0.01;
// Where nothing helps, smaller angles are allowed, so often and by so much each time; then all is tried from the start
// again, since what has changed around gives other ways, until nothing changes any more.
constexpr int most_yielding = 3;
constexpr double yielding_deg = 8;

struct Place {
  std::uint32_t face;  // of the mesh
  double deviation;
};

void check(const LocalRefinementOptions& options) {
  if (!(options.limit > 0) || !(options.least_angle_deg >= 0 && options.least_angle_deg < 60) || options.rounds < 1 ||
      options.most_places < 1)
    throw WrongUsage({.what = "local refinement's options out of range",
                      .where = {},
                      .value = "limit " + std::to_string(options.limit) + ", " +
                               std::to_string(options.least_angle_deg) + " degrees, " + std::to_string(options.rounds) +
                               " rounds",
                      .limit = "above 0, 0 to 60 degrees, at least 1 round",
                      .advice = {}});
}

// The deviation that is worked towards.
double goal_limit(const LocalRefinementOptions& options) {
  return (1 - reserve) * options.limit;
}

// Points of the scan that are too far from the surface.
struct FarPoints {
  std::vector<Vec3> points, normals;
  std::vector<double> distances;

  void add(const Vec3& point, const Vec3& normal, double distance) {
    points.push_back(point);
    normals.push_back(normal);
    distances.push_back(distance);
  }
};

// Raises the deviation of the faces to which the points belong.
void attribute(const FarPoints& far, const SurfaceMesh& mesh, double edge, std::vector<double>& deviation) {
  const MeshAdjacency adjacency(mesh);
  const VertexStars& stars = adjacency.stars;
  const std::vector<Triangle>& neighbours = adjacency.neighbours;
  const std::vector<Vec3> normals = face_normals(mesh);
  const WalkableMesh on{mesh, stars, neighbours, normals};
  const std::vector<std::uint32_t> start = nearest_vertices(far.points, far.normals, mesh, edge);
  for (std::size_t i = 0; i < start.size(); ++i) {
    const std::uint32_t first = stars.corners(start[i]).front() / 3;
    const std::uint32_t f = descend_to_nearest(on, {far.points[i], far.normals[i], 0}, first).face;
    deviation[f] = std::max(deviation[f], far.distances[i]);
  }
}

FarPoints far_vertices(const SurfaceMesh& mesh, const ReferenceSurface& scan, double limit) {
  const std::size_t count = scan.mesh.vertices.size();
  const std::size_t step = 1 + count / (most_vertices_per_face * mesh.triangles.size());
  const TriangleTree tree(mesh);
  std::vector<double> distances((count + step - 1) / step);
  for_each_block(distances.size(), [&](std::size_t first, std::size_t last) {
    std::uint32_t hint = tree.leaf_order().front();
    for (std::size_t i = first; i < last; ++i) {
      const ClosestPoint nearest = tree.closest(scan.mesh.vertices[i * step], hint);
      hint = nearest.triangle;
      distances[i] = std::sqrt(nearest.squared_distance);
    }
  });
  FarPoints far;
  for (std::size_t i = 0; i < distances.size(); ++i)
    if (distances[i] > limit) far.add(scan.mesh.vertices[i * step], scan.vertex_normals[i * step], distances[i]);
  return far;
}

// The worst first.
std::vector<Place> places_beyond(const std::vector<double>& deviation, double limit) {
  std::vector<Place> places;
  for (std::uint32_t f = 0; f < deviation.size(); ++f)
    if (deviation[f] > limit) places.push_back({f, deviation[f]});
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& a, const Place& b) { return a.deviation > b.deviation; });
  return places;
}

// Per patch the faces of the scan in its box. A scan may have millions: whole blocks of them are told to be far away
// by one box, since neighbours in a file are mostly neighbours in space.
std::vector<std::vector<std::uint32_t>> scan_faces_near(const SurfaceMesh& scan,
                                                        const std::vector<RefinementPatch>& patches) {
  using Hits = std::vector<std::pair<std::uint32_t, std::uint32_t>>;  // patch, face
  std::vector<Hits> hits(parallel_block_count(scan.triangles.size()));
  for_each_block(scan.triangles.size(), [&](std::size_t first, std::size_t last) {
    std::vector<BoundingBox> boxes(last - first);
    BoundingBox all = box_of_face(scan, static_cast<std::uint32_t>(first));
    for (std::size_t f = first; f < last; ++f) {
      boxes[f - first] = box_of_face(scan, static_cast<std::uint32_t>(f));
      all.low = all.low.cwiseMin(boxes[f - first].low);
      all.high = all.high.cwiseMax(boxes[f - first].high);
    }
    for (std::size_t p = 0; p < patches.size(); ++p) {
      if (!boxes_meet(all, patches[p].box())) continue;
      for (std::size_t f = first; f < last; ++f)
        if (boxes_meet(boxes[f - first], patches[p].box()))
          hits[first / parallel_block_size].emplace_back(static_cast<std::uint32_t>(p), static_cast<std::uint32_t>(f));
    }
  });
  std::vector<std::vector<std::uint32_t>> near(patches.size());
  for (const Hits& block : hits)
    for (const auto& [p, f] : block) near[p].push_back(f);
  return near;
}

// Mends places that are apart from each other at once, until each has had its turn or lay within the patch of another,
// which then stood for it. Returns those whose patches are still too far.
std::vector<Place> mend(SurfaceMesh& mesh, FeatureNet& net, const ReferenceSurface& scan, std::vector<Place> places,
                        int rings, const PatchGoal& goal, const LocalRefinementOptions& options,
                        LocalRefinementResult& result) {
  std::vector<Place> left;
  std::vector<bool> covered;
  while (!places.empty()) {
    covered.resize(mesh.triangles.size(), false);
    const VertexStars stars(mesh);
    const std::vector<LineEdge> lines = line_edges(net);
    std::vector<RefinementPatch> batch;
    std::vector<Place> taken, later;
    for (const Place& place : places) {
      if (covered[place.face]) continue;
      RefinementPatch patch(mesh, stars, place.face, rings, place.deviation, lines);
      const bool is_apart = std::none_of(batch.begin(), batch.end(), [&](const RefinementPatch& other) {
        return boxes_meet(patch.box(), other.box());
      });
      (is_apart ? taken : later).push_back(place);
      if (!is_apart) continue;
      for (const std::uint32_t f : patch.faces()) covered[f] = true;
      batch.push_back(std::move(patch));
    }
    if (batch.empty()) break;
    // The whole scan: cut along its creases, it has no side beyond them that a face next to one could agree with.
    const std::vector<std::vector<std::uint32_t>> scan_faces = scan_faces_near(scan.whole, batch);
    PatchGoal part = goal;
    part.most_vertices = (options.most_vertices - std::min(options.most_vertices, result.inserted)) / batch.size();
    std::vector<PatchOutcome> outcomes(batch.size());
    tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
      outcomes[i] = batch[i].improve(mesh, scan.whole, scan_faces[i], net, part);
    });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (!outcomes[i].reached) left.push_back(taken[i]);
      if (!outcomes[i].improved) continue;
      batch[i].write(mesh, net);
      result.inserted += batch[i].inserted();
      ++result.patches;
    }
    places = std::move(later);
  }
  return left;
}

LocalRefinementResult refine_places(SurfaceMesh& mesh, FeatureNet& net, const ReferenceSurface& scan,
                                    const std::vector<double>& deviation, const LocalRefinementOptions& options) {
  PatchGoal goal;
  goal.limit = goal_limit(options);
  goal.fidelity = options.fidelity_of_diagonal * scan.diagonal;
  goal.least_angle_deg = options.least_angle_deg;
  std::vector<Place> places = places_beyond(deviation, goal.limit);
  LocalRefinementResult result;
  for (int rings = fewest_rings; rings <= most_rings && !places.empty(); ++rings)
    places = mend(mesh, net, scan, std::move(places), rings, goal, options, result);
  return result;
}

}  // namespace

LocalRefinementResult refine_worst(SurfaceMesh& mesh, const ReferenceSurface& scan, std::vector<double> deviation,
                                   const LocalRefinementOptions& options, const Progress& progress) {
  check(options);
  progress("local refinement", 0);
  attribute(far_vertices(mesh, scan, options.limit), mesh, scan.mean_edge(mesh.triangles.size()), deviation);
  LocalRefinementOptions used = options;
  if (options.most_places < deviation.size()) {
    std::vector<double> sorted = deviation;
    const auto next = sorted.begin() + static_cast<std::ptrdiff_t>(options.most_places);
    std::nth_element(sorted.begin(), next, sorted.end(), std::greater<>());
    used.limit = std::max(used.limit, *next);
  }
  FeatureNet none;
  return refine_places(mesh, none, scan, deviation, used);
}

BoundedRefinementResult refine_within(SurfaceMesh& mesh, const ReferenceSurface& scan,
                                      const LocalRefinementOptions& options, const Progress& progress) {
  FeatureNet none;
  return refine_within(mesh, none, scan, options, progress);
}

BoundedRefinementResult refine_within(SurfaceMesh& mesh, FeatureNet& net, const ReferenceSurface& scan,
                                      const LocalRefinementOptions& options, const Progress& progress) {
  check(options);
  net.patch_of_face.clear();
  const DeviationReference reference(scan.mesh);
  LocalRefinementOptions left = options;
  BoundedRefinementResult result;
  int yielded = 0;
  bool changed = false;
  for (int round = 0;; ++round) {
    progress("deviation", static_cast<double>(round) / options.rounds);
    const DeviationBound bound = bound_deviation(mesh, reference, {.limit = goal_limit(options)});
    result.largest_deviation = bound.upper();
    if (result.largest_deviation <= options.limit || round == options.rounds) break;
    FarPoints far;
    for (std::uint32_t f = 0; f < scan.mesh.triangles.size(); ++f)
      if (bound.to_mesh.upper[f] > goal_limit(options))
        far.add(bound.to_mesh.farthest[f], scan.face_normals[f], bound.to_mesh.upper[f]);
    std::vector<double> deviation = bound.to_reference.upper;
    attribute(far, mesh, scan.mean_edge(mesh.triangles.size()), deviation);
    left.most_vertices = options.most_vertices - std::min(options.most_vertices, result.changes.inserted);
    const LocalRefinementResult changes = refine_places(mesh, net, scan, deviation, left);
    result.changes.patches += changes.patches;
    result.changes.inserted += changes.inserted;
    changed = changed || changes.patches > 0;
    if (changes.patches > 0) continue;
    if (yielded == most_yielding && !changed) break;
    if (yielded == most_yielding) changed = false;
    yielded = (yielded + 1) % (most_yielding + 1);
    left.least_angle_deg = std::max(0.0, options.least_angle_deg - yielded * yielding_deg);
    left.fidelity_of_diagonal = options.fidelity_of_diagonal / std::pow(2, yielded);
  }
  return result;
}

}  // namespace scan2fea
