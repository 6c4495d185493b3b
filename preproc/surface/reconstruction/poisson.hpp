// A smooth surface near oriented points, by CGAL: Kazhdan, Bolitho and Hoppe, "Poisson surface reconstruction", 2006,
// on a refined Delaunay triangulation.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <vector>

namespace scan2fea {

// Closed, with triangles of about `spacing`, model units; its vertices are no points of the cloud, and creases come out
// round. `normals`: one a point, outwards, any length but zero. Empty where CGAL finds none. About 200 us a point; CGAL
// offers no way to stop it. Not guaranteed: the same triangles each time, since CGAL's mesher goes by where things lie
// in memory.
SurfaceMesh poisson_surface(const std::vector<Vec3>& points, const std::vector<Vec3>& normals, double spacing);

}  // namespace scan2fea
