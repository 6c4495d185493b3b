// The scan, made ready to be asked: what the fitting and mending stages all need of it, computed once.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/features/feature_scan.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "quality/triangle_measures.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace scan2fea {

// Keeps references to the mesh, which must outlive it and stay as it is. Linear in the mesh; about 100 bytes a
// triangle.
struct ReferenceSurface {
  explicit ReferenceSurface(const SurfaceMesh& scan);
  explicit ReferenceSurface(const FeatureScan& scan);

  const SurfaceMesh& mesh;           // cut open along its features, if it has some
  const SurfaceMesh& whole;          // not cut
  VertexStars stars;                 // of `mesh`, as all below
  std::vector<Triangle> neighbours;  // see face_neighbours
  std::vector<Vec3> face_normals;    // unit
  std::vector<Vec3> vertex_normals;  // unit
  // Which points of the scan and of a result may stand for one another, see FeatureNet::patch_of_face; empty without
  // features.
  std::vector<std::uint32_t> patch_of_vertex;
  double diagonal = 0;  // of the bounding box
  // Where several bodies are told apart: the one of each vertex, and their diagonals. Empty where there is one.
  std::vector<std::uint32_t> body_of_vertex;
  std::vector<double> diagonal_of_body;
  double area = 0;

  // From now on the diagonal is that of the largest body, and each body's distances are held against its own. For one
  // body nothing changes.
  void measure_by_body();

  // Of a result with so many triangles. Written out, though equilateral_edge is the same length: the two differ in the
  // last bit, and fits of a few hundred triangles that barely succeed turn out otherwise by it (a helmet of 300:
  // smallest angle 4.7 degrees instead of 12.7).
  double mean_edge(std::size_t triangles) const {
    return std::sqrt(4 / std::numbers::sqrt3 * area / static_cast<double>(triangles));
  }

 private:
  ReferenceSurface(const SurfaceMesh& cut, const SurfaceMesh& scan);
};

}  // namespace scan2fea
