// The scan, made ready to be asked: what the fitting, guarding and relaxing stages all need of it, computed once.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/adjacency.hpp"

#include <vector>

namespace scan2fea {

// Keeps a reference to the mesh, which must outlive it and stay as it is. Linear in the mesh; about 100 bytes a
// triangle.
struct ReferenceSurface {
  explicit ReferenceSurface(const SurfaceMesh& scan);

  const SurfaceMesh& mesh;
  VertexStars stars;
  std::vector<Triangle> neighbours;  // see face_neighbours
  std::vector<Vec3> face_normals;    // unit
  std::vector<Vec3> vertex_normals;  // unit
  double diagonal = 0;               // of the bounding box
  double area = 0;
};

}  // namespace scan2fea
