#include "preproc/surface/reference_surface.hpp"

namespace scan2fea {

// Qualified calls: the members have the functions' names.
ReferenceSurface::ReferenceSurface(const SurfaceMesh& scan)
    : mesh(scan),
      stars(scan),
      neighbours(scan2fea::face_neighbours(scan, stars)),
      face_normals(scan2fea::face_normals(scan)),
      vertex_normals(scan2fea::vertex_normals(scan)),
      diagonal(bounding_box(scan.vertices).diagonal()),
      area(surface_area(scan)) {}

}  // namespace scan2fea
