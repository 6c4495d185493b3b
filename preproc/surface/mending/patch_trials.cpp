#include "preproc/surface/mending/patch_trials.hpp"

#include "preproc/surface/fit/shape_fit.hpp"
#include "preproc/surface/kernel/locate.hpp"
#include "preproc/surface/mending/constraint_projection.hpp"
#include "quality/deviation_bound.hpp"
#include "quality/self_intersections.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace scan2fea {
namespace {

// Where the fit's extra weight on far samples begins, over the limit, and the most that it may be: a sample at twice
// the limit has nearly all of it (see ShapeFitOptions::lift_tail_of_diagonal).
constexpr double tail_of_limit = 0.5;
constexpr double most_lift = 300;
// Tetrahedra share the angle between two faces, mostly by two: no sharper angles are made than these times the least
// of triangles, nor made sharper.
constexpr double least_dihedral_over_least_angle = 1.75;
// Outside of the body there are no elements: faces may close on one another there three times as sharply, as they do in
// the folds of a scan.
constexpr double ease_outside = 3;
// Faces beside a line of the part turn about it a little wherever they move; so much sharper it may become.
constexpr double turning_about_line_deg = 5;
// What samples may show of the limit: bounds are a little larger.
constexpr double sampled_limit = 0.985;
// A face is asked at the points of a grid of so many steps a side.
constexpr int grid = 4;
// Points are pulled to this part of the limit, several times round, since what brings one nearer moves others; those
// within the second part are not looked at.
constexpr int pulls = 8;
constexpr double pulled_within = 0.93, well_within = 0.75;
// Folds are opened a little more than is wanted, at each time round by at most so much of an edge.
constexpr double opened_beyond_deg = 2, longest_opening = 0.2;

// Of the scan, an area of so many times the patch's may be too far from it. Of 35 patches with more one came within the
// limit, and they took half of the time of all 795: the tip of a thorn that the surface cuts off, many times as large
// as the triangles around it.
constexpr double most_far_area = 2;

// Sides of faces by edge, so that the two of one edge are neighbours in the list.
struct Side {
  FeatureEdge edge;
  std::uint32_t corner;  // opposite to it
};

std::vector<Side> sorted_sides(const SurfaceMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    for (std::uint32_t k = 0; k < 3; ++k)
      sides.push_back({feature_edge(mesh.triangles[f][(k + 1) % 3], mesh.triangles[f][(k + 2) % 3]), 3 * f + k});
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.edge < b.edge; });
  return sides;
}

// Points of a grid over all faces, each once: calls visit(face, point) until it says false, and returns whether it did
// not.
template <class Visit>
bool for_each_sample(const SurfaceMesh& mesh, const Visit& visit) {
  std::vector<bool> is_done(mesh.vertices.size(), false);
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3 u = (mesh.vertices[t[1]] - a) / grid, v = (mesh.vertices[t[2]] - a) / grid;
    for (int i = 0; i <= grid; ++i)
      for (int j = 0; i + j <= grid; ++j) {
        const int k = grid - i - j;
        if ((i == 0) + (j == 0) + (k == 0) == 2) {
          const std::uint32_t corner = k > 0 ? t[0] : i > 0 ? t[1] : t[2];
          if (is_done[corner]) continue;
          is_done[corner] = true;
        }
        // The two faces at an edge run along it in opposite ways.
        if ((i == 0 && j > 0 && k > 0 && t[2] > t[0]) || (j == 0 && i > 0 && k > 0 && t[0] > t[1]) ||
            (k == 0 && i > 0 && j > 0 && t[1] > t[2]))
          continue;
        if (!visit(f, a + i * u + j * v)) return false;
      }
  }
  return true;
}

// Where the face of the point before is near enough, no other need be asked.
bool is_within(const SurfaceMesh& mesh, std::uint32_t face, const Vec3& p, double distance) {
  const auto& [a, b, c] = mesh.triangles[face];
  const Vec3 there = closest_point_on_triangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
  return (p - there).squaredNorm() <= distance * distance;
}

Location place_of(const SurfaceMesh& mesh, std::uint32_t face, const Vec3& p) {
  const auto& [a, b, c] = mesh.triangles[face];
  Location place{.face = face};
  place.barycentric = nearest_in_triangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], place.clamped);
  return place;
}

// Of more than two faces: a flip in a patch may join two vertices of its rim that the surface around joins, too.
bool has_crowded_edge(const SurfaceMesh& mesh) {
  const std::vector<Side> sides = sorted_sides(mesh);
  for (std::size_t i = 2; i < sides.size(); ++i)
    if (sides[i].edge == sides[i - 2].edge) return true;
  return false;
}

}  // namespace

std::vector<FeatureEdge> Trial::edges_on_lines() const {
  std::vector<FeatureEdge> edges;
  for (const LineEdge& line : lines) edges.push_back(line.edge());
  std::sort(edges.begin(), edges.end());
  return edges;
}

Surroundings::Surroundings(const SurfaceMesh& mesh, const PatchOutline& outline, const SurfaceMesh& patch,
                           const std::vector<std::uint32_t>& around, const SurfaceMesh& scan,
                           const std::vector<std::uint32_t>& scan_faces, const PatchGoal& goal)
    : outline_(outline), goal_(goal) {
  std::vector<std::uint32_t> vertices = outline.vertices;
  frozen_ = part_of(mesh, around, vertices);
  find_rim_normals(patch);
  if (!scan_faces.empty())
    scan_.emplace(scan, scan_faces, patch, frozen_, with_frozen(patch), outline.edge, goal.limit);
}

bool Surroundings::may_help(const SurfaceMesh& patch) const {
  if (!scan_ || !scan_->fit()) return false;
  const double most_far = most_far_area * surface_area(patch), answered = surface_area(scan_->answered());
  if (goal_.for_shape || answered <= most_far) return true;
  const auto far = static_cast<double>(scan_points_beyond(patch, goal_.limit).size());
  return answered * far <= most_far * static_cast<double>(scan_->to_answer().size());
}

double Surroundings::allowance(const Vec3& p) const {
  if (goal_.elsewhere == 0 || (p - goal_.where.centre).norm() <= goal_.where.radius) return 1;
  return goal_.elsewhere / goal_.limit;
}

void Surroundings::find_rim_normals(const SurfaceMesh& patch) {
  const std::vector<Side> sides = sorted_sides(patch);
  std::vector<FeatureEdge> rim;
  for (std::size_t i = 0; i < sides.size();) {
    const bool is_shared = i + 1 < sides.size() && sides[i].edge == sides[i + 1].edge;
    if (!is_shared) rim.push_back(sides[i].edge);
    i += is_shared ? 2 : 1;
  }
  for (const Side& side : sorted_sides(frozen_))
    if (std::binary_search(rim.begin(), rim.end(), side.edge))
      rim_normals_.emplace_back(side.edge, area_vector(frozen_, frozen_.triangles[side.corner / 3]));
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

void Surroundings::fit(Trial& trial, double fidelity) const {
  ShapeFitOptions options;
  options.rounds = 4;
  options.hold_faces_below = 1;
  // The diagonal is that of a piece of the scan: on a tiny one the fidelity would pass 0.1, the most that a fit takes.
  options.fidelity_of_diagonal = std::min(0.09, fidelity / scan_->fit()->diagonal);
  options.lift_tail_of_diagonal = tail_of_limit * goal_.limit / scan_->fit()->diagonal;
  options.most_lift = most_lift;
  options.nearest_vertex_of_scan_vertex = scan_->start_of_fit();
  for (const bool is_held : held_vertices(trial))
    options.constraints.push_back(is_held ? VertexConstraint::fixed : VertexConstraint::free);
  optimise_shape_and_fit(trial.patch, *scan_->fit(), options);
}

// Calls visit(hinge, edge) for each edge between two faces of the patch, or one of it and one of the surface around.
// The patch may move meanwhile.
template <class Visit>
void Surroundings::for_each_hinge(const SurfaceMesh& patch, const Visit& visit) const {
  const std::vector<Side> sides = sorted_sides(patch);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const FeatureEdge edge = sides[i].edge;
    Hinge hinge{sides[i].corner / 3, sides[i].corner % 3, {}, {}};
    if (i + 1 < sides.size() && sides[i + 1].edge == edge) {
      const Triangle& beyond = patch.triangles[sides[i + 1].corner / 3];
      hinge.apex = beyond[sides[i + 1].corner % 3];
      hinge.beyond = area_vector(patch, beyond);
      ++i;
    } else {
      const auto at = std::lower_bound(rim_normals_.begin(), rim_normals_.end(), edge,
                                       [](const auto& rim, const FeatureEdge& wanted) { return rim.first < wanted; });
      if (at == rim_normals_.end() || at->first != edge) continue;
      hinge.beyond = at->second;
    }
    visit(hinge, edge);
  }
}

void Surroundings::measure_shape(Trial& trial) const {
  const SurfaceMesh& patch = trial.patch;
  trial.missing_angles = 0;
  for (const Triangle& t : patch.triangles)
    trial.missing_angles +=
        std::max(0.0, goal_.least_angle_deg -
                          smallest_angle_deg(patch.vertices[t[0]], patch.vertices[t[1]], patch.vertices[t[2]]));
  trial.sharpest_deg = trial.sharpest_on_line_deg = 180;
  const std::vector<FeatureEdge> lines = trial.edges_on_lines();
  for_each_hinge(patch, [&](const Hinge& hinge, const FeatureEdge& edge) {
    const bool on_line = std::binary_search(lines.begin(), lines.end(), edge);
    const double inside_deg = hinge.angle_deg(patch);
    double& sharpest = on_line ? trial.sharpest_on_line_deg : trial.sharpest_deg;
    sharpest = std::min({sharpest, inside_deg, ease_outside * (360 - inside_deg)});
  });
  if (goal_.for_shape) measure_lack(trial);
}

// Corners and edges of the part are as sharp as the part is.
void Surroundings::measure_lack(Trial& trial) const {
  const SurfaceMesh& patch = trial.patch;
  const std::vector<FeatureEdge> lines = trial.edges_on_lines();
  const auto on_line = [&](std::uint32_t a, std::uint32_t b) {
    return std::binary_search(lines.begin(), lines.end(), feature_edge(a, b));
  };
  std::vector<double> of_face(patch.triangles.size(), 0);
  const auto add = [&](std::uint32_t f, double angle_deg) {
    const double lack = std::max(0.0, goal_.least_angle_deg - angle_deg);
    of_face[f] += lack * lack;
  };
  for (std::uint32_t f = 0; f < patch.triangles.size(); ++f) {
    const Triangle& t = patch.triangles[f];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = t[k], next = t[(k + 1) % 3], last = t[(k + 2) % 3];
      if (!on_line(v, next) || !on_line(v, last))
        add(f, angle_deg(patch.vertices[v], patch.vertices[next], patch.vertices[last]));
    }
  }
  for_each_hinge(patch, [&](const Hinge& hinge, const FeatureEdge& edge) {
    if (!std::binary_search(lines.begin(), lines.end(), edge)) add(hinge.face, hinge.angle_deg(patch) / 2);
  });
  trial.lack = std::accumulate(of_face.begin(), of_face.end(), 0.0);
  trial.worst = static_cast<std::uint32_t>(std::max_element(of_face.begin(), of_face.end()) - of_face.begin());
}

bool Surroundings::keeps_shape(Trial& trial, const Trial& now) const {
  for (const Vec3& p : trial.patch.vertices)
    if (!(p.array() > outline_.box.low.array()).all() || !(p.array() < outline_.box.high.array()).all()) return false;
  measure_shape(trial);
  const double least_dihedral_deg = least_dihedral_over_least_angle * goal_.least_angle_deg;
  const bool keeps_angles = goal_.for_shape ? trial.lack <= now.lack : trial.missing_angles <= now.missing_angles;
  return keeps_angles && trial.sharpest_deg >= std::min(least_dihedral_deg, now.sharpest_deg) &&
         trial.sharpest_on_line_deg >= std::min(least_dihedral_deg, now.sharpest_on_line_deg) - turning_about_line_deg;
}

void Surroundings::pull(Trial& trial) const {
  SurfaceMesh& patch = trial.patch;
  const std::vector<bool> held = held_vertices(trial);
  const double near = pulled_within * goal_.limit;
  const std::vector<Vec3> of_scan = scan_points_beyond(patch, well_within * goal_.limit);
  std::vector<PatchPoint> own = own_points_beyond(patch, well_within * goal_.limit);
  for (int round = 0; round < pulls; ++round) {
    const std::vector<Vec3> before = patch.vertices;
    if (goal_.for_shape) open_folds(trial, held);
    if (!of_scan.empty()) {
      const SurfaceMesh on = patch;
      const TriangleTree tree(on);
      std::uint32_t hint = 0;
      for (const Vec3& p : of_scan) {
        const ClosestPoint nearest = tree.closest(p, hint);
        const double allowed = allowance(p) * near;
        hint = nearest.triangle;
        if (nearest.squared_distance > allowed * allowed)
          pull_point(patch, held, place_of(on, hint, nearest.point), p, allowed);
      }
    }
    for (PatchPoint& point : own) {
      const Vec3 p = point_at(patch, point.place);
      const ClosestPoint nearest = scan_->reference().tree().closest(p, point.scan_face);
      point.scan_face = nearest.triangle;
      pull_point(patch, held, point.place, nearest.point, allowance(p) * near);
    }
    if (patch.vertices == before) break;
  }
}

void Surroundings::relax(Trial& trial) const {
  constexpr int sweeps = 50;  // each takes in a ring of edges; patches have a few
  SurfaceMesh& patch = trial.patch;
  const std::vector<bool> held = held_vertices(trial);
  const VertexStars stars(patch);
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (std::uint32_t v = 0; v < held.size(); ++v) {
      if (held[v]) continue;
      patch.vertices[v] = middle_of_neighbours(patch, stars, v);
    }
}

void Surroundings::open_folds(Trial& trial, const std::vector<bool>& held) const {
  const double wanted_deg = 2 * goal_.least_angle_deg + opened_beyond_deg;
  const std::vector<FeatureEdge> lines = trial.edges_on_lines();
  for_each_hinge(trial.patch, [&](const Hinge& hinge, const FeatureEdge& edge) {
    if (hinge.angle_deg(trial.patch) < wanted_deg && !std::binary_search(lines.begin(), lines.end(), edge))
      open_hinge(trial.patch, held, hinge, wanted_deg, longest_opening * outline_.edge);
  });
}

template <class Visit>
bool Surroundings::for_each_scan_point(const SurfaceMesh& patch, double distance, const Visit& visit) const {
  const TriangleTree tree(patch);
  std::uint32_t near = 0;
  for (const Vec3& p : scan_->to_answer()) {
    if (is_within(patch, near, p, distance)) continue;
    ClosestPoint nearest = tree.closest(p, near);
    near = nearest.triangle;
    nearest.squared_distance /= std::pow(allowance(p), 2);
    if (!visit(p, nearest)) return false;
  }
  return true;
}

template <class Visit>
bool Surroundings::for_each_own_point(const SurfaceMesh& patch, const Visit& visit) const {
  const TriangleTree& scan = scan_->reference().tree();
  std::uint32_t hint = scan.leaf_order().front();
  return for_each_sample(patch, [&](std::uint32_t f, const Vec3& p) {
    ClosestPoint nearest = scan.closest(p, hint);
    hint = nearest.triangle;
    nearest.squared_distance /= std::pow(allowance(p), 2);
    return visit(f, p, nearest);
  });
}

std::vector<Vec3> Surroundings::scan_points_beyond(const SurfaceMesh& patch, double distance) const {
  std::vector<Vec3> beyond;
  for_each_scan_point(patch, distance, [&](const Vec3& p, const ClosestPoint& nearest) {
    if (nearest.squared_distance > distance * distance) beyond.push_back(p);
    return true;
  });
  return beyond;
}

std::vector<Surroundings::PatchPoint> Surroundings::own_points_beyond(const SurfaceMesh& patch, double distance) const {
  std::vector<PatchPoint> beyond;
  for_each_own_point(patch, [&](std::uint32_t f, const Vec3& p, const ClosestPoint& nearest) {
    if (nearest.squared_distance > distance * distance) beyond.push_back({place_of(patch, f, p), nearest.triangle});
    return true;
  });
  return beyond;
}

std::vector<bool> Surroundings::held_vertices(const Trial& trial) const {
  std::vector<bool> held(trial.vertices(), false);
  std::copy(outline_.rim.begin(), outline_.rim.end(), held.begin());
  for (const LineEdge& e : trial.lines) held[e.from] = held[e.to] = true;
  return held;
}

bool Surroundings::is_folded(Trial& trial, const Trial& now) const {
  measure_shape(trial);
  return trial.sharpest_deg < 0.5 * std::min(least_dihedral_over_least_angle * goal_.least_angle_deg, now.sharpest_deg);
}

void Surroundings::sample_deviation(Trial& trial, double useful) const {
  const SurfaceMesh& patch = trial.patch;
  trial.certified = false;
  trial.deviation.assign(patch.triangles.size(), 0);
  trial.merit = std::numeric_limits<double>::infinity();
  const double limit = sampled_limit * goal_.limit;
  // Beyond this a single sample makes the merit useless.
  const double far = limit * (1 + std::pow(useful, 0.25));
  const auto is_useful = [&](std::uint32_t f, double squared_distance) {
    trial.deviation[f] = std::max(trial.deviation[f], squared_distance);
    return squared_distance <= far * far;
  };
  if (!for_each_scan_point(patch, limit, [&](const Vec3&, const ClosestPoint& nearest) {
        return is_useful(nearest.triangle, nearest.squared_distance);
      }))
    return;
  for_each_own_point(patch, [&](std::uint32_t f, const Vec3&, const ClosestPoint& nearest) {
    return is_useful(f, nearest.squared_distance);
  });
  for (double& d : trial.deviation) d = std::sqrt(d);
  set_merit(trial);
}

void Surroundings::certify(Trial& trial) const {
  const SurfaceMesh& patch = trial.patch;
  const OneSidedDeviation of_patch = bound_one_sided_deviation(patch, scan_->reference(), {.limit = goal_.limit});
  for (std::size_t f = 0; f < trial.deviation.size(); ++f)
    trial.deviation[f] = std::max(trial.deviation[f], of_patch.upper[f] / allowance(of_patch.farthest[f]));
  if (!scan_->answered().triangles.empty()) {
    const OneSidedDeviation of_scan =
        bound_one_sided_deviation(scan_->answered(), with_frozen(patch), {.limit = goal_.limit});
    const TriangleTree tree(patch);
    for (std::size_t f = 0; f < of_scan.upper.size(); ++f) {
      const double upper = of_scan.upper[f] / allowance(of_scan.farthest[f]);
      if (!(upper > goal_.limit)) continue;
      double& deviation = trial.deviation[tree.closest(of_scan.farthest[f]).triangle];
      deviation = std::max(deviation, upper);
    }
  }
  trial.certified = true;
  set_merit(trial);
}

void Surroundings::set_merit(Trial& trial) const {
  trial.merit = 0;
  const double limit = trial.certified ? goal_.limit : sampled_limit * goal_.limit;
  for (const double d : trial.deviation) trial.merit += std::pow(std::max(0.0, d / limit - 1), 4);
  if (goal_.for_shape) return;
  trial.worst = static_cast<std::uint32_t>(std::max_element(trial.deviation.begin(), trial.deviation.end()) -
                                           trial.deviation.begin());
}

bool Surroundings::is_clear(const Trial& trial) const {
  const SurfaceMesh all = with_frozen(trial.patch);
  if (has_crowded_edge(all)) return false;
  std::vector<std::uint32_t> own(trial.patch.triangles.size());
  std::iota(own.begin(), own.end(), 0U);
  return find_self_intersections(all, own).empty();
}

}  // namespace scan2fea
