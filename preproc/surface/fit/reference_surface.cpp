#include "preproc/surface/fit/reference_surface.hpp"

#include "preproc/surface/kernel/components.hpp"

#include <algorithm>

namespace scan2fea {

// Qualified calls: the members have the functions' names.
ReferenceSurface::ReferenceSurface(const SurfaceMesh& cut, const SurfaceMesh& scan)
    : mesh(cut),
      whole(scan),
      stars(cut),
      neighbours(scan2fea::face_neighbours(cut, stars)),
      face_normals(scan2fea::face_normals(cut)),
      vertex_normals(scan2fea::vertex_normals(cut)),
      diagonal(bounding_box(cut.vertices).diagonal()),
      area(surface_area(cut)) {}

ReferenceSurface::ReferenceSurface(const SurfaceMesh& scan) : ReferenceSurface(scan, scan) {}

ReferenceSurface::ReferenceSurface(const FeatureScan& scan) : ReferenceSurface(scan.cut.mesh, scan.scan) {
  patch_of_vertex = scan.patches.of_vertex;
}

void ReferenceSurface::measure_by_body() {
  const Components bodies = find_components(whole);
  if (bodies.count < 2) return;
  diagonal_of_body = diagonals(whole, bodies);
  diagonal = *std::max_element(diagonal_of_body.begin(), diagonal_of_body.end());
  body_of_vertex.resize(mesh.vertices.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) body_of_vertex[mesh.triangles[f][k]] = bodies.of_vertex[whole.triangles[f][k]];
}

}  // namespace scan2fea
