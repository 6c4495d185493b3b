#include "preproc/surface/nearest_faces.hpp"

#include "preproc/surface/parallel_blocks.hpp"
#include "quality/triangle_tree.hpp"

namespace scan2fea {

std::vector<std::uint32_t> nearest_faces(const std::vector<Vec3>& points, const SurfaceMesh& mesh) {
  const TriangleTree tree(mesh);
  std::vector<std::uint32_t> faces(points.size());
  for_each_block(points.size(), [&](std::size_t first, std::size_t last) {
    std::uint32_t hint = tree.leaf_order().front();
    for (std::size_t i = first; i < last; ++i) faces[i] = hint = tree.closest(points[i], hint).triangle;
  });
  return faces;
}

}  // namespace scan2fea
