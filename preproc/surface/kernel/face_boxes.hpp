// The bounding boxes of a changing mesh's faces, to be asked which of them meet a box.
//
// A complete binary tree over the faces in a spatial order that is fixed at the start. A stage that changes a mesh step
// by step moves a face little and removes many: the order stays good, and a change only renews the boxes on the way to
// the root.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "quality/face_blocks.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

class FaceBoxes {
 public:
  // Of all faces of the mesh, of which it keeps no reference. O(n log n); about 110 bytes a face.
  explicit FaceBoxes(const SurfaceMesh& mesh);

  // O(log n).
  void set(std::uint32_t face, const BoundingBox& box);
  void remove(std::uint32_t face);

  // Calls visit(face) for each face whose box meets `box` (touching counts), in a fixed order.
  template <class Visit>
  void for_each_overlap(const BoundingBox& box, Visit visit) const {
    const auto descend = [&](const auto& self, std::size_t node) -> void {
      if (!boxes_meet(nodes_[node], box)) return;
      if (node >= leaves_) return visit(face_of_leaf_[node - leaves_]);
      self(self, 2 * node);
      self(self, 2 * node + 1);
    };
    descend(descend, 1);
  }

 private:
  void renew_ancestors(std::size_t node);

  std::size_t leaves_;              // a power of two; node 1 is the root, leaf i is node leaves_ + i
  std::vector<BoundingBox> nodes_;  // low = +inf, high = -inf where there is no face
  std::vector<std::uint32_t> face_of_leaf_;
  std::vector<std::uint32_t> leaf_of_face_;
};

}  // namespace scan2fea
