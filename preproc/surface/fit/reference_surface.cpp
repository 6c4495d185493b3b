#include "preproc/surface/fit/reference_surface.hpp"

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

}  // namespace scan2fea
