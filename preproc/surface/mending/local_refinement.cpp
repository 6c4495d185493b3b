#include "preproc/surface/mending/local_refinement.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/kernel/face_boxes.hpp"
#include "preproc/surface/kernel/locate.hpp"
#include "preproc/surface/kernel/nearest.hpp"
#include "preproc/surface/kernel/parallel_blocks.hpp"
#include "preproc/surface/mending/refinement_patch.hpp"
#include "quality/deviation_bound.hpp"
#include "quality/face_blocks.hpp"
#include "quality/triangle_tree.hpp"

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
constexpr int most_yielding = 2;
constexpr double yielding_deg = 12;

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

// Per patch the faces of the scan in its box. Without a tree: a scan may have millions: whole blocks of them are told
// to be far away by one box, since neighbours in a file are mostly neighbours in space.
std::vector<std::vector<std::uint32_t>> scan_faces_near(const SurfaceMesh& scan, const TriangleTree* tree,
                                                        const std::vector<RefinementPatch>& patches) {
  std::vector<std::vector<std::uint32_t>> near(patches.size());
  if (tree != nullptr) {
    for (std::size_t p = 0; p < patches.size(); ++p) {
      tree->for_each_overlap(patches[p].box(), [&](std::uint32_t f) { near[p].push_back(f); });
      std::sort(near[p].begin(), near[p].end());
    }
    return near;
  }
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
  for (const Hits& block : hits)
    for (const auto& [p, f] : block) near[p].push_back(f);
  return near;
}

// The boxes of a surface's faces while patches of it change.
class BoxesOfSurface {
 public:
  explicit BoxesOfSurface(const SurfaceMesh& mesh) : boxes_(mesh), built_(mesh.triangles.size()) {}

  void renew(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& faces) {
    for (const std::uint32_t f : faces)
      if (f < built_) boxes_.set(f, box_of_face(mesh, f));
  }

  // Ascending, but for the patch's own.
  std::vector<std::uint32_t> faces_around(const SurfaceMesh& mesh, const RefinementPatch& patch) const {
    std::vector<std::uint32_t> around;
    const auto add = [&](std::uint32_t f) {
      if (!std::binary_search(patch.faces().begin(), patch.faces().end(), f)) around.push_back(f);
    };
    boxes_.for_each_overlap(patch.box(), add);
    // Those that came since are few.
    for (auto f = static_cast<std::uint32_t>(built_); f < mesh.triangles.size(); ++f)
      if (boxes_meet(box_of_face(mesh, f), patch.box())) add(f);
    std::sort(around.begin(), around.end());
    return around;
  }

 private:
  FaceBoxes boxes_;
  std::size_t built_;  // faces that have a box
};

// What a round changed, and where the distance between mesh and scan may therefore be another.
struct Changes {
  LocalRefinementResult counts;
  std::vector<std::uint32_t> changed;     // faces of the mesh
  std::vector<std::uint32_t> scan_faces;  // in the boxes of the patches
};

// Faces around which nothing helped, and nothing has changed since: to try the same again would be in vain.
class Hopeless {
 public:
  bool holds(std::uint32_t face) const { return face < is_hopeless_.size() && is_hopeless_[face]; }
  void clear() { is_hopeless_.clear(); }

  void mark(const SurfaceMesh& mesh, const std::vector<Place>& places) {
    is_hopeless_.resize(mesh.triangles.size(), false);
    const VertexStars stars(mesh);
    for (const Place& place : places)
      for (const std::uint32_t v : mesh.triangles[place.face])
        for (const std::uint32_t corner : stars.corners(v)) is_hopeless_[corner / 3] = true;
  }

  void unmark(const std::vector<std::uint32_t>& faces) {
    for (const std::uint32_t f : faces)
      if (f < is_hopeless_.size()) is_hopeless_[f] = false;
  }

 private:
  std::vector<bool> is_hopeless_;
};

// Mends places that are apart from each other at once, until each has had its turn or lay within the patch of another,
// which then stood for it. Returns those whose patches are still too far.
std::vector<Place> mend(SurfaceMesh& mesh, BoxesOfSurface& boxes, FeatureNet& net, const ReferenceSurface& scan,
                        const TriangleTree* scan_tree, std::vector<Place> places, int rings, const PatchGoal& goal,
                        const LocalRefinementOptions& options, Changes& result) {
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
      RefinementPatch patch(mesh, stars, mesh.triangles[place.face], rings, place.deviation, lines);
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
    const std::vector<std::vector<std::uint32_t>> scan_faces = scan_faces_near(scan.whole, scan_tree, batch);
    PatchGoal part = goal;
    part.most_vertices =
        (options.most_vertices - std::min(options.most_vertices, result.counts.inserted)) / batch.size();
    std::vector<PatchOutcome> outcomes(batch.size());
    tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
      outcomes[i] = batch[i].improve(mesh, boxes.faces_around(mesh, batch[i]), scan.whole, scan_faces[i], net, part);
    });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (!outcomes[i].reached) left.push_back(taken[i]);
      if (!outcomes[i].improved) continue;
      const auto first_new = static_cast<std::uint32_t>(mesh.triangles.size());
      batch[i].write(mesh, net);
      boxes.renew(mesh, batch[i].faces());
      result.changed.insert(result.changed.end(), batch[i].faces().begin(), batch[i].faces().end());
      for (std::uint32_t f = first_new; f < mesh.triangles.size(); ++f) result.changed.push_back(f);
      result.scan_faces.insert(result.scan_faces.end(), scan_faces[i].begin(), scan_faces[i].end());
      result.counts.inserted += batch[i].inserted();
      ++result.counts.patches;
    }
    places = std::move(later);
  }
  return left;
}

Changes refine_places(SurfaceMesh& mesh, FeatureNet& net, const ReferenceSurface& scan, const TriangleTree* scan_tree,
                      const std::vector<double>& deviation, const LocalRefinementOptions& options, Hopeless& hopeless) {
  PatchGoal goal;
  goal.limit = goal_limit(options);
  goal.allowed = options.limit;
  goal.fidelity = options.fidelity_of_diagonal * scan.diagonal;
  goal.least_angle_deg = options.least_angle_deg;
  std::vector<Place> places = places_beyond(deviation, options.limit);
  std::erase_if(places, [&](const Place& place) { return hopeless.holds(place.face); });
  Changes result;
  BoxesOfSurface boxes(mesh);
  for (int rings = fewest_rings; rings <= most_rings && !places.empty(); ++rings) {
    goal.may_place = rings == most_rings;
    places = mend(mesh, boxes, net, scan, scan_tree, std::move(places), rings, goal, options, result);
  }
  hopeless.unmark(result.changed);
  hopeless.mark(mesh, places);
  return result;
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
  const TriangleTree& scan_tree() const { return scan_.tree(); }

  FarPoints far_points(const ReferenceSurface& scan) const {
    FarPoints far;
    for (std::uint32_t f = 0; f < scan.mesh.triangles.size(); ++f)
      if (bound_.to_mesh.upper[f] > limit_)
        far.add(bound_.to_mesh.farthest[f], scan.face_normals[f], bound_.to_mesh.upper[f]);
    return far;
  }

  // A face of the scan that was within the limit of a patch lies in the patch's box, which reaches farther: of the
  // others, what was within the limit still is, and what was not is asked again.
  void renew(const SurfaceMesh& mesh, const Changes& changes) {
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
  LocalRefinementOptions used = options;
  if (options.most_places < deviation.size()) {
    std::vector<double> sorted = deviation;
    const auto next = sorted.begin() + static_cast<std::ptrdiff_t>(options.most_places);
    std::nth_element(sorted.begin(), next, sorted.end(), std::greater<>());
    used.limit = std::max(used.limit, *next);
  }
  FeatureNet none;
  Hopeless hopeless;
  return refine_places(mesh, none, scan, nullptr, deviation, used, hopeless).counts;
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
  net.patch_of_face.clear();
  KnownDeviation known(mesh, reference, goal_limit(options));
  LocalRefinementOptions left = options;
  BoundedRefinementResult result;
  Hopeless hopeless;
  int yielded = 0;
  bool changed = false;
  for (int round = 0;; ++round) {
    progress("deviation", static_cast<double>(round) / options.rounds);
    result.largest_deviation = known.largest();
    if (result.largest_deviation <= options.limit || round == options.rounds) break;
    std::vector<double> deviation = known.of_mesh();
    attribute(known.far_points(scan), mesh, scan.mean_edge(mesh.triangles.size()), deviation);
    left.most_vertices = options.most_vertices - std::min(options.most_vertices, result.changes.inserted);
    const Changes changes = refine_places(mesh, net, scan, &known.scan_tree(), deviation, left, hopeless);
    result.changes.patches += changes.counts.patches;
    result.changes.inserted += changes.counts.inserted;
    changed = changed || changes.counts.patches > 0;
    if (changes.counts.patches > 0) {
      known.renew(mesh, changes);
      continue;
    }
    if (yielded == most_yielding && !changed) break;
    if (yielded == most_yielding) changed = false;
    yielded = (yielded + 1) % (most_yielding + 1);
    hopeless.clear();
    left.least_angle_deg = std::max(0.0, options.least_angle_deg - yielded * yielding_deg);
    left.fidelity_of_diagonal = options.fidelity_of_diagonal / std::pow(2, yielded);
  }
  return result;
}

}  // namespace scan2fea
