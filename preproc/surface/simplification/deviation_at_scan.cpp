#include "preproc/surface/simplification/deviation_at_scan.hpp"

#include "preproc/surface/kernel/nearest.hpp"

#include <algorithm>

namespace scan2fea {

std::vector<double> deviation_at_scan(const SurfaceMesh& mesh, const ReferenceSurface& scan,
                                      const DeviationBound& bound) {
  const std::vector<std::uint32_t> face_of_scan_vertex = nearest_faces(scan.mesh.vertices, mesh);

  // What each face answers for: its own points, and the scan's faces around the scan vertices that are nearest to it.
  std::vector<double> of_face = bound.to_reference.lower;
  for (std::size_t f = 0; f < scan.mesh.triangles.size(); ++f) {
    for (const std::uint32_t v : scan.mesh.triangles[f]) {
      double& deviation = of_face[face_of_scan_vertex[v]];
      deviation = std::max(deviation, bound.to_mesh.lower[f]);
    }
  }
  std::vector<double> of_star(mesh.vertices.size(), 0);
  for (std::size_t f = 0; f < of_face.size(); ++f)
    for (const std::uint32_t v : mesh.triangles[f]) of_star[v] = std::max(of_star[v], of_face[f]);
  for (std::size_t f = 0; f < of_face.size(); ++f) {
    const auto& [a, b, c] = mesh.triangles[f];
    of_face[f] = std::max(of_face[f], (of_star[a] + of_star[b] + of_star[c]) / 3);
  }

  std::vector<double> deviation(scan.mesh.vertices.size());
  for (std::size_t v = 0; v < deviation.size(); ++v) deviation[v] = of_face[face_of_scan_vertex[v]];
  // Where the mesh is finer than the scan, many faces are nearest to no scan vertex.
  const std::vector<std::uint32_t> scan_face = nearest_faces(centroids(mesh), scan.mesh);
  for (std::size_t f = 0; f < scan_face.size(); ++f)
    for (const std::uint32_t v : scan.mesh.triangles[scan_face[f]]) deviation[v] = std::max(deviation[v], of_face[f]);
  return deviation;
}

}  // namespace scan2fea
