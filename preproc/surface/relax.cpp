#include "preproc/surface/relax.hpp"

#include "preproc/surface/connectivity.hpp"
#include "preproc/surface/error_sizing.hpp"
#include "preproc/surface/halfedge_mesh.hpp"
#include "preproc/surface/locate.hpp"
#include "preproc/surface/nearest_vertices.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;
using Range = tbb::blocked_range<std::size_t>;

// A step of more than this part of the shortest edge could turn a triangle over.
constexpr double longest_step = 0.4;

// The Voronoi cell of v within the triangle v, a, b: two triangles between v, the edges' middles and the circumcentre,
// pulled back to the opposite edge where the triangle is obtuse there.
Vec3 cell_corner(const Vec3& v, const Vec3& a, const Vec3& b) {
  const Vec3 x = a - v;
  const Vec3 y = b - v;
  const double xx = x.squaredNorm();
  const double yy = y.squaredNorm();
  const double xy = x.dot(y);
  const double determinant = 2 * (xx * yy - xy * xy);
  if (!(determinant > 0)) return v + (x + y) / 3;
  double s = yy * (xx - xy) / determinant;
  double t = xx * (yy - xy) / determinant;
  s = std::max(s, 0.0);
  t = std::max(t, 0.0);
  if (s + t > 1) {
    const double over = (s + t - 1) / 2;
    s -= over;
    t -= over;
  }
  return v + s * x + t * y;
}

class Relaxer {
 public:
  Relaxer(const SurfaceMesh& mesh, const ReferenceSurface& scan, const std::vector<double>& sizing,
          const RelaxOptions& options)
      : scan_(scan), sizing_(sizing), options_(options), mesh_(mesh) {
    const std::vector<std::uint32_t> nearest =
        nearest_vertices(mesh.vertices, vertex_normals(mesh), scan.mesh, mean_edge());
    location_.resize(mesh.vertices.size());
    edge_length_.resize(mesh.vertices.size());
    next_ = mesh_.points;
    tbb::parallel_for(Range(0, location_.size(), 512), [&](const Range& range) {
      for (std::size_t v = range.begin(); v < range.end(); ++v) {
        const Sample sample{mesh.vertices[v], scan.vertex_normals[nearest[v]], 0};
        location_[v] = descend_to_nearest(on_scan(), sample, scan.stars.corners(nearest[v]).front() / 3);
        edge_length_[v] = sizing_at(location_[v]);
      }
    });
    next_edge_length_ = edge_length_;
  }

  // Returns the mean step over the mean edge.
  double sweep() {
    std::vector<double> steps(next_.size(), 0);
    tbb::parallel_for(Range(0, next_.size(), 256), [&](const Range& range) {
      for (std::size_t v = range.begin(); v < range.end(); ++v) {
        const auto index = static_cast<Index>(v);
        next_[v] = mesh_.points[v];
        next_edge_length_[v] = edge_length_[v];
        if (!mesh_.is_alive(index) || mesh_.is_border_vertex(index)) continue;
        next_[v] = moved(index);
        steps[v] = (next_[v] - mesh_.points[v]).norm();
      }
    });
    std::swap(mesh_.points, next_);
    std::swap(edge_length_, next_edge_length_);
    double sum = 0;
    for (const double s : steps) sum += s;
    return sum / static_cast<double>(steps.size()) / mean_edge();
  }

  // One pass of flips towards Delaunay, refused where a triangle would turn over.
  std::size_t flip_to_delaunay() {
    std::size_t flips = 0;
    for (Index h = 0; h < 3 * mesh_.face_slots(); ++h) {
      if (mesh_.is_border(h) || mesh_.opposite(h) < h || !wants_flip(h) || !mesh_.can_flip(h)) continue;
      mesh_.flip(h);
      ++flips;
    }
    return flips;
  }

  SurfaceMesh surface() const { return mesh_.to_surface(); }
  const std::vector<double>& edge_length() const { return edge_length_; }

 private:
  WalkableMesh on_scan() const { return {scan_.mesh, scan_.stars, scan_.neighbours, scan_.face_normals}; }

  double mean_edge() const {
    return std::sqrt(4 / std::numbers::sqrt3 * scan_.area / static_cast<double>(mesh_.face_count()));
  }

  double sizing_at(const Location& at) const {
    const Triangle& t = scan_.mesh.triangles[at.face];
    return at.barycentric[0] * sizing_[t[0]] + at.barycentric[1] * sizing_[t[1]] + at.barycentric[2] * sizing_[t[2]];
  }

  Vec3 normal_at(const Location& at) const {
    const Triangle& t = scan_.mesh.triangles[at.face];
    return (at.barycentric[0] * scan_.vertex_normals[t[0]] + at.barycentric[1] * scan_.vertex_normals[t[1]] +
            at.barycentric[2] * scan_.vertex_normals[t[2]])
        .normalized();
  }

  Vec3 moved(Index v) {
    const Vec3& p = mesh_.points[v];
    Vec3 moment = Vec3::Zero();
    double mass = 0;
    double shortest = std::numeric_limits<double>::infinity();
    const auto add = [&](const Vec3& middle, const Vec3& corner, double h) {
      const double weight = (middle - p).cross(corner - p).norm() / (h * h * h * h);
      moment += weight / 3 * (middle + corner - 2 * p);
      mass += weight;
    };
    mesh_.for_each_outgoing(v, [&](Index h) {
      const Index a = mesh_.target(h);
      const Index b = mesh_.origin(HalfedgeMesh::prev(h));
      const Vec3& pa = mesh_.points[a];
      const Vec3& pb = mesh_.points[b];
      const Vec3 corner = cell_corner(p, pa, pb);
      // The sizing at the centroids of the two parts, linear over the triangle (the corner taken as its centroid).
      const double middle_size = (edge_length_[v] + edge_length_[a] + edge_length_[b]) / 3;
      add((p + pa) / 2, corner, (1.5 * edge_length_[v] + 0.5 * edge_length_[a] + middle_size) / 3);
      add((p + pb) / 2, corner, (1.5 * edge_length_[v] + 0.5 * edge_length_[b] + middle_size) / 3);
      shortest = std::min(shortest, (pa - p).norm());
    });
    if (!(mass > 0)) return p;
    const Vec3 normal = normal_at(location_[v]);
    Vec3 step = options_.over_relaxation * moment / mass;
    step -= step.dot(normal) * normal;
    const double limit = longest_step * shortest;
    if (step.norm() > limit) step *= limit / step.norm();
    location_[v] = locate(on_scan(), {p + step, normal, 0}, location_[v].face, limit);
    next_edge_length_[v] = sizing_at(location_[v]);
    return point_at(scan_.mesh, location_[v]);
  }

  bool wants_flip(Index h) const {
    const Index o = mesh_.opposite(h);
    const Vec3& a = mesh_.points[mesh_.origin(h)];
    const Vec3& b = mesh_.points[mesh_.target(h)];
    const Vec3& c = mesh_.points[mesh_.target(HalfedgeMesh::next(h))];
    const Vec3& d = mesh_.points[mesh_.target(HalfedgeMesh::next(o))];
    const Vec3 normal_c = (a - c).cross(b - c);
    const Vec3 normal_d = (b - d).cross(a - d);
    // Delaunay where the angles at c and d sum up to less than 180 degrees: cot c + cot d > 0.
    const double cotangents = (a - c).dot(b - c) / normal_c.norm() + (b - d).dot(a - d) / normal_d.norm();
    if (!(cotangents < -1e-9)) return false;
    const Vec3 normal = normal_c + normal_d;
    const Vec3 at_a = (d - a).cross(c - a);
    const Vec3 at_b = (c - b).cross(d - b);
    constexpr double least_cosine = 0.5;
    return at_a.dot(normal) > least_cosine * at_a.norm() * normal.norm() &&
           at_b.dot(normal) > least_cosine * at_b.norm() * normal.norm();
  }

  const ReferenceSurface& scan_;
  const std::vector<double>& sizing_;
  const RelaxOptions& options_;
  HalfedgeMesh mesh_;
  std::vector<Location> location_;   // per vertex, on the scan
  std::vector<double> edge_length_;  // per vertex
  // Of the sweep under way: all vertices move at once, so that the order in which threads visit them cannot matter.
  std::vector<Vec3> next_;
  std::vector<double> next_edge_length_;
};

void check(const ReferenceSurface& scan, const std::vector<double>& edge_length, const RelaxOptions& options) {
  if (options.sweeps < 1 || options.passes < 1 || options.sweeps_per_improvement < 1 ||
      !(options.over_relaxation > 0 && options.over_relaxation < 2) ||
      edge_length.size() != scan.mesh.vertices.size()) {
    throw WrongUsage({.what = "relaxation options out of range",
                      .where = "",
                      .value = std::to_string(options.sweeps) + " sweeps, " + std::to_string(options.passes) +
                               " passes, over-relaxation " + std::to_string(options.over_relaxation) + ", sizing of " +
                               std::to_string(edge_length.size()) + " vertices",
                      .limit = "at least 1, at least 1, 0 to 2, " + std::to_string(scan.mesh.vertices.size()),
                      .advice = ""});
  }
}

}  // namespace

RelaxResult relax(SurfaceMesh& mesh, const ReferenceSurface& scan, std::vector<double> edge_length,
                  const RelaxOptions& options, const Progress& progress) {
  check(scan, edge_length, options);
  RelaxResult result;
  const std::size_t triangles = mesh.triangles.size();
  for (int pass = 0; pass < options.passes; ++pass) {
    if (pass > 0) renew_from_error(edge_length, mesh, scan, options.renewal);
    for (int done = 0; done < options.sweeps; done += options.sweeps_per_improvement) {
      progress("relax", (pass + static_cast<double>(done) / options.sweeps) / options.passes);
      Relaxer relaxer(mesh, scan, edge_length, options);
      const int sweeps = std::min(options.sweeps_per_improvement, options.sweeps - done);
      for (int s = 0; s < sweeps; ++s) {
        result.last_step = relaxer.sweep();
        result.flips += relaxer.flip_to_delaunay();
      }
      mesh = relaxer.surface();
      result.edge_length = relaxer.edge_length();
      const bool last = pass + 1 == options.passes && done + options.sweeps_per_improvement >= options.sweeps;
      if (!last) improve_connectivity(mesh, result.edge_length, {.rounds = 1, .triangles = triangles, .welded = {}});
    }
  }
  return result;
}

}  // namespace scan2fea
