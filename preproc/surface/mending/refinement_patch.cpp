#include "preproc/surface/mending/refinement_patch.hpp"

#include "preproc/surface/fit/shape_fit.hpp"
#include "preproc/surface/kernel/clear_moves.hpp"
#include "preproc/surface/kernel/delaunay_flips.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"
#include "preproc/surface/kernel/locate.hpp"
#include "preproc/surface/kernel/nearest.hpp"
#include "preproc/surface/mending/defects.hpp"
#include "preproc/surface/sizing/split_long_edges.hpp"
#include "quality/deviation_bound.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <unordered_map>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

constexpr int most_steps = 6;
// Of the merit, which is a fourth power of distances: a step must gain at least 3 % of the excess.
constexpr double least_gain = 0.88;
// Of the deviation's bounds, see DeviationBoundOptions.
constexpr double close_tolerance = 0.02;
constexpr double rough_tolerance = 0.3;
// A step without insertions that gains so much needs none.
constexpr double good_gain = 0.5;
// Scan triangles longer than this part of the mean edge are cut, so that a patch answers for parts of large ones.
constexpr double longest_scan_edge = 0.7;
// Where the fit's extra weight on far samples begins, over the limit, and its most.
constexpr double tail_of_limit = 0.5;
constexpr double most_lift = 300;

bool meet(const BoundingBox& a, const BoundingBox& b) {
  return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

Vec3 centroid(const SurfaceMesh& mesh, const Triangle& t) {
  return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
}

// The faces with the vertices that they use; `vertices` says which of the mesh's each was, and may hold some already.
SurfaceMesh part_of(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& faces,
                    std::vector<std::uint32_t>& vertices) {
  std::unordered_map<std::uint32_t, std::uint32_t> place;
  for (std::uint32_t i = 0; i < vertices.size(); ++i) place.emplace(vertices[i], i);
  SurfaceMesh part;
  part.triangles.reserve(faces.size());
  for (const std::uint32_t f : faces) {
    Triangle t = mesh.triangles[f];
    for (std::uint32_t& v : t) {
      const auto [at, is_new] = place.emplace(v, static_cast<std::uint32_t>(vertices.size()));
      if (is_new) vertices.push_back(v);
      v = at->second;
    }
    part.triangles.push_back(t);
  }
  part.vertices.reserve(vertices.size());
  for (const std::uint32_t v : vertices) part.vertices.push_back(mesh.vertices[v]);
  return part;
}

// What is kept of a scan or a surface: the faces for which a patch answers.
SurfaceMesh selected(const SurfaceMesh& mesh, const std::vector<bool>& keep) {
  std::vector<std::uint32_t> faces, vertices;
  for (std::uint32_t f = 0; f < keep.size(); ++f)
    if (keep[f]) faces.push_back(f);
  return part_of(mesh, faces, vertices);
}

// One state of a patch, and how good it is.
struct Trial {
  SurfaceMesh patch;
  std::vector<LineEdge> lines;
  bool sound = false;         // meets nothing, is within the box, no worse in shape than the state before, and nearer
  bool meets = false;         // the surface around, or itself, or leaves the box
  std::size_t inverted = 0;   // faces
  double merit = 0;           // sum of ((deviation - limit) / limit)^4 over the faces of both sides beyond the limit
  double missing_angles = 0;  // degrees
  double shape = 0;           // sum of F(eta)
  std::uint32_t worst = 0;    // face of the patch

  std::size_t vertices() const { return patch.vertices.size(); }
  bool is_better(const Trial& other) const {
    if (merit > 0 || other.merit > 0) return merit < other.merit;
    return vertices() != other.vertices() ? vertices() < other.vertices() : shape < other.shape;
  }
};

// All that stays as it is while a patch changes.
class Surroundings {
 public:
  Surroundings(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& patch_faces,
               const std::vector<std::uint32_t>& patch_vertices, const SurfaceMesh& patch, const std::vector<bool>& rim,
               const BoundingBox& box, const SurfaceMesh& scan, const std::vector<std::uint32_t>& scan_faces,
               const PatchGoal& goal, double edge)
      : goal_(goal), rim_(rim), box_(box), edge_(edge), shared_(patch_vertices.size()) {
    std::vector<std::uint32_t> around;
    for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
      if (meet(face_box(mesh, mesh.triangles[f]), box) &&
          !std::binary_search(patch_faces.begin(), patch_faces.end(), f))
        around.push_back(f);
    std::vector<std::uint32_t> vertices = patch_vertices;
    frozen_ = part_of(mesh, around, vertices);
    cut_scan(scan, scan_faces, patch);
  }

  bool has_scan() const { return fit_scan_.has_value(); }

  // The state itself, without any fit.
  Trial judged(Trial trial) const {
    Trial worst;
    worst.inverted = std::numeric_limits<std::size_t>::max();
    worst.missing_angles = std::numeric_limits<double>::infinity();
    worst.merit = std::numeric_limits<double>::infinity();
    judge(trial, worst);
    return trial;
  }

  // The state after a fit, or as far towards it as nothing meets; shapes worse than those of `now` are not sound.
  Trial fitted(Trial trial, const Trial& now) const {
    const SurfaceMesh patch = trial.patch;
    fit(trial);
    judge(trial, now);
    if (!trial.meets) return trial;
    SurfaceMesh moved = with_frozen(patch);
    if (!find_self_intersections(moved).empty()) return trial;
    std::vector<Vec3> targets = moved.vertices;
    std::copy(trial.patch.vertices.begin(), trial.patch.vertices.end(), targets.begin());
    move_clear(moved, targets, 2);
    trial.patch.vertices.assign(moved.vertices.begin(),
                                moved.vertices.begin() + static_cast<std::ptrdiff_t>(trial.vertices()));
    judge(trial, now);
    return trial;
  }

  // The state without a fit, its last vertex on the scan.
  Trial placed(Trial trial, const Trial& now) const {
    Vec3& point = trial.patch.vertices.back();
    point = scan_tree_->closest(point, scan_tree_->leaf_order().front()).point;
    judge(trial, now);
    return trial;
  }

 private:
  void cut_scan(const SurfaceMesh& scan, const std::vector<std::uint32_t>& scan_faces, const SurfaceMesh& patch) {
    if (scan_faces.empty()) return;
    std::vector<std::uint32_t> vertices;
    scan_ = part_of(scan, scan_faces, vertices);
    scan_tree_.emplace(scan_);
    const SurfaceMesh fine =
        refine_scan(scan_, {std::vector<double>(scan_.vertices.size(), edge_)}, longest_scan_edge, 8).mesh;

    const SurfaceMesh around = with_frozen(patch);
    const VertexStars stars(around);
    const std::vector<Triangle> neighbours = face_neighbours(around, stars);
    const std::vector<Vec3> normals = face_normals(around);
    const WalkableMesh on{around, stars, neighbours, normals};
    const TriangleTree tree(around);
    std::vector<Vec3> centroids(fine.triangles.size());
    for (std::size_t f = 0; f < centroids.size(); ++f) centroids[f] = centroid(fine, fine.triangles[f]);
    const std::vector<Vec3> fine_normals = face_normals(fine);
    const std::vector<std::uint32_t> start = nearest_vertices(centroids, fine_normals, around, edge_);
    std::vector<bool> fits(fine.triangles.size()), answered(fine.triangles.size());
    const auto is_of_patch = [&](std::uint32_t face) { return face < patch.triangles.size(); };
    for (std::size_t f = 0; f < fits.size(); ++f) {
      const std::uint32_t first = stars.corners(start[f]).front() / 3;
      fits[f] = is_of_patch(descend_to_nearest(on, {centroids[f], fine_normals[f], 0}, first).face);
      answered[f] = fits[f] || is_of_patch(tree.closest(centroids[f], first).triangle);
      for (const std::uint32_t v : fine.triangles[f])
        answered[f] = answered[f] || is_of_patch(tree.closest(fine.vertices[v], first).triangle);
    }
    answered_ = selected(fine, answered);
    fit_part_ = selected(fine, fits);
    if (!fit_part_.triangles.empty()) fit_scan_.emplace(fit_part_);
  }

  SurfaceMesh with_frozen(const SurfaceMesh& patch) const {
    SurfaceMesh mesh = patch;
    const auto own = static_cast<std::uint32_t>(patch.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), frozen_.vertices.begin() + static_cast<std::ptrdiff_t>(shared_),
                         frozen_.vertices.end());
    for (Triangle t : frozen_.triangles) {
      for (std::uint32_t& v : t)
        if (v >= shared_) v = v - static_cast<std::uint32_t>(shared_) + own;
      mesh.triangles.push_back(t);
    }
    return mesh;
  }

  void fit(Trial& trial) const {
    ShapeFitOptions options;
    options.rounds = 6;
    options.hold_faces_below = 1;
    options.fidelity_of_diagonal = std::min(0.09, goal_.fidelity / fit_scan_->diagonal);
    options.lift_tail_of_diagonal = tail_of_limit * goal_.limit / fit_scan_->diagonal;
    options.most_lift = most_lift;
    options.constraints.assign(trial.vertices(), VertexConstraint::free);
    for (std::size_t v = 0; v < rim_.size(); ++v)
      if (rim_[v]) options.constraints[v] = VertexConstraint::fixed;
    for (const LineEdge& e : trial.lines)
      options.constraints[e.from] = options.constraints[e.to] = VertexConstraint::fixed;
    optimise_shape_and_fit(trial.patch, *fit_scan_, options);
  }

  // The cheaper questions first: most trials end at one of them.
  void judge(Trial& trial, const Trial& now) const {
    trial.sound = trial.meets = false;
    const SurfaceMesh& patch = trial.patch;
    for (const Vec3& p : patch.vertices)
      if (!(p.array() > box_.low.array()).all() || !(p.array() < box_.high.array()).all()) trial.meets = true;
    if (trial.meets) return;
    const SurfaceDefects defects =
        find_defects(patch, *fit_scan_, scan_vertices_of_faces(patch, *fit_scan_), goal_.least_angle_deg);
    trial.inverted = defects.inverted.size();
    trial.missing_angles = defects.missing_angles_deg;
    if (trial.inverted > now.inverted || trial.missing_angles > now.missing_angles) return;
    const SurfaceMesh around = with_frozen(patch);
    std::vector<std::uint32_t> own(patch.triangles.size());
    std::iota(own.begin(), own.end(), 0U);
    trial.meets = !find_self_intersections(around, own).empty();
    if (trial.meets) return;
    // Most trials only make things worse, which bounds that are not close tell as well.
    const auto bound_patch = [&](double tolerance) {
      return bound_one_sided_deviation(patch, scan_, {.limit = goal_.limit, .tolerance = tolerance});
    };
    const double enough = least_gain * now.merit;
    if (merit_of(bound_patch(rough_tolerance).lower) > enough) return;
    const OneSidedDeviation of_patch = bound_patch(close_tolerance);
    trial.merit = merit_of(of_patch.upper);
    if (trial.merit > enough) return;
    const OneSidedDeviation of_scan =
        bound_one_sided_deviation(answered_, around, {.limit = goal_.limit, .tolerance = close_tolerance});
    trial.merit += merit_of(of_scan.upper);
    if (trial.merit > enough) return;
    trial.sound = true;
    trial.shape = 0;
    for (const Triangle& t : patch.triangles)
      trial.shape += shape_energy({}, patch.vertices[t[0]], patch.vertices[t[1]], patch.vertices[t[2]]).value;

    trial.worst = of_patch.worst_face;
    if (of_scan.largest_upper > of_patch.largest_upper)
      trial.worst = face_at(patch, of_scan.farthest[of_scan.worst_face],
                            area_vector(answered_, answered_.triangles[of_scan.worst_face]).normalized());
  }

  double merit_of(const std::vector<double>& deviation) const {
    double merit = 0;
    for (const double d : deviation) merit += std::pow(std::max(0.0, d / goal_.limit - 1), 4);
    return merit;
  }

  // The face of the patch nearest to a point of the scan, one that faces the other way only if all others are far.
  std::uint32_t face_at(const SurfaceMesh& patch, const Vec3& point, const Vec3& normal) const {
    std::uint32_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t f = 0; f < patch.triangles.size(); ++f) {
      const auto& [a, b, c] = patch.triangles[f];
      const Vec3 at = closest_point_on_triangle(point, patch.vertices[a], patch.vertices[b], patch.vertices[c]);
      double squared = (point - at).squaredNorm();
      if (area_vector(patch, patch.triangles[f]).dot(normal) < 0) squared += edge_ * edge_;
      if (squared >= least) continue;
      least = squared;
      nearest = f;
    }
    return nearest;
  }

  const PatchGoal& goal_;
  const std::vector<bool>& rim_;
  const BoundingBox& box_;
  double edge_;
  std::size_t shared_;  // vertices of the patch as it was, which come first in frozen_
  SurfaceMesh frozen_;
  SurfaceMesh scan_;  // within the box
  std::optional<TriangleTree> scan_tree_;
  SurfaceMesh answered_;  // parts of it whose nearest face, whichever way that looks, was one of the patch
  SurfaceMesh fit_part_;  // and those that belong to the patch
  std::optional<ReferenceSurface> fit_scan_;
};

// Edges inside of the patch, of a face and the faces across its edges.
std::vector<Index> edges_around(const HalfedgeMesh& mesh, Index face) {
  std::vector<Index> edges;
  const auto add = [&](Index h) {
    if (mesh.is_border(h)) return;
    const Index edge = std::min(h, mesh.opposite(h));
    if (std::find(edges.begin(), edges.end(), edge) == edges.end()) edges.push_back(edge);
  };
  for (Index h = 3 * face; h < 3 * face + 3; ++h) {
    add(h);
    if (mesh.is_border(h)) continue;
    add(HalfedgeMesh::next(mesh.opposite(h)));
    add(HalfedgeMesh::prev(mesh.opposite(h)));
  }
  return edges;
}

// The best of all sound trials, the first of equals; nothing where none is.
std::optional<Trial> best_of(std::vector<Trial>& trials) {
  std::optional<Trial> best;
  for (Trial& t : trials) {
    if (!t.sound) continue;
    if (!best || t.is_better(*best)) best = std::move(t);
  }
  return best;
}

bool is_line_edge(const HalfedgeMesh& mesh, Index h, const Trial& trial) {
  const FeatureEdge edge = feature_edge(mesh.origin(h), mesh.target(h));
  return std::any_of(trial.lines.begin(), trial.lines.end(), [&](const LineEdge& e) { return e.edge() == edge; });
}

// A new vertex in the middle of an edge; where that is on a line, in the middle of the line's piece.
Trial with_split_edge(const HalfedgeMesh& mesh, Index h, const Trial& now, const FeatureNet& net) {
  const FeatureEdge edge = feature_edge(mesh.origin(h), mesh.target(h));
  Vec3 middle = 0.5 * (mesh.points[edge[0]] + mesh.points[edge[1]]);
  Trial trial{.patch = {}, .lines = now.lines};
  const auto v = static_cast<std::uint32_t>(now.vertices());
  for (std::size_t i = 0; i < now.lines.size(); ++i) {
    if (now.lines[i].edge() != edge) continue;
    LineEdge first = now.lines[i], second = first;
    first.to = second.from = v;
    first.to_place = second.from_place = middle_place(net.lines[first.line], first.from_place, first.to_place);
    middle = net.lines[first.line].point_at(first.to_place);
    trial.lines[i] = first;
    trial.lines.push_back(second);
  }
  std::vector<FeatureEdge> kept;
  for (const LineEdge& e : trial.lines) kept.push_back(e.edge());
  std::sort(kept.begin(), kept.end());
  HalfedgeMesh changed = mesh;
  restore_delaunay(changed, changed.split_edge(h, middle), {.crease_deg = 90, .kept = kept});
  trial.patch = changed.to_surface();
  return trial;
}

// One step: what lowers the deviation most; the cheaper ways first, and no other where they reach the limit.
std::optional<Trial> next_state(const Trial& now, const Surroundings& surroundings, const FeatureNet& net,
                                bool may_insert) {
  std::vector<Trial> trials;
  trials.push_back(surroundings.fitted(now, now));
  std::optional<Trial> best = best_of(trials);
  if (best && best->merit == 0) return best;

  const HalfedgeMesh mesh(now.patch);
  const std::vector<Index> edges = edges_around(mesh, now.worst);
  trials.assign(edges.size() + 1, {});
  tbb::parallel_for(std::size_t{0}, edges.size(), [&](std::size_t i) {
    if (!mesh.can_flip(edges[i]) || is_line_edge(mesh, edges[i], now)) return;
    HalfedgeMesh changed = mesh;
    changed.flip(edges[i]);
    trials[i] = surroundings.fitted({.patch = changed.to_surface(), .lines = now.lines}, now);
  });
  if (best) trials.back() = std::move(*best);
  best = best_of(trials);
  if (!may_insert || (best && best->merit <= good_gain * now.merit)) return best;

  trials.assign(2 * edges.size() + 1, {});
  tbb::parallel_for(std::size_t{0}, edges.size(), [&](std::size_t i) {
    const Trial split = with_split_edge(mesh, edges[i], now, net);
    trials[2 * i] = surroundings.fitted(split, now);
    if (split.lines.size() == now.lines.size()) trials[2 * i + 1] = surroundings.placed(split, now);
  });
  if (best) trials.back() = std::move(*best);
  return best_of(trials);
}

}  // namespace

BoundingBox face_box(const SurfaceMesh& mesh, const Triangle& t) {
  const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

RefinementPatch::RefinementPatch(const SurfaceMesh& mesh, const VertexStars& stars, std::uint32_t seed, int rings,
                                 double deviation, const std::vector<LineEdge>& lines) {
  std::vector<std::uint32_t> inner(mesh.triangles[seed].begin(), mesh.triangles[seed].end());
  const auto add_stars = [&](std::size_t first) {
    const std::size_t last = inner.size();
    for (std::size_t i = first; i < last; ++i)
      for (const std::uint32_t corner : stars.corners(inner[i])) faces_.push_back(corner / 3);
    std::sort(faces_.begin(), faces_.end());
    faces_.erase(std::unique(faces_.begin(), faces_.end()), faces_.end());
  };
  const auto add_vertex = [&](std::uint32_t v) {
    if (std::find(inner.begin(), inner.end(), v) == inner.end()) inner.push_back(v);
  };
  add_stars(0);
  for (int ring = 0; ring < rings; ++ring) {
    const std::size_t first = inner.size();
    for (const std::uint32_t f : faces_)
      for (const std::uint32_t v : mesh.triangles[f]) add_vertex(v);
    add_stars(first);
  }
  // Where the rim touches itself in a vertex, the vertex becomes an inner one.
  for (bool grown = true; grown;) {
    vertices_.clear();
    patch_ = part_of(mesh, faces_, vertices_);
    const VertexStars patch_stars(patch_);
    const std::vector<Triangle> neighbours = face_neighbours(patch_, patch_stars);
    std::vector<int> rim_edges(vertices_.size(), 0);
    for (std::size_t f = 0; f < neighbours.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k)
        if (neighbours[f][k] == no_face)
          for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3}) ++rim_edges[patch_.triangles[f][other]];
    const std::size_t first = inner.size();
    rim_.assign(vertices_.size(), false);
    for (std::size_t v = 0; v < rim_edges.size(); ++v) {
      rim_[v] = rim_edges[v] > 0;
      if (rim_edges[v] > 2) add_vertex(vertices_[v]);
    }
    grown = inner.size() > first;
    if (grown) add_stars(first);
  }
  for (const Triangle& t : patch_.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      const FeatureEdge edge = feature_edge(vertices_[a], vertices_[b]);
      const auto at = std::lower_bound(lines.begin(), lines.end(), edge,
                                       [](const LineEdge& e, const FeatureEdge& wanted) { return e.edge() < wanted; });
      if (at == lines.end() || at->edge() != edge) continue;
      LineEdge own = *at;
      own.from = at->from == vertices_[a] ? a : b;
      own.to = own.from == a ? b : a;
      if (std::none_of(lines_.begin(), lines_.end(), [&](const LineEdge& e) { return e.edge() == own.edge(); }))
        lines_.push_back(own);
    }
  edge_ = std::sqrt(4 / std::numbers::sqrt3 * surface_area(patch_) / static_cast<double>(faces_.size()));
  const double reach = 1.1 * deviation + 0.3 * edge_;
  box_ = bounding_box(patch_.vertices);
  box_.low.array() -= reach;
  box_.high.array() += reach;
}

PatchOutcome RefinementPatch::improve(const SurfaceMesh& mesh, const SurfaceMesh& scan,
                                      const std::vector<std::uint32_t>& scan_faces, const FeatureNet& net,
                                      const PatchGoal& goal) {
  const Surroundings surroundings(mesh, faces_, vertices_, patch_, rim_, box_, scan, scan_faces, goal, edge_);
  if (!surroundings.has_scan()) return {};
  Trial now = surroundings.judged({.patch = patch_, .lines = lines_});
  if (!now.sound) return {};
  bool improved = false;
  for (int step = 0; step < most_steps && now.merit > 0; ++step) {
    std::optional<Trial> next = next_state(now, surroundings, net, inserted() < goal.most_vertices);
    if (!next) break;
    now = std::move(*next);
    patch_ = now.patch;
    lines_ = now.lines;
    improved = true;
  }
  return {.improved = improved, .reached = now.merit == 0};
}

void RefinementPatch::write(SurfaceMesh& mesh, FeatureNet& net) const {
  std::vector<std::uint32_t> number = vertices_;
  for (std::size_t v = 0; v < patch_.vertices.size(); ++v) {
    if (v < vertices_.size()) {
      mesh.vertices[vertices_[v]] = patch_.vertices[v];
    } else {
      number.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back(patch_.vertices[v]);
    }
  }
  for (const LineEdge& e : lines_) {
    if (e.from < vertices_.size()) continue;
    std::vector<VertexOnLine>& on_line = net.lines[e.line].vertices;
    const auto at = std::upper_bound(on_line.begin(), on_line.end(), e.from_place,
                                     [](double place, const VertexOnLine& other) { return place < other.place; });
    on_line.insert(at, {number[e.from], e.from_place});
  }
  for (std::size_t f = 0; f < patch_.triangles.size(); ++f) {
    const Triangle& t = patch_.triangles[f];
    const Triangle global{number[t[0]], number[t[1]], number[t[2]]};
    if (f < faces_.size())
      mesh.triangles[faces_[f]] = global;
    else
      mesh.triangles.push_back(global);
  }
}

}  // namespace scan2fea
