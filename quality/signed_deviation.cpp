#include "quality/signed_deviation.hpp"

#include "quality/curved_surface.hpp"
#include "quality/validity.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <span>

namespace scan2fea {
namespace {

// -1 where what the mesh encloses lies on the side of its normals.
double outward_sign(const SurfaceMesh& mesh) {
  return enclosed_volume(mesh) < 0 && encloses_volume(mesh) ? -1 : 1;
}

double outward_sign(const TetMesh& mesh) {
  return total_volume(mesh) < 0 ? -1 : 1;
}

// Of places near one another, each answer is where the search for the next one begins.
class SignedDistances {
 public:
  explicit SignedDistances(const TriangleTree& tree) : tree_(tree) {}

  ClosestPoint nearest(const Vec3& place) {
    const ClosestPoint found = last_ ? tree_.closest(place, *last_) : tree_.closest(place);
    last_ = found.triangle;
    return found;
  }
  double from(const Vec3& place, const Vec3& outward) {
    const ClosestPoint found = nearest(place);
    return std::copysign(std::sqrt(found.squared_distance), outward.dot(place - found.point));
  }

 private:
  const TriangleTree& tree_;
  std::optional<std::uint32_t> last_;
};

// Calls work(index, distances) for all indices, in blocks that are the same for any number of threads.
template <class Work>
void for_each_near_the_last(std::size_t count, const TriangleTree& tree, const Work& work) {
  constexpr std::size_t block = 256;
  tbb::parallel_for(std::size_t{0}, (count + block - 1) / block, [&](std::size_t b) {
    SignedDistances distances(tree);
    for (std::size_t i = block * b; i < std::min(count, block * (b + 1)); ++i) work(i, distances);
  });
}

constexpr double third = 1.0 / 3;
struct Place {
  std::array<double, 3> at;  // barycentric
  double weight;
};
constexpr std::array<Place, 7> places{{{{1, 0, 0}, 0.05},
                                       {{0, 1, 0}, 0.05},
                                       {{0, 0, 1}, 0.05},
                                       {{0.5, 0.5, 0}, 2.0 / 15},
                                       {{0, 0.5, 0.5}, 2.0 / 15},
                                       {{0.5, 0, 0.5}, 2.0 / 15},
                                       {{third, third, third}, 0.45}}};

// `normals`: of any length; 0 for nodes that are passed over.
std::vector<double> deviations_along(const std::vector<Vec3>& nodes, const std::vector<Vec3>& normals,
                                     const TriangleTree& reference) {
  std::vector<double> deviations(nodes.size(), std::numeric_limits<double>::quiet_NaN());
  for_each_near_the_last(nodes.size(), reference, [&](std::size_t n, SignedDistances& distances) {
    if (!normals[n].isZero(0)) deviations[n] = distances.from(nodes[n], normals[n]);
  });
  return deviations;
}

// `face`: per triangle, which of so many faces it is of. `sign`: see outward_sign.
std::vector<double> means_of_points(const std::vector<Vec3>& points, const SurfaceMesh& mesh,
                                    std::span<const std::uint32_t> face, std::size_t faces, double sign) {
  const TriangleTree tree(mesh);
  std::vector<ClosestPoint> nearest(points.size());
  for_each_near_the_last(points.size(), tree,
                         [&](std::size_t i, SignedDistances& distances) { nearest[i] = distances.nearest(points[i]); });
  std::vector<double> means(faces, 0);
  std::vector<std::size_t> counts(faces, 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ClosestPoint& found = nearest[i];
    const Vec3 outward = sign * area_vector(mesh, mesh.triangles[found.triangle]);
    means[face[found.triangle]] +=
        std::copysign(std::sqrt(found.squared_distance), outward.dot(found.point - points[i]));
    ++counts[face[found.triangle]];
  }
  for (std::size_t f = 0; f < faces; ++f) means[f] /= static_cast<double>(counts[f]);  // 0/0 is NaN
  return means;
}

}  // namespace

std::vector<double> signed_deviations_of_nodes(const SurfaceMesh& mesh, const TriangleTree& reference) {
  std::vector<Vec3> normals(mesh.vertices.size(), Vec3::Zero());
  const double sign = outward_sign(mesh);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) normals[v] += sign * area_vector(mesh, t);
  return deviations_along(mesh.vertices, normals, reference);
}

std::vector<double> signed_deviations_of_nodes(const TetMesh& mesh, const TriangleTree& reference) {
  std::vector<Vec3> normals(mesh.nodes.size(), Vec3::Zero());
  const double sign = outward_sign(mesh);
  for (std::size_t f = 0; f < mesh.outer_faces(); ++f) {
    const Vec3 area = sign * face_vector_area(mesh, mesh.boundary[f]);
    for (const std::uint32_t n : boundary_triangle(mesh, mesh.boundary[f])) normals[n] += area;
    if (mesh.order() == 2)
      for (const std::uint32_t n : boundary_mid_edge_nodes(mesh, mesh.boundary[f])) normals[n] += area;
  }
  return deviations_along(mesh.nodes, normals, reference);
}

std::vector<double> signed_deviations(const SurfaceMesh& mesh, const TriangleTree& reference) {
  std::vector<double> deviations(mesh.triangles.size());
  const double sign = outward_sign(mesh);
  for_each_near_the_last(deviations.size(), reference, [&](std::size_t f, SignedDistances& distances) {
    const auto& [a, b, c] = mesh.triangles[f];
    const Vec3 outward = sign * area_vector(mesh, mesh.triangles[f]);
    for (const auto& [at, weight] : places)
      deviations[f] +=
          weight *
          distances.from(at[0] * mesh.vertices[a] + at[1] * mesh.vertices[b] + at[2] * mesh.vertices[c], outward);
  });
  return deviations;
}

std::vector<double> signed_deviations(const TetMesh& mesh, const TriangleTree& reference) {
  std::vector<double> deviations(mesh.outer_faces());
  const double sign = outward_sign(mesh);
  for_each_near_the_last(deviations.size(), reference, [&](std::size_t f, SignedDistances& distances) {
    const SixNodeTriangle nodes = boundary_face_nodes(mesh, mesh.boundary[f]);
    for (const auto& [at, weight] : places) {
      const auto [u, v] = tangents(nodes, at);
      deviations[f] += weight * distances.from(point_on(nodes, at), sign * u.cross(v));
    }
  });
  return deviations;
}

std::vector<double> signed_deviations_of_reference(const SurfaceMesh& reference, const SurfaceMesh& mesh,
                                                   const TriangleTree& tree) {
  std::vector<double> of_vertices(reference.vertices.size());
  const double sign = outward_sign(mesh);
  for_each_near_the_last(of_vertices.size(), tree, [&](std::size_t v, SignedDistances& distances) {
    const Vec3& place = reference.vertices[v];
    const ClosestPoint nearest = distances.nearest(place);
    const Vec3 outward = sign * area_vector(mesh, mesh.triangles[nearest.triangle]);
    of_vertices[v] = std::copysign(std::sqrt(nearest.squared_distance), outward.dot(nearest.point - place));
  });
  std::vector<double> deviations;
  deviations.reserve(reference.triangles.size());
  for (const auto& [a, b, c] : reference.triangles)
    deviations.push_back((of_vertices[a] + of_vertices[b] + of_vertices[c]) / 3);
  return deviations;
}

std::vector<double> signed_deviations_from_points(const std::vector<Vec3>& points, const SurfaceMesh& mesh) {
  std::vector<std::uint32_t> itself(mesh.triangles.size());
  std::iota(itself.begin(), itself.end(), 0U);
  return means_of_points(points, mesh, itself, mesh.triangles.size(), outward_sign(mesh));
}

std::vector<double> signed_deviations_from_points(const std::vector<Vec3>& points, const TetMesh& mesh) {
  const std::span outer(mesh.boundary.data(), mesh.outer_faces());
  if (mesh.order() == 2) {
    const FlatPieces flat = flat_pieces(mesh, outer, flat_enough_of_diagonal * bounding_box(points).diagonal());
    return means_of_points(points, flat.mesh, flat.of_piece, outer.size(), outward_sign(mesh));
  }
  return signed_deviations_from_points(points, outer_corner_faces(mesh));
}

}  // namespace scan2fea
