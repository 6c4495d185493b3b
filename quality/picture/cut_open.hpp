// What is seen of a volume mesh, whole or cut open.
#pragma once

#include "preproc/mesh/tet_mesh.hpp"
#include "quality/picture/picture.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

struct SeenFaces {
  std::vector<BoundaryFace> faces;
  // Per face its place in TetMesh::boundary, or this.
  static constexpr std::uint32_t inside = 0xffffffff;
  std::vector<std::uint32_t> boundary_face;
};

// The faces of the elements whose middle stays that no other such element hides: whole elements, as they are.
// O(n log n).
SeenFaces seen_faces(const TetMesh& mesh, const Cut& cut);

}  // namespace scan2fea
