// Adjacency and normals of an indexed triangle mesh, as flat arrays.
#pragma once

#include "preproc/mesh/face_neighbours.hpp"
#include "preproc/mesh/surface_mesh.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

// An edge of a surface as its vertices, the smaller one first: a crease, or a piece of a border, that is to be kept.
using FeatureEdge = std::array<std::uint32_t, 2>;

inline FeatureEdge feature_edge(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

// Stars and neighbours, for stages that hand them on. Linear in the mesh.
struct MeshAdjacency {
  explicit MeshAdjacency(const SurfaceMesh& mesh) : stars(mesh), neighbours(face_neighbours(mesh, stars)) {}

  VertexStars stars;
  std::vector<Triangle> neighbours;
};

// The mean of a vertex's neighbours, each counted once for each triangle that it shares with it. Precondition: it has a
// triangle.
Vec3 middle_of_neighbours(const SurfaceMesh& mesh, const VertexStars& stars, std::uint32_t vertex);

// Unit normals; zero for a triangle without area.
std::vector<Vec3> face_normals(const SurfaceMesh& mesh);

// Sums of the area vectors around each vertex, made unit; zero for a vertex without a triangle.
std::vector<Vec3> vertex_normals(const SurfaceMesh& mesh);

// Vertex sets in which no two vertices share a triangle, so that each set can be worked on in parallel with the same
// outcome for any number of threads. Greedy in index order: seven to nine colours on usual meshes.
std::vector<std::vector<std::uint32_t>> colour_vertices(const SurfaceMesh& mesh, const VertexStars& stars);

}  // namespace scan2fea
