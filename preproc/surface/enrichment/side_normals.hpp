// Unit normals of a surface at its vertices, one for each smooth side where sharp edges meet.
#pragma once

#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <vector>

namespace scan2fea {

// What triangles add to the normal at a corner of theirs.
enum class CornerWeight {
  // Their area: best on parts, where narrow triangles cut off the edges that the scanner did not hit.
  area,
  // Their angle: however the surface is cut into triangles, the sum is the same (Thuermer and Wuethrich, Computing
  // vertex normals from polygonal facets, Journal of Graphics Tools 3(1), 1998). Best on free forms.
  angle,
  // Exact where a vertex and its neighbours lie on a ball (Max, Weights for computing vertex normals from facet
  // normals, Journal of Graphics Tools 4(2), 1999). It trusts short edges most: on average the best where points are
  // few, one by one the first that noise turns.
  ball,
};

class SideNormals {
 public:
  using Index = HalfedgeMesh::Index;

  // Creases part the sides. O(n).
  SideNormals(const HalfedgeMesh& mesh, CornerWeight weight);

  // Of all faces around v.
  const Vec3& mean(Index v) const { return means_[v]; }

  // Of the side of v that agrees best with `direction`.
  const Vec3& facing(Index v, const Vec3& direction) const;

  // An edge whose faces' normals differ by more than 60 degrees, and each of whose faces has another edge that is ten
  // times flatter.
  bool is_crease(const HalfedgeMesh& mesh, Index h) const;

  // For the vertex that was added to the mesh last: its normal, or those of the two sides of the crease that it lies
  // on.
  void add(const Vec3& normal);
  void add(const Vec3& one_side, const Vec3& other_side);

 private:
  std::vector<Vec3> means_;
  std::vector<Vec3> sides_;            // of all vertices, one after the other
  std::vector<std::size_t> first_{0};  // of each vertex in sides_, and the end
};

}  // namespace scan2fea
