#include "preproc/surface/fit/fitter.hpp"

#include "preproc/surface/kernel/nearest.hpp"
#include "preproc/surface/kernel/rings.hpp"

#include <Eigen/LU>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace scan2fea {
namespace {

using Range = tbb::blocked_range<std::size_t>;

// A step of more than this part of the smallest edge or height around a vertex could turn a triangle over.
constexpr double longest_step = 0.3;
// More samples a face than this do not improve the fit; on a scan far finer than the mesh they would take its time and
// memory.
constexpr std::size_t most_samples_per_face = 12;
// The same for parts with edges: planes and cylinders need fewer.
constexpr std::size_t most_samples_per_face_of_parts = 6;
// Scan triangles longer than this part of the mean edge are subdivided, so that each face gets samples.
constexpr double longest_scan_edge = 0.7;
// Residuals beyond this part of the mean edge are suspected of a wrong location.
constexpr double suspicious_part_of_edge = 0.2;

double square(double x) {
  return x * x;
}

constexpr double third = 1. / 3;
constexpr std::array<std::array<double, 3>, 4> face_samples{
    {{third, third, third}, {2. / 3, 1. / 6, 1. / 6}, {1. / 6, 2. / 3, 1. / 6}, {1. / 6, 1. / 6, 2. / 3}}};

std::uint32_t nearest_corner(const SurfaceMesh& mesh, const Location& at) {
  const auto largest = std::max_element(at.barycentric.begin(), at.barycentric.end());
  return mesh.triangles[at.face][static_cast<std::size_t>(largest - at.barycentric.begin())];
}

// One array after the other: a copy of all of them at once would be the peak of a large scan's memory.
template <class Item>
void reorder(std::vector<Item>& items, const std::vector<std::uint32_t>& order) {
  std::vector<Item> sorted;
  sorted.reserve(order.size());
  for (const std::uint32_t i : order) sorted.push_back(items[i]);
  items = std::move(sorted);
}

}  // namespace

Fitter::Fitter(SurfaceMesh& mesh, const ReferenceSurface& scan, const ShapeFitOptions& options,
               std::vector<std::uint32_t> patch_of_vertex)
    : mesh_(mesh),
      scan_(scan),
      options_(options),
      patch_of_vertex_(std::move(patch_of_vertex)),
      stars_(mesh),
      neighbours_(face_neighbours(mesh, stars_)),
      colours_(colour_vertices(mesh, stars_)),
      mean_edge_(scan.mean_edge(mesh.triangles.size())),
      forward_(sample_surface(scan, longest_scan_edge * mean_edge_,
                              (scan.patch_of_vertex.empty() ? most_samples_per_face : most_samples_per_face_of_parts) *
                                  mesh.triangles.size())),
      fits_(mesh.triangles.size()),
      point_fits_(mesh.triangles.size()) {
  set_fidelity(options.fidelity_of_diagonal);
  start_locations();
}

void Fitter::set_fidelity(double fidelity) {
  const double unit = fidelity * scan_.diagonal;
  weight_unit_ = static_cast<double>(mesh_.triangles.size()) / (scan_.area * unit * unit);
  if (options_.lift_tail_of_diagonal)
    tail_ = *options_.lift_tail_of_diagonal * fidelity / options_.fidelity_of_diagonal * scan_.diagonal;
  weight_of_body_.assign(std::max<std::size_t>(1, scan_.diagonal_of_body.size()), 1);
  for (std::size_t b = 0; b < scan_.diagonal_of_body.size(); ++b)
    weight_of_body_[b] = square(scan_.diagonal / scan_.diagonal_of_body[b]);
}

double Fitter::set_fidelity_by_residual(double factor, double loosest, const ShapeFitResult& located) {
  const auto of = [&](double distance, double diagonal) {
    return std::clamp(factor * distance / diagonal, options_.fidelity_of_diagonal, loosest);
  };
  const double fidelity = of(located.rms_distance, scan_.diagonal);
  set_fidelity(fidelity);
  for (std::size_t b = 0; b < scan_.diagonal_of_body.size(); ++b)
    weight_of_body_[b] *= square(fidelity / of(distance_of_body_[b], scan_.diagonal_of_body[b]));
  return fidelity;
}

void Fitter::locate_samples(ShapeFitResult& result) {
  normals_ = face_normals(mesh_);
  const WalkableMesh on{mesh_, stars_, neighbours_, normals_};
  tbb::parallel_for(Range(0, locations_.size(), 1024), [&](const Range& range) {
    for (std::size_t s = range.begin(); s < range.end(); ++s) {
      locations_[s] = locate(on, forward_.samples[s], locations_[s].face, suspicious_part_of_edge * mean_edge_);
    }
  });
  const ByFace by_face = sort_by_face(locations_, mesh_.triangles.size());
  if (options_.both_sides) locate_faces(by_face);
  condense_all(by_face, result);
}

double Fitter::sweep(double over_relaxation) {
  std::vector<double> steps(mesh_.vertices.size(), 0);
  for (const std::vector<std::uint32_t>& colour : colours_) {
    tbb::parallel_for(Range(0, colour.size(), 64), [&](const Range& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        if (is_free(colour[i])) steps[colour[i]] = move(colour[i], over_relaxation);
      }
    });
  }
  return *std::max_element(steps.begin(), steps.end());
}

void Fitter::put(std::span<const std::uint32_t> copies, const Vec3& point) {
  for (const std::uint32_t v : copies) mesh_.vertices[v] = point;
}

void Fitter::slide(const FeatureLine& line, double& place, std::span<const std::uint32_t> copies, double backward,
                   double forward) {
  Vec3 gradient = Vec3::Zero();
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  double least_squared_length = std::numeric_limits<double>::infinity();
  for (const std::uint32_t v : copies)
    if (!add_star(v, gradient, hessian, least_squared_length)) return;
  const Vec3 along = direction_at(line, place);
  const double slope = gradient.dot(along), curvature = along.dot(hessian * along);
  if (!(curvature > 0)) return;
  const double limit = longest_step * std::sqrt(least_squared_length);
  double step = std::clamp(-slope / curvature, -std::min(limit, backward), std::min(limit, forward));
  const double before = energy(copies);
  const Vec3 from = mesh_.vertices[copies.front()];
  for (int halving = 0; halving < 3; ++halving, step /= 2) {
    const double trial = advanced(line, place, step);
    put(copies, line.point_at(trial));
    if (energy(copies) < before) {
      place = trial;
      return;
    }
  }
  put(copies, from);
}

double Fitter::energy(std::span<const std::uint32_t> copies) const {
  double sum = 0;
  for (const std::uint32_t v : copies) {
    for (const std::uint32_t corner : stars_.corners(v)) {
      const Triangle& t = mesh_.triangles[corner / 3];
      const std::size_t i = corner % 3;
      sum += shape_energy(options_.shape, mesh_.vertices[t[i]], mesh_.vertices[t[(i + 1) % 3]],
                          mesh_.vertices[t[(i + 2) % 3]])
                 .value +
             change_of_fit(fits_[corner / 3], point_fits_[corner / 3], moved_corners(t));
    }
  }
  return sum;
}

std::array<Vec3, 3> Fitter::moved_corners(const Triangle& t) const {
  return {mesh_.vertices[t[0]] - located_[t[0]], mesh_.vertices[t[1]] - located_[t[1]],
          mesh_.vertices[t[2]] - located_[t[2]]};
}

std::vector<bool> Fitter::vertices_of_interest() const {
  if (options_.constraints.empty()) return std::vector<bool>(mesh_.vertices.size(), true);
  std::vector<bool> of_interest(mesh_.vertices.size());
  for (std::uint32_t v = 0; v < of_interest.size(); ++v) of_interest[v] = is_free(v);
  grow_vertices(mesh_, of_interest, 2);
  return of_interest;
}

bool Fitter::has_free_vertex(std::size_t f) const {
  const Triangle& t = mesh_.triangles[f];
  return is_free(t[0]) || is_free(t[1]) || is_free(t[2]);
}

void Fitter::start_locations() {
  const std::vector<std::uint32_t> nearest =
      options_.nearest_vertex_of_scan_vertex ? *options_.nearest_vertex_of_scan_vertex
      : patch_of_vertex_.empty()
          ? nearest_vertices(scan_.mesh.vertices, scan_.vertex_normals, mesh_, mean_edge_)
          : nearest_vertices_of_patch(scan_.mesh.vertices, scan_.vertex_normals, scan_.patch_of_vertex, mesh_,
                                      patch_of_vertex_, mean_edge_);
  const std::vector<bool> of_interest = vertices_of_interest();
  std::size_t kept = 0;
  for (std::size_t s = 0; s < forward_.samples.size(); ++s) {
    if (!of_interest[nearest[forward_.vertex[s]]]) continue;
    forward_.samples[kept] = forward_.samples[s];
    forward_.vertex[kept] = forward_.vertex[s];
    ++kept;
  }
  forward_.samples.resize(kept);
  forward_.vertex.resize(kept);

  normals_ = face_normals(mesh_);
  const WalkableMesh on{mesh_, stars_, neighbours_, normals_};
  locations_.resize(kept);
  tbb::parallel_for(Range(0, kept, 1024), [&](const Range& range) {
    for (std::size_t s = range.begin(); s < range.end(); ++s) {
      const std::uint32_t start = stars_.corners(nearest[forward_.vertex[s]]).front() / 3;
      locations_[s] = locate(on, forward_.samples[s], start, suspicious_part_of_edge * mean_edge_);
    }
  });
  sort_samples();
}

// Into the order of the faces, which they seldom leave: memory is then read in order from now on.
void Fitter::sort_samples() {
  const ByFace by_face = sort_by_face(locations_, mesh_.triangles.size());
  reorder(forward_.samples, by_face.order);
  reorder(forward_.vertex, by_face.order);
  reorder(locations_, by_face.order);
}

Fitter::ByFace Fitter::sort_by_face(const std::vector<Location>& locations, std::size_t faces) {
  ByFace by{std::vector<std::uint32_t>(faces + 1, 0), std::vector<std::uint32_t>(locations.size())};
  for (const Location& at : locations) ++by.first[at.face + 1];
  std::partial_sum(by.first.begin(), by.first.end(), by.first.begin());
  std::vector<std::uint32_t> next(by.first.begin(), by.first.end() - 1);
  for (std::uint32_t s = 0; s < locations.size(); ++s) by.order[next[locations[s].face]++] = s;
  return by;
}

// The scan's samples lead the way: a face's own samples start where one of them came from.
void Fitter::locate_faces(const ByFace& by_face) {
  const WalkableMesh on{scan_.mesh, scan_.stars, scan_.neighbours, scan_.face_normals};
  const std::size_t faces = mesh_.triangles.size();
  if (on_scan_.empty()) {
    std::vector<std::uint32_t> start(faces, no_face);
    std::vector<std::uint32_t> queue;
    for (std::uint32_t f = 0; f < faces; ++f) {
      if (by_face.first[f] == by_face.first[f + 1]) continue;
      const std::uint32_t v = forward_.vertex[by_face.order[by_face.first[f]]];
      start[f] = scan_.stars.corners(v).front() / 3;
      queue.push_back(f);
    }
    for (std::size_t k = 0; k < queue.size(); ++k) {
      for (const std::uint32_t g : neighbours_[queue[k]]) {
        if (g == no_face || start[g] != no_face) continue;
        start[g] = start[queue[k]];
        queue.push_back(g);
      }
    }
    on_scan_.resize(face_samples.size() * faces);
    for (std::size_t s = 0; s < on_scan_.size(); ++s) {
      const std::uint32_t f = start[s / face_samples.size()];
      on_scan_[s].face = f == no_face ? 0 : f;
    }
  }
  tbb::parallel_for(Range(0, faces, 256), [&](const Range& range) {
    for (std::size_t f = range.begin(); f < range.end(); ++f) {
      for (std::size_t k = 0; k < face_samples.size(); ++k) {
        if (!has_free_vertex(f)) continue;
        const Sample sample{point_at(mesh_, {static_cast<std::uint32_t>(f), false, face_samples[k]}), normals_[f], 0};
        Location& at = on_scan_[face_samples.size() * f + k];
        at = locate(on, sample, at.face, suspicious_part_of_edge * mean_edge_);
      }
    }
  });
}

double Fitter::lift(double squared_distance) const {
  if (!options_.lift_tail_of_diagonal) return 1;
  const double ratio = squared_distance / (tail_ * tail_);
  return std::min(1 + ratio * ratio, options_.most_lift);
}

std::size_t Fitter::body_of(const ByFace& by_face, std::size_t f) const {
  if (weight_of_body_.size() == 1) return 0;
  if (by_face.first[f] < by_face.first[f + 1])
    return scan_.body_of_vertex[forward_.vertex[by_face.order[by_face.first[f]]]];
  return on_scan_.empty() ? 0 : scan_.body_of_vertex[scan_.mesh.triangles[on_scan_[face_samples.size() * f].face][0]];
}

double Fitter::condense(const ByFace& by_face, std::size_t f) {
  const double share = options_.both_sides ? 0.5 : 1.0;
  FaceFit& fit = fits_[f] = {};
  PointFit& points = point_fits_[f] = {};
  double largest = 0;
  fit.normal = normals_[f];
  const double area = area_vector(mesh_, mesh_.triangles[f]).norm() / 2;
  const double held_area = options_.hold_faces_below * scan_.area / static_cast<double>(fits_.size());
  const double body = weight_of_body_[body_of(by_face, f)];
  const double hold = body * (area > 0 ? std::clamp(held_area / area, 1.0, 100.0) : 1.0);
  for (std::uint32_t k = by_face.first[f]; k < by_face.first[f + 1]; ++k) {
    const std::uint32_t s = by_face.order[k];
    const Vec3 to_target = forward_.samples[s].point - point_at(mesh_, locations_[s]);
    const double squared = to_target.squaredNorm(), weight = forward_.samples[s].weight;
    squared_[s] = squared;
    largest = std::max(largest, squared);
    add_sample(fit, points, locations_[s].barycentric, to_target,
               hold * share * weight_unit_ * weight * lift(body * squared), locations_[s].clamped);
  }
  if (!options_.both_sides || !has_free_vertex(f)) return largest;
  for (std::size_t k = 0; k < face_samples.size(); ++k) {
    const Vec3 on_scan = point_at(scan_.mesh, on_scan_[face_samples.size() * f + k]);
    const Vec3 to_target = on_scan - point_at(mesh_, {static_cast<std::uint32_t>(f), false, face_samples[k]});
    const double squared = to_target.squaredNorm();
    squared_on_scan_[face_samples.size() * f + k] = squared;
    largest = std::max(largest, squared);
    add_sample(fit, points, face_samples[k], to_target, hold * share * weight_unit_ * area / 4 * lift(body * squared),
               false);
  }
  return largest;
}

void Fitter::condense_all(const ByFace& by_face, ShapeFitResult& result) {
  located_ = mesh_.vertices;
  squared_.resize(locations_.size());
  squared_on_scan_.resize(on_scan_.size());
  result.largest_distance_of_face.resize(fits_.size());
  tbb::parallel_for(Range(0, fits_.size(), 128), [&](const Range& range) {
    for (std::size_t f = range.begin(); f < range.end(); ++f)
      result.largest_distance_of_face[f] = std::sqrt(condense(by_face, f));
  });
  measure(result);
}

void Fitter::measure(ShapeFitResult& result) {
  double sum = 0, total = 0;
  const auto mean = [&] { return total > 0 ? std::sqrt(sum / total) : 0; };
  for (std::size_t s = 0; s < squared_.size(); ++s) {
    sum += forward_.samples[s].weight * squared_[s];
    total += forward_.samples[s].weight;
  }
  result.rms_distance = mean();
  sum = total = 0;
  for (std::size_t s = 0; s < squared_on_scan_.size(); ++s) {
    const std::size_t f = s / face_samples.size();
    if (!has_free_vertex(f)) continue;
    const double weight = area_vector(mesh_, mesh_.triangles[f]).norm();
    sum += weight * squared_on_scan_[s];
    total += weight;
  }
  result.rms_distance = std::max(result.rms_distance, mean());
  result.largest_distance =
      *std::max_element(result.largest_distance_of_face.begin(), result.largest_distance_of_face.end());
  result.samples = locations_.size() + on_scan_.size();
  result.scan_vertex_of_face.resize(on_scan_.size() / face_samples.size());
  for (std::size_t f = 0; f < result.scan_vertex_of_face.size(); ++f)
    result.scan_vertex_of_face[f] = nearest_corner(scan_.mesh, on_scan_[face_samples.size() * f]);
  measure_bodies();
}

// RMS distance of the scan's samples.
void Fitter::measure_bodies() {
  if (scan_.diagonal_of_body.empty()) return;
  std::vector<double> sum(scan_.diagonal_of_body.size(), 0), total(sum);
  for (std::size_t s = 0; s < locations_.size(); ++s) {
    const std::uint32_t b = scan_.body_of_vertex[forward_.vertex[s]];
    sum[b] += forward_.samples[s].weight * squared_[s];
    total[b] += forward_.samples[s].weight;
  }
  distance_of_body_.assign(sum.size(), 0);
  for (std::size_t b = 0; b < sum.size(); ++b)
    if (total[b] > 0) distance_of_body_[b] = std::sqrt(sum[b] / total[b]);
}

bool Fitter::add_star(std::uint32_t v, Vec3& gradient, Eigen::Matrix3d& hessian, double& least_squared_length) const {
  const Vec3 p = mesh_.vertices[v];
  for (const std::uint32_t corner : stars_.corners(v)) {
    const std::uint32_t f = corner / 3;
    const std::size_t i = corner % 3;
    const Triangle& t = mesh_.triangles[f];
    const Vec3& a = mesh_.vertices[t[(i + 1) % 3]];
    const Vec3& b = mesh_.vertices[t[(i + 2) % 3]];
    const double height_squared = (a - p).cross(b - p).squaredNorm() / (b - a).squaredNorm();
    if (!(height_squared > 0)) return false;
    least_squared_length = std::min({least_squared_length, height_squared, (a - p).squaredNorm()});
    const Derivatives d = shape_energy(options_.shape, p, a, b);
    gradient += d.gradient;
    hessian += d.hessian;
    add_derivatives(fits_[f], point_fits_[f], i, moved_corners(t), gradient, hessian);
  }
  return true;
}

double Fitter::move(std::uint32_t v, double over_relaxation) {
  Vec3 gradient = Vec3::Zero();
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  const Vec3 p = mesh_.vertices[v];
  double least_squared_length = std::numeric_limits<double>::infinity();
  if (!add_star(v, gradient, hessian, least_squared_length)) return 0;
  // The Hessian is positive semi-definite; where nothing holds a vertex along some direction it stays put there.
  hessian.diagonal().array() += 1e-9 * hessian.trace();
  Vec3 step = -over_relaxation * (hessian.inverse() * gradient);
  const double limit = longest_step * std::sqrt(least_squared_length);
  const double length = step.norm();
  if (!std::isfinite(length)) return 0;
  if (length > limit) step *= limit / length;
  mesh_.vertices[v] = p + step;
  return std::min(length, limit);
}

}  // namespace scan2fea
