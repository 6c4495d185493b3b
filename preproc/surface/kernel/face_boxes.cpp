#include "preproc/surface/kernel/face_boxes.hpp"

#include "preproc/mesh/numbers.hpp"

#include <bit>

namespace scan2fea {
namespace {

BoundingBox no_box() {
  return {Vec3::Constant(infinity), Vec3::Constant(-infinity)};
}

}  // namespace

FaceBoxes::FaceBoxes(const SurfaceMesh& mesh)
    : leaves_(std::bit_ceil(mesh.triangles.size())),
      nodes_(2 * leaves_, no_box()),
      leaf_of_face_(mesh.triangles.size()) {
  face_of_leaf_ = FaceBlocks(mesh).order();
  for (std::size_t leaf = 0; leaf < face_of_leaf_.size(); ++leaf) {
    const std::uint32_t f = face_of_leaf_[leaf];
    leaf_of_face_[f] = static_cast<std::uint32_t>(leaf);
    nodes_[leaves_ + leaf] = box_of_face(mesh, f);
  }
  for (std::size_t node = leaves_; node-- > 1;) {
    const BoundingBox &left = nodes_[2 * node], &right = nodes_[2 * node + 1];
    nodes_[node] = {left.low.cwiseMin(right.low), left.high.cwiseMax(right.high)};
  }
}

void FaceBoxes::set(std::uint32_t face, const BoundingBox& box) {
  const std::size_t node = leaves_ + leaf_of_face_[face];
  nodes_[node] = box;
  renew_ancestors(node);
}

void FaceBoxes::remove(std::uint32_t face) {
  set(face, no_box());
}

void FaceBoxes::renew_ancestors(std::size_t node) {
  for (node /= 2; node > 0; node /= 2) {
    const BoundingBox &left = nodes_[2 * node], &right = nodes_[2 * node + 1];
    const BoundingBox box{left.low.cwiseMin(right.low), left.high.cwiseMax(right.high)};
    if (box.low == nodes_[node].low && box.high == nodes_[node].high) return;
    nodes_[node] = box;
  }
}

}  // namespace scan2fea
