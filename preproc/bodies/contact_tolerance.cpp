#include "preproc/bodies/body_complex.hpp"
#include "preproc/bodies/facing_surface.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace scan2fea {
namespace {

// Of the smaller diagonal: surfaces that are farther apart do not stand for one another.
constexpr double farthest = 0.01;
constexpr double rounding_of_contact = 1e-5;  // of the larger diagonal
// A strip of width w that turns by an angle a to the next is w / 2 tan(a / 4) off its arc; a regular triangle of that
// height, whose corners lie on a ball, eight thirds of it.
constexpr double of_triangles = 8.0 / 3 / 2;
// The largest sagitta is the tolerance, but no more than so many times what nearly all triangles have: a few spikes of
// a scan are none.
constexpr double quantile = 0.95, most_over_quantile = 4;

class Sagittas {
 public:
  explicit Sagittas(const SurfaceMesh& mesh)
      : mesh_(mesh), normals_(face_normals(mesh)), neighbours_(MeshAdjacency(mesh).neighbours) {
    find_rims();
  }

  // The largest towards the neighbours to which the surface is smooth.
  double of(std::uint32_t f) const {
    double largest = 0;
    const double area = area_vector(mesh_, mesh_.triangles[f]).norm();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t n = neighbours_[f][k];
      if (n == no_face || normals_[f].dot(normals_[n]) < facing) continue;
      const Triangle& t = mesh_.triangles[f];
      const double edge = (mesh_.vertices[t[(k + 1) % 3]] - mesh_.vertices[t[(k + 2) % 3]]).norm();
      const double angle = std::acos(std::min(1.0, normals_[f].dot(normals_[n])));
      if (edge > 0) largest = std::max(largest, of_triangles * area / edge * std::tan(angle / 4));
    }
    return largest;
  }

  // Of the rims around a triangle, on their arcs.
  double of_rims(std::uint32_t f) const {
    double largest = 0;
    const Triangle& t = mesh_.triangles[f];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[(k + 1) % 3], b = t[(k + 2) % 3];
      if (!is_rim(f, k)) continue;
      for (const auto& [from, over] : {std::pair(a, b), std::pair(b, a)})
        for (const std::uint32_t to : rim_ends_[over]) {
          const Vec3 way = mesh_.vertices[over] - mesh_.vertices[from], on = mesh_.vertices[to] - mesh_.vertices[over];
          const double cosine = way.normalized().dot(on.normalized());
          if (to != from && cosine >= facing)
            largest = std::max(largest, way.norm() / 2 * std::tan(std::acos(std::min(1.0, cosine)) / 4));
        }
    }
    return largest;
  }

 private:
  bool is_rim(std::uint32_t f, std::size_t k) const {
    const std::uint32_t n = neighbours_[f][k];
    return n != no_face && normals_[f].dot(normals_[n]) < facing;
  }

  void find_rims() {
    rim_ends_.resize(mesh_.vertices.size());
    for (std::uint32_t f = 0; f < mesh_.triangles.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k)
        if (is_rim(f, k)) rim_ends_[mesh_.triangles[f][(k + 1) % 3]].push_back(mesh_.triangles[f][(k + 2) % 3]);
    for (std::uint32_t f = 0; f < mesh_.triangles.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k)
        if (is_rim(f, k)) rim_ends_[mesh_.triangles[f][(k + 2) % 3]].push_back(mesh_.triangles[f][(k + 1) % 3]);
  }

  const SurfaceMesh& mesh_;
  std::vector<Vec3> normals_;
  std::vector<Triangle> neighbours_;
  std::vector<std::vector<std::uint32_t>> rim_ends_;  // per vertex
};

double largest_sagitta(const SurfaceMesh& mesh, std::vector<std::uint32_t> triangles) {
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  if (triangles.empty()) return 0;
  const Sagittas sagittas(mesh);
  std::vector<double> all;
  for (const std::uint32_t f : triangles) all.push_back(std::max(sagittas.of(f), sagittas.of_rims(f)));
  const auto at = static_cast<std::ptrdiff_t>(quantile * static_cast<double>(all.size() - 1));
  std::nth_element(all.begin(), all.begin() + at, all.end());
  return std::min(*std::max_element(all.begin(), all.end()), most_over_quantile * all[static_cast<std::size_t>(at)]);
}

}  // namespace

double contact_tolerance(const SurfaceMesh& first, std::span<const std::uint32_t> of_first, const SurfaceMesh& second,
                         std::span<const std::uint32_t> of_second) {
  const double diagonal_first = bounding_box(first.vertices).diagonal();
  const double diagonal_second = bounding_box(second.vertices).diagonal();
  const double reach = farthest * std::min(diagonal_first, diagonal_second);
  const double fuzz = rounding_of_contact * std::max(diagonal_first, diagonal_second);
  const FacingSurface on_first(first, of_first, fuzz), on_second(second, of_second, fuzz);
  std::vector<std::uint32_t> near_first, near_second;
  for (const std::uint32_t f : of_first)
    if (const auto foot = on_second.under(centroid(first, first.triangles[f]), on_first.normal(f), reach)) {
      near_first.push_back(f);
      near_second.push_back(foot->triangle);
    }
  for (const std::uint32_t f : of_second)
    if (const auto foot = on_first.under(centroid(second, second.triangles[f]), on_second.normal(f), reach)) {
      near_second.push_back(f);
      near_first.push_back(foot->triangle);
    }
  return std::min(reach, largest_sagitta(first, near_first) + largest_sagitta(second, near_second)) + fuzz;
}

}  // namespace scan2fea
