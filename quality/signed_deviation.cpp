#include "quality/signed_deviation.hpp"

#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <cstdint>

namespace scan2fea {
namespace {

// The larger one by size; the first of equals.
double farther(double a, double b) {
  return std::abs(b) > std::abs(a) ? b : a;
}

double signed_distance(const Vec3& place, const Vec3& outward, const TriangleTree& reference) {
  const ClosestPoint nearest = reference.closest(place);
  return std::copysign(std::sqrt(nearest.squared_distance), outward.dot(place - nearest.point));
}

constexpr double third = 1.0 / 3;
constexpr std::array<std::array<double, 3>, 7> places{
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0.5, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {third, third, third}}};

}  // namespace

std::vector<double> signed_deviations(const SurfaceMesh& mesh, const TriangleTree& reference) {
  std::vector<double> deviations(mesh.triangles.size());
  tbb::parallel_for(std::size_t{0}, deviations.size(), [&](std::size_t f) {
    const auto& [a, b, c] = mesh.triangles[f];
    const Vec3 outward = area_vector(mesh, mesh.triangles[f]);
    double deviation = 0;
    for (const auto& [u, v, w] : places)
      deviation = farther(deviation, signed_distance(u * mesh.vertices[a] + v * mesh.vertices[b] + w * mesh.vertices[c],
                                                     outward, reference));
    deviations[f] = deviation;
  });
  return deviations;
}

std::vector<double> signed_deviations(const TetMesh& mesh, const TriangleTree& reference) {
  std::vector<double> deviations(mesh.outer_faces());
  tbb::parallel_for(std::size_t{0}, deviations.size(), [&](std::size_t f) {
    const SixNodeTriangle nodes = boundary_face_nodes(mesh, mesh.boundary[f]);
    double deviation = 0;
    for (const std::array<double, 3>& place : places) {
      const auto [u, v] = tangents(nodes, place);
      deviation = farther(deviation, signed_distance(point_on(nodes, place), u.cross(v), reference));
    }
    deviations[f] = deviation;
  });
  return deviations;
}

std::vector<double> signed_deviations_of_reference(const SurfaceMesh& reference, const SurfaceMesh& mesh,
                                                   const TriangleTree& tree) {
  std::vector<double> of_vertices(reference.vertices.size());
  tbb::parallel_for(std::size_t{0}, of_vertices.size(), [&](std::size_t v) {
    const Vec3& place = reference.vertices[v];
    const ClosestPoint nearest = tree.closest(place);
    const Vec3 outward = area_vector(mesh, mesh.triangles[nearest.triangle]);
    of_vertices[v] = std::copysign(std::sqrt(nearest.squared_distance), outward.dot(nearest.point - place));
  });
  std::vector<double> deviations;
  deviations.reserve(reference.triangles.size());
  for (const auto& [a, b, c] : reference.triangles)
    deviations.push_back(farther(farther(of_vertices[a], of_vertices[b]), of_vertices[c]));
  return deviations;
}

}  // namespace scan2fea
