// Unit normals of a surface at its vertices, one for each smooth side where sharp edges meet.
#pragma once

#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <vector>

namespace scan2fea {

class SideNormals {
 public:
  using Index = HalfedgeMesh::Index;

  // Area-weighted. Creases part the sides. O(n).
  SideNormals(const HalfedgeMesh& mesh, double crease_deg);

  // Of all faces around v.
  const Vec3& mean(Index v) const { return means_[v]; }

  // Of the side of v that agrees best with `direction`.
  const Vec3& facing(Index v, const Vec3& direction) const;

  // An edge whose faces' normals differ by more than `crease_deg` (0 to 180), and each of whose faces has another edge
  // that is ten times flatter.
  bool is_crease(const HalfedgeMesh& mesh, Index h) const;

  // For the vertex that was added to the mesh last: its normal, or those of the two sides of the crease that it lies
  // on.
  void add(const Vec3& normal);
  void add(const Vec3& one_side, const Vec3& other_side);

 private:
  double crease_deg_;
  std::vector<Vec3> means_;
  std::vector<Vec3> sides_;            // of all vertices, one after the other
  std::vector<std::size_t> first_{0};  // of each vertex in sides_, and the end
};

}  // namespace scan2fea
