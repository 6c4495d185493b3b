// The triangle surface that every stage takes and gives.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>  // cross product

#include <array>
#include <cstdint>
#include <vector>

namespace scan2fea {

using Vec3 = Eigen::Vector3d;
using Triangle = std::array<std::uint32_t, 3>;

// An indexed triangle set in model units. Triangles are counter-clockwise seen from outside. Nothing else is promised:
// a freshly read scan may be open, non-manifold or self-intersecting; after `repair` it is closed and manifold.
// Plain arrays on purpose: the hot loops read them directly, and CGAL's structures exist only inside the stages that
// need them.
struct SurfaceMesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

struct BoundingBox {
  Vec3 low = Vec3::Zero();
  Vec3 high = Vec3::Zero();
  double diagonal() const { return (high - low).norm(); }
};

struct Ball {
  Vec3 centre = Vec3::Zero();
  double radius = 0;
};

// Of all vertices, used by a triangle or not; zero where there are none.
BoundingBox bounding_box(const std::vector<Vec3>& points);

// Adds the vertices and triangles of another mesh behind those that there are.
void append(SurfaceMesh& mesh, const SurfaceMesh& more);

// Twice the area, times the unit normal.
inline Vec3 area_vector(const SurfaceMesh& mesh, const Triangle& t) {
  const Vec3& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}

inline Vec3 centroid(const SurfaceMesh& mesh, const Triangle& t) {
  return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
}

// Per triangle.
std::vector<Vec3> centroids(const SurfaceMesh& mesh);

// Enclosed volume by the divergence theorem about the bounding box's centre (so that far-off coordinates cost no
// digits); positive where normals point outwards. Meaningless for an open surface.
double enclosed_volume(const SurfaceMesh& mesh);

double surface_area(const SurfaceMesh& mesh);

// Over the triangles' sides, so that an edge counts once for each of its triangles; 0 where there are none.
double mean_edge_length(const SurfaceMesh& mesh);

}  // namespace scan2fea
