// A part's own frame and order: the same part gives the same mesh wherever it lies, and in whatever order its triangles
// are listed.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

namespace scan2fea {

// Lattices, flips and searches take other ways when a coordinate differs in its last bit, so that the last bits must be
// the part's own. The axes are those of the normals' second moments, which on parts with plane faces are the faces'
// own; where two moments agree, landmarks on the largest triangles. Signs, and which of several axes alike, are settled
// by a sum over the triangles that only the part's own symmetries leave as it is, or else by which placed mesh comes
// first in the order of words. The unit is the part's radius. In this frame vertices go to the nearest point of a grid
// of some 1e-13 of the part's size times the number of vertices (at most 1e-8), placed so that no vertex is half way
// between two of its planes: there rounding, of the coordinates as they were given and of the turn, ends. From there
// the part is turned once more, into its smallest box, whose diagonal is what the stages take its size from.
class CanonicalFrame {
 public:
  // `placed`: the mesh in its frame, vertices along a curve through space, triangles by their corners. Two meshes that
  // differ by a motion, a scale and the order of vertices and triangles come out equal to the last bit. O(n log n).
  // Needs a triangle with an area. Not guaranteed: that of far more than 100,000 vertices, or of parts that lie so far
  // from the origin that their coordinates have lost digits, none falls to the other side.
  CanonicalFrame(const SurfaceMesh& mesh, SurfaceMesh& placed);

  Vec3 to_frame(const Vec3& p) const;
  Vec3 back(const Vec3& p) const { return unit_ * (axes_ * (turn_ * p)) + origin_; }
  double unit() const { return unit_; }  // of the frame, in units of the mesh
  Vec3 place_of(const Vec3& p) const;    // to be shown: back, without what rounding left of zeros
  // And coordinates that differ from one of the mesh's by no more than the grid's step become it: what lies in a plane
  // of the part that is parallel to two of the given axes comes back exactly.
  void bring_back(std::vector<Vec3>& points, const SurfaceMesh& mesh) const;

 private:
  void lie(const SurfaceMesh& mesh, const Eigen::Matrix3d& axes, const Vec3& centre);
  Vec3 on_grid(const Vec3& p) const;
  SurfaceMesh on_grid(const SurfaceMesh& mesh) const;

  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();  // columns
  Vec3 origin_ = Vec3::Zero();
  double unit_ = 1;
  double step_ = 1;                                     // of the grid, in units of the frame
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();  // of the grid; columns
};

}  // namespace scan2fea
