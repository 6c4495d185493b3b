#include "preproc/mesh/surface_mesh.hpp"

namespace scan2fea {

BoundingBox bounding_box(const std::vector<Vec3>& points) {
  if (points.empty()) return {};
  BoundingBox box{points.front(), points.front()};
  for (const Vec3& p : points) {
    box.low = box.low.cwiseMin(p);
    box.high = box.high.cwiseMax(p);
  }
  return box;
}

void append(SurfaceMesh& mesh, const SurfaceMesh& more) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& [a, b, c] : more.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
}

std::vector<Vec3> centroids(const SurfaceMesh& mesh) {
  std::vector<Vec3> result;
  result.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) result.push_back(centroid(mesh, t));
  return result;
}

double enclosed_volume(const SurfaceMesh& mesh) {
  const BoundingBox box = bounding_box(mesh.vertices);
  const Vec3 centre = 0.5 * (box.low + box.high);
  double six_volumes = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - centre;
    const Vec3 b = mesh.vertices[t[1]] - centre;
    const Vec3 c = mesh.vertices[t[2]] - centre;
    six_volumes += a.dot(b.cross(c));
  }
  return six_volumes / 6;
}

double surface_area(const SurfaceMesh& mesh) {
  double twice_area = 0;
  for (const Triangle& t : mesh.triangles) twice_area += area_vector(mesh, t).norm();
  return twice_area / 2;
}

double mean_edge_length(const SurfaceMesh& mesh) {
  if (mesh.triangles.empty()) return 0;
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) sum += (mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]).norm();
  return sum / (3 * static_cast<double>(mesh.triangles.size()));
}

}  // namespace scan2fea
