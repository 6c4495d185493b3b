#include "preproc/surface/curved/curve_fitter.hpp"

#include "preproc/mesh/numbers.hpp"
#include "preproc/surface/kernel/nearest.hpp"
#include "quality/triangle_measures.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace scan2fea {
namespace {

using Range = tbb::blocked_range<std::size_t>;

// Six nodes a triangle, of which two are its own: a dozen samples for each.
constexpr double samples_a_face = 32;
// A sample farther from a triangle than this part of its edges stands for something else.
constexpr double farthest_of_edge = 0.25;

// The foot of the perpendicular on the curved triangle by Newton's method, from where the plane ones have it; or the
// nearest edge point of the way there.
std::array<double, 3> foot_on(const SixNodeTriangle& x, const Vec3& p, std::array<double, 3> b) {
  constexpr int steps = 2;
  for (int step = 0; step < steps; ++step) {
    const auto [u, v] = tangents(x, b);
    const Vec3 off = p - point_on(x, b);
    const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), det = uu * vv - uv * uv;
    if (!(det > 0)) break;
    b[1] += (vv * off.dot(u) - uv * off.dot(v)) / det;
    b[2] += (uu * off.dot(v) - uv * off.dot(u)) / det;
    b[1] = std::max(0.0, b[1]);
    b[2] = std::max(0.0, b[2]);
    const double sum = b[1] + b[2];
    if (sum > 1) {
      b[1] /= sum;
      b[2] /= sum;
    }
    b[0] = 1 - b[1] - b[2];
  }
  return b;
}

}  // namespace

CurveFitter::CurveFitter(CurvedSurface& surface, CurvedSurface& cut, const std::vector<std::uint32_t>& patch_of_face,
                         const ReferenceSurface& scan)
    : surface_(surface), cut_(cut), scan_(scan), mean_edge_(mean_edge_length(surface.corners)) {
  for (const Triangle& t : surface.corners.triangles)
    edge_of_face_.push_back(equilateral_edge(area_vector(surface.corners, t).norm() / 2, 1));
  edge_of_node_.assign(surface.nodes(), infinity);
  for (std::size_t f = 0; f < edge_of_face_.size(); ++f)
    for (const std::size_t i : surface.nodes_of(f)) edge_of_node_[i] = std::min(edge_of_node_[i], edge_of_face_[f]);
  follow_surface();
  sample_scan(patch_of_face);
}

void CurveFitter::follow_surface() {
  for (std::size_t f = 0; f < cut_.corners.triangles.size(); ++f) {
    const auto to = cut_.nodes_of(f), from = surface_.nodes_of(f);
    for (std::size_t i = 0; i < 6; ++i) cut_.node(to[i]) = surface_.node(from[i]);
  }
}

// As many samples for a small face as for a large one, though the scan has no more triangles there.
void CurveFitter::sample_scan(const std::vector<std::uint32_t>& patch_of_face) {
  const SurfaceMesh fine = in_four(cut_);
  std::vector<std::uint32_t> nearest;
  if (patch_of_face.empty()) {
    nearest = nearest_vertices(scan_.mesh.vertices, scan_.vertex_normals, fine, mean_edge_ / 2);
  } else {
    std::vector<std::uint32_t> patch(fine.vertices.size());
    for (std::size_t q = 0; q < fine.triangles.size(); ++q)
      for (const std::uint32_t v : fine.triangles[q]) patch[v] = patch_of_face[q / 4];
    nearest = nearest_vertices_of_patch(scan_.mesh.vertices, scan_.vertex_normals, scan_.patch_of_vertex, fine, patch,
                                        mean_edge_ / 2);
  }
  const VertexStars stars(fine);
  const auto face_near = [&](std::uint32_t v) { return stars.corners(nearest[v]).front() / 3; };
  std::vector<double> count;
  for (const Triangle& t : scan_.mesh.triangles) {
    double edge = 0;
    for (const std::uint32_t v : t) edge += edge_of_face_[face_near(v) / 4] / 3;
    count.push_back(samples_a_face * area_vector(scan_.mesh, t).norm() / 2 / (equilateral_area * edge * edge));
  }
  samples_ = sample_surface(scan_, count);
  face_of_sample_.resize(samples_.samples.size());
  locations_.resize(samples_.samples.size());
  for (std::size_t s = 0; s < face_of_sample_.size(); ++s) face_of_sample_[s] = face_near(samples_.vertex[s]);
}

void CurveFitter::locate_samples() {
  const SurfaceMesh fine = in_four(cut_);
  const MeshAdjacency adjacency(fine);
  const std::vector<Vec3> normals = face_normals(fine);
  const WalkableMesh on{fine, adjacency.stars, adjacency.neighbours, normals};
  tbb::parallel_for(Range(0, locations_.size(), 512), [&](const Range& range) {
    for (std::size_t s = range.begin(); s < range.end(); ++s) {
      const double farthest = farthest_of_edge * edge_of_face_[face_of_sample_[s] / 4];
      const Location plane = locate(on, samples_.samples[s], face_of_sample_[s], farthest);
      face_of_sample_[s] = plane.face;
      const std::uint32_t f = plane.face / 4;
      locations_[s] = {
          f, plane.clamped,
          foot_on(cut_.triangle(f), samples_.samples[s].point, in_whole(plane.face % 4, plane.barycentric))};
    }
  });
  first_.assign(cut_.corners.triangles.size() + 1, 0);
  for (const Location& at : locations_) ++first_[at.face + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  order_.resize(locations_.size());
  for (std::uint32_t s = 0; s < locations_.size(); ++s) order_[next[locations_[s].face]++] = s;
}

CurveFitter::Equations CurveFitter::equations_of(std::size_t f, const std::vector<Vec3>& directions) const {
  Equations sum;
  const SixNodeTriangle x = cut_.triangle(f);
  const std::array<std::size_t, 6> nodes = surface_.nodes_of(f);
  const double farthest = farthest_of_edge * edge_of_face_[f];
  for (std::uint32_t k = first_[f]; k < first_[f + 1]; ++k) {
    const Location& at = locations_[order_[k]];
    const Sample& sample = samples_.samples[order_[k]];
    const Vec3 off = sample.point - point_on(x, at.barycentric);
    const double distance = off.norm();
    if (distance > farthest) continue;
    const auto [u, v] = tangents(x, at.barycentric);
    // Beyond a ridge there is no plane to be measured from, but a point.
    const Vec3 along = at.clamped && distance > 0 ? Vec3(off / distance) : Vec3(u.cross(v).normalized());
    const std::array<double, 6> share = shape_functions(at.barycentric);
    std::array<double, 6> factor;
    for (std::size_t i = 0; i < 6; ++i) factor[i] = share[i] * along.dot(directions[nodes[i]]);
    for (std::size_t i = 0; i < 6; ++i) {
      sum.right[i] += sample.weight * factor[i] * off.dot(along);
      for (std::size_t j = 0; j < 6; ++j) sum.matrix[6 * i + j] += sample.weight * factor[i] * factor[j];
    }
  }
  return sum;
}

void CurveFitter::step(const std::vector<Vec3>& directions) {
  locate_samples();
  std::vector<Equations> of_face(cut_.corners.triangles.size());
  tbb::parallel_for(Range(0, of_face.size(), 64), [&](const Range& range) {
    for (std::size_t f = range.begin(); f < range.end(); ++f) of_face[f] = equations_of(f, directions);
  });
  solve(of_face, directions);
  follow_surface();
}

// Nodes without samples, and those that the samples say little of, stay about where they are: each step is damped by a
// small part of what a node of its size has.
void CurveFitter::solve(const std::vector<Equations>& of_face, const std::vector<Vec3>& directions) {
  constexpr double damping = 1e-3, tolerance = 1e-8;
  constexpr Eigen::Index most_iterations = 300;
  const auto n = static_cast<Eigen::Index>(surface_.nodes());
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(of_face.size() * 21 + surface_.nodes());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n), largest = Eigen::VectorXd::Zero(n);
  for (std::size_t f = 0; f < of_face.size(); ++f) {
    const std::array<std::size_t, 6> nodes = surface_.nodes_of(f);
    // Integrals of the squares of the shape functions: A / 30 and 8 A / 45.
    const double area = area_vector(surface_.corners, surface_.corners.triangles[f]).norm() / 2;
    for (std::size_t i = 0; i < 6; ++i) {
      const auto row = static_cast<Eigen::Index>(nodes[i]);
      right[row] += of_face[f].right[i];
      largest[row] += area * (i < 3 ? 1.0 / 30 : 8.0 / 45);
      for (std::size_t j = 0; j < 6; ++j)
        if (nodes[j] <= nodes[i])
          entries.emplace_back(row, static_cast<Eigen::Index>(nodes[j]), of_face[f].matrix[6 * i + j]);
    }
  }
  for (Eigen::Index i = 0; i < n; ++i) entries.emplace_back(i, i, damping * largest[i]);
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower> solver;
  solver.setTolerance(tolerance);
  solver.setMaxIterations(most_iterations);
  const Eigen::VectorXd moves = solver.compute(matrix).solve(right);
  for (std::size_t i = 0; i < surface_.nodes(); ++i) {
    const double farthest = farthest_of_edge * edge_of_node_[i];
    surface_.node(i) += std::clamp(moves[static_cast<Eigen::Index>(i)], -farthest, farthest) * directions[i];
  }
}

}  // namespace scan2fea
