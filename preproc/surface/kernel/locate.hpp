// Finds the place on a triangle mesh that belongs to a point beside it, starting from a face that is nearly right.
//
// A search tree finds the nearest point from nothing; an optimisation that asks for the same points after every small
// move knows where each one was, and walks there in a step or two. The walk follows the projection from face to face;
// where it cannot be trusted (no face holds the projection, normals disagree, the point is far) a descent over vertex
// rings by true distance, with a penalty on opposed normals, takes over. Without the penalty, points of one side of a
// thin wall settle on the other side and pull the surface through it.
#pragma once

#include "preproc/surface/kernel/adjacency.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace scan2fea {

// A point of a triangle mesh.
struct Location {
  std::uint32_t face = no_face;
  // The nearest point lies on an edge or vertex because no face near by holds the projection (ridges, tips, borders):
  // a residual is then the distance to that point, not to the face's plane.
  bool clamped = false;
  std::array<double, 3> barycentric{};
};

// A view of a mesh and what the walk reads of it; everything must outlive it.
struct WalkableMesh {
  const SurfaceMesh& mesh;
  const VertexStars& stars;
  const std::vector<Triangle>& neighbours;
  const std::vector<Vec3>& face_normals;
};

struct Sample {
  Vec3 point;
  Vec3 normal;        // unit, or zero where unknown
  double weight = 0;  // area that it stands for
};

inline Vec3 point_at(const SurfaceMesh& mesh, const Location& at) {
  const Triangle& t = mesh.triangles[at.face];
  return at.barycentric[0] * mesh.vertices[t[0]] + at.barycentric[1] * mesh.vertices[t[1]] +
         at.barycentric[2] * mesh.vertices[t[2]];
}

// The point of the triangle a, b, c nearest to p, and whether p projects outside of it (Ericson, Real-Time Collision
// Detection, 5.1.5).
std::array<double, 3> nearest_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, bool& clamped);

// The location of `sample` reached from face `start`. `suspicious_distance`: farther ones are searched again by the
// descent. A local search: nothing guarantees the nearest point of the whole mesh. Constant cost for a good start.
Location locate(const WalkableMesh& on, const Sample& sample, std::uint32_t start, double suspicious_distance);

// The descent alone, for starts that are not trusted.
Location descend_to_nearest(const WalkableMesh& on, const Sample& sample, std::uint32_t start);

}  // namespace scan2fea
