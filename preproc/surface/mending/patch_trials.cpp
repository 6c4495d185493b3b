#include "preproc/surface/mending/patch_trials.hpp"

#include "preproc/surface/fit/shape_fit.hpp"
#include "preproc/surface/kernel/clear_moves.hpp"
#include "preproc/surface/kernel/locate.hpp"
#include "preproc/surface/kernel/nearest.hpp"
#include "preproc/surface/mending/defects.hpp"
#include "preproc/surface/sizing/split_long_edges.hpp"
#include "quality/deviation_bound.hpp"
#include "quality/face_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace scan2fea {
namespace {

// What a step must bring the merit down to. The merit is a fourth power of distances: 0.88 is 3 % less of them.
constexpr double least_gain = 0.88;
// How far apart the bounds of the deviation may be, see DeviationBoundOptions.
constexpr double close_tolerance = 0.02;
constexpr double rough_tolerance = 0.3;
// Scan triangles longer than this part of the mean edge are cut, so that a patch answers for parts of large ones.
constexpr double longest_scan_edge = 0.7;
// Where the fit's extra weight on far samples begins, over the limit, and the most that it may be: a sample at twice
// the limit has nearly all of it (see ShapeFitOptions::lift_tail_of_diagonal).
constexpr double tail_of_limit = 0.5;
constexpr double most_lift = 300;

Vec3 centroid(const SurfaceMesh& mesh, const Triangle& t) {
  return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
}

// The marked faces, as a surface of their own.
SurfaceMesh selected(const SurfaceMesh& mesh, const std::vector<bool>& keep) {
  std::vector<std::uint32_t> faces, vertices;
  for (std::uint32_t f = 0; f < keep.size(); ++f)
    if (keep[f]) faces.push_back(f);
  return part_of(mesh, faces, vertices);
}

}  // namespace

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

Surroundings::Surroundings(const SurfaceMesh& mesh, const PatchOutline& outline, const SurfaceMesh& patch,
                           const SurfaceMesh& scan, const std::vector<std::uint32_t>& scan_faces, const PatchGoal& goal)
    : outline_(outline), goal_(goal) {
  std::vector<std::uint32_t> around;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    if (boxes_meet(box_of_face(mesh, f), outline.box) &&
        !std::binary_search(outline.faces.begin(), outline.faces.end(), f))
      around.push_back(f);
  std::vector<std::uint32_t> vertices = outline.vertices;
  frozen_ = part_of(mesh, around, vertices);
  cut_scan(scan, scan_faces, patch);
}

Trial Surroundings::judged(Trial trial) const {
  Trial worst;
  worst.inverted = std::numeric_limits<std::size_t>::max();
  worst.missing_angles = std::numeric_limits<double>::infinity();
  worst.merit = std::numeric_limits<double>::infinity();
  judge(trial, worst);
  return trial;
}

Trial Surroundings::fitted(Trial trial, const Trial& now) const {
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

Trial Surroundings::placed(Trial trial, const Trial& now) const {
  Vec3& point = trial.patch.vertices.back();
  point = scan_tree_->closest(point, scan_tree_->leaf_order().front()).point;
  judge(trial, now);
  return trial;
}

void Surroundings::cut_scan(const SurfaceMesh& scan, const std::vector<std::uint32_t>& scan_faces,
                            const SurfaceMesh& patch) {
  if (scan_faces.empty()) return;
  std::vector<std::uint32_t> vertices;
  scan_ = part_of(scan, scan_faces, vertices);
  scan_tree_.emplace(scan_);
  const SurfaceMesh fine =
      refine_scan(scan_, {std::vector<double>(scan_.vertices.size(), outline_.edge)}, longest_scan_edge, 8).mesh;

  const SurfaceMesh around = with_frozen(patch);
  const VertexStars stars(around);
  const std::vector<Triangle> neighbours = face_neighbours(around, stars);
  const std::vector<Vec3> normals = face_normals(around);
  const WalkableMesh on{around, stars, neighbours, normals};
  const TriangleTree tree(around);
  std::vector<Vec3> centroids(fine.triangles.size());
  for (std::size_t f = 0; f < centroids.size(); ++f) centroids[f] = centroid(fine, fine.triangles[f]);
  const std::vector<Vec3> fine_normals = face_normals(fine);
  const std::vector<std::uint32_t> start = nearest_vertices(centroids, fine_normals, around, outline_.edge);
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

SurfaceMesh Surroundings::with_frozen(const SurfaceMesh& patch) const {
  SurfaceMesh mesh = patch;
  const auto own = static_cast<std::uint32_t>(patch.vertices.size());
  const auto shared = static_cast<std::uint32_t>(outline_.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), frozen_.vertices.begin() + static_cast<std::ptrdiff_t>(shared),
                       frozen_.vertices.end());
  for (Triangle t : frozen_.triangles) {
    for (std::uint32_t& v : t)
      if (v >= shared) v = v - shared + own;
    mesh.triangles.push_back(t);
  }
  return mesh;
}

void Surroundings::fit(Trial& trial) const {
  ShapeFitOptions options;
  options.rounds = 6;
  options.hold_faces_below = 1;
  // The diagonal is that of a piece of the scan: on a tiny one the fidelity would pass 0.1, the most that a fit takes.
  options.fidelity_of_diagonal = std::min(0.09, goal_.fidelity / fit_scan_->diagonal);
  options.lift_tail_of_diagonal = tail_of_limit * goal_.limit / fit_scan_->diagonal;
  options.most_lift = most_lift;
  options.constraints.assign(trial.vertices(), VertexConstraint::free);
  for (std::size_t v = 0; v < outline_.rim.size(); ++v)
    if (outline_.rim[v]) options.constraints[v] = VertexConstraint::fixed;
  for (const LineEdge& e : trial.lines)
    options.constraints[e.from] = options.constraints[e.to] = VertexConstraint::fixed;
  optimise_shape_and_fit(trial.patch, *fit_scan_, options);
}

// The cheaper questions first: most trials end at one of them.
void Surroundings::judge(Trial& trial, const Trial& now) const {
  trial.sound = trial.meets = false;
  const SurfaceMesh& patch = trial.patch;
  for (const Vec3& p : patch.vertices)
    if (!(p.array() > outline_.box.low.array()).all() || !(p.array() < outline_.box.high.array()).all())
      trial.meets = true;
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

double Surroundings::merit_of(const std::vector<double>& deviation) const {
  double merit = 0;
  for (const double d : deviation) merit += std::pow(std::max(0.0, d / goal_.limit - 1), 4);
  return merit;
}

std::uint32_t Surroundings::face_at(const SurfaceMesh& patch, const Vec3& point, const Vec3& normal) const {
  std::uint32_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t f = 0; f < patch.triangles.size(); ++f) {
    const auto& [a, b, c] = patch.triangles[f];
    const Vec3 at = closest_point_on_triangle(point, patch.vertices[a], patch.vertices[b], patch.vertices[c]);
    double squared = (point - at).squaredNorm();
    if (area_vector(patch, patch.triangles[f]).dot(normal) < 0) squared += outline_.edge * outline_.edge;
    if (squared >= least) continue;
    least = squared;
    nearest = f;
  }
  return nearest;
}

}  // namespace scan2fea
