#include "preproc/surface/mending/local_refinement.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/kernel/locate.hpp"
#include "preproc/surface/kernel/nearest.hpp"
#include "preproc/surface/kernel/parallel_blocks.hpp"
#include "preproc/surface/mending/mend_patches.hpp"
#include "preproc/surface/sizing/shorter_edges.hpp"
#include "quality/deviation_bound.hpp"
#include "quality/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace scan2fea {
namespace {

// Rings of faces around a place: with fewer the rim holds what should move, with more the fit costs more.
constexpr int fewest_rings = 1;
constexpr int most_rings = 2;
// So many vertices of the scan are asked for their distance: more of a dense scan tell little more.
constexpr std::size_t most_vertices_per_face = 6;
// The part of the limit that is kept free for the exact volume's shift.
constexpr double reserve = 0.01;
// Where nothing helps, as in a fold of the scan that the triangles are too large to follow, edges become so many times
// as long there; then all is tried again, so often.
constexpr double shortening = 0.6;
constexpr int most_shortenings = 3;
// Where that is in vain, too, smaller angles are allowed, by so much at each time.
constexpr double yielding_deg = 10, most_yielding_deg = 20;

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
  std::vector<double> distances((count + step - 1) / step, 0);  // 0 where within the limit
  for_each_block(distances.size(), [&](std::size_t first, std::size_t last) {
    std::uint32_t hint = tree.leaf_order().front();
    for (std::size_t i = first; i < last; ++i) {
      const Vec3& p = scan.mesh.vertices[i * step];
      // Mostly the face that is nearest to the last one is near enough.
      const auto& [a, b, c] = tree.corners_of_leaf(tree.leaf_of(hint));
      if ((p - closest_point_on_triangle(p, a, b, c)).norm() <= limit) continue;
      const ClosestPoint nearest = tree.closest(p, hint);
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

// Faces around which nothing helped, and nothing has changed since: to try the same again would be in vain.
class Hopeless {
 public:
  bool holds(std::uint32_t face) const { return face < is_hopeless_.size() && is_hopeless_[face]; }
  void clear() { is_hopeless_.clear(); }

  void mark(const SurfaceMesh& mesh, const std::vector<PatchPlace>& places) {
    is_hopeless_.resize(mesh.triangles.size(), false);
    const VertexStars stars(mesh);
    for (const PatchPlace& place : places)
      for (const std::uint32_t v : place.seeds)
        for (const std::uint32_t corner : stars.corners(v)) is_hopeless_[corner / 3] = true;
  }

  void unmark(const std::vector<std::uint32_t>& faces) {
    for (const std::uint32_t f : faces)
      if (f < is_hopeless_.size()) is_hopeless_[f] = false;
  }

 private:
  std::vector<bool> is_hopeless_;
};

PatchChanges refine_places(PatchMender& mender, const SurfaceMesh& mesh, const ReferenceSurface& scan,
                           const std::vector<double>& deviation, Mending how, const LocalRefinementOptions& options,
                           Hopeless& hopeless, std::size_t& in_vain) {
  PatchGoal goal;
  goal.limit = goal_limit(options);
  goal.allowed = options.limit;
  goal.fidelity = options.fidelity_of_diagonal * scan.diagonal;
  goal.least_angle_deg = options.least_angle_deg;
  goal.most_vertices = options.most_vertices;
  std::vector<PatchPlace> places;
  for (const Place& place : places_beyond(deviation, options.limit)) {
    if (hopeless.holds(place.face)) continue;
    if (places.size() == options.most_places) break;
    const Triangle& t = mesh.triangles[place.face];
    places.push_back({{t.begin(), t.end()}, place.deviation, shorter_around(mesh, place.face, shortening)});
  }
  for (int rings = how == Mending::shorten ? most_rings : fewest_rings; rings <= most_rings && !places.empty(); ++rings)
    places = mender.mend(std::move(places), rings, how, goal);
  PatchChanges changes = mender.take_changes();
  hopeless.unmark(changes.changed);
  hopeless.mark(mesh, places);
  in_vain += places.size();
  return changes;
}

// Bounds of the deviation that are renewed only where something has changed.
class KnownDeviation {
 public:
  KnownDeviation(const SurfaceMesh& mesh, const DeviationReference& scan, double limit)
      : scan_(scan), limit_(limit), bound_(bound_deviation(mesh, scan_, {.limit = limit})) {}

  double largest() const {
    const auto of = [](const std::vector<double>& upper) { return *std::max_element(upper.begin(), upper.end()); };
    return std::max(of(bound_.to_reference.upper), of(bound_.to_mesh.upper));
  }
  const std::vector<double>& of_mesh() const { return bound_.to_reference.upper; }

  FarPoints far_points(const ReferenceSurface& scan) const {
    FarPoints far;
    for (std::uint32_t f = 0; f < scan.mesh.triangles.size(); ++f)
      if (bound_.to_mesh.upper[f] > limit_)
        far.add(bound_.to_mesh.farthest[f], scan.face_normals[f], bound_.to_mesh.upper[f]);
    return far;
  }

  // A face of the scan that was within the limit of a patch lies in the patch's box, which reaches farther: of the
  // others, what was within the limit still is, and what was not is asked again.
  void renew(const SurfaceMesh& mesh, const PatchChanges& changes) {
    OneSidedDeviation &of_mesh = bound_.to_reference, &of_scan = bound_.to_mesh;
    for (std::vector<double>* bounds : {&of_mesh.lower, &of_mesh.upper}) bounds->resize(mesh.triangles.size());
    of_mesh.farthest.resize(mesh.triangles.size());
    renew(mesh, changes.changed, scan_, of_mesh);
    std::vector<std::uint32_t> touched = changes.scan_faces;
    for (std::uint32_t f = 0; f < of_scan.upper.size(); ++f)
      if (of_scan.upper[f] > limit_) touched.push_back(f);
    renew(scan_.mesh(), touched, DeviationReference(mesh), of_scan);
  }

 private:
  void renew(const SurfaceMesh& from, std::vector<std::uint32_t> faces, const DeviationReference& onto,
             OneSidedDeviation& known) const {
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    std::vector<std::uint32_t> vertices;
    const OneSidedDeviation part = bound_one_sided_deviation(part_of(from, faces, vertices), onto, {.limit = limit_});
    for (std::size_t i = 0; i < faces.size(); ++i) {
      known.lower[faces[i]] = part.lower[i];
      known.upper[faces[i]] = part.upper[i];
      known.farthest[faces[i]] = part.farthest[i];
    }
  }

  const DeviationReference& scan_;
  double limit_;
  DeviationBound bound_;
};

}  // namespace

LocalRefinementResult refine_worst(SurfaceMesh& mesh, const ReferenceSurface& scan, std::vector<double> deviation,
                                   const LocalRefinementOptions& options, const Progress& progress) {
  check(options);
  progress("local refinement", 0);
  attribute(far_vertices(mesh, scan, options.limit), mesh, scan.mean_edge(mesh.triangles.size()), deviation);
  FeatureNet none;
  PatchMender mender(mesh, none, scan, nullptr);
  Hopeless hopeless;
  std::size_t in_vain = 0;
  const PatchChanges changes =
      refine_places(mender, mesh, scan, deviation, Mending::improve, options, hopeless, in_vain);
  return {changes.patches, changes.inserted};
}

BoundedRefinementResult refine_within(SurfaceMesh& mesh, const ReferenceSurface& scan,
                                      const LocalRefinementOptions& options, const Progress& progress) {
  FeatureNet none;
  return refine_within(mesh, none, scan, DeviationReference(scan.mesh), options, progress);
}

BoundedRefinementResult refine_within(SurfaceMesh& mesh, FeatureNet& net, const ReferenceSurface& scan,
                                      const DeviationReference& reference, const LocalRefinementOptions& options,
                                      const Progress& progress) {
  check(options);
  PatchMender mender(mesh, net, scan, &reference.tree());
  KnownDeviation known(mesh, reference, goal_limit(options));
  LocalRefinementOptions left = options;
  BoundedRefinementResult result;
  Hopeless hopeless;
  std::size_t in_vain = 0;
  int shortened = 0;
  Mending how = Mending::improve;
  for (int round = 0;; ++round) {
    progress("deviation", static_cast<double>(round) / options.rounds);
    result.largest_deviation = known.largest();
    if (result.largest_deviation <= options.limit || round == options.rounds ||
        (in_vain > options.most_in_vain && in_vain - options.most_in_vain > result.changes.patches))
      break;
    std::vector<double> deviation = known.of_mesh();
    attribute(known.far_points(scan), mesh, scan.mean_edge(mesh.triangles.size()), deviation);
    left.most_vertices = options.most_vertices - std::min(options.most_vertices, result.changes.inserted);
    const PatchChanges changes = refine_places(mender, mesh, scan, deviation, how, left, hopeless, in_vain);
    result.changes.patches += changes.patches;
    result.changes.inserted += changes.inserted;
    if (changes.patches > 0) {
      known.renew(mesh, changes);
      how = Mending::improve;
      continue;
    }
    if (places_beyond(deviation, options.limit).size() > options.most_to_yield) break;
    hopeless.clear();
    if (how == Mending::improve && shortened++ < most_shortenings) {
      how = Mending::shorten;
    } else if (left.least_angle_deg > options.least_angle_deg - most_yielding_deg) {
      left.least_angle_deg = std::max(0.0, left.least_angle_deg - yielding_deg);
      how = Mending::improve;
      shortened = 0;
    } else {
      break;
    }
  }
  return result;
}

}  // namespace scan2fea
