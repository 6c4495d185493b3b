#include "preproc/surface/reconstruction/surface_patches.hpp"

#include "preproc/mesh/union_find.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <utility>

namespace scan2fea {

std::vector<SurfacePatch> find_patches(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                                       const std::vector<bool>& is_marked) {
  UnionFind sets(triangles.size());
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> at_edge;
  for (std::uint32_t f = 0; f < triangles.size(); ++f) {
    if (!is_marked[f]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [entry, is_new] = at_edge.try_emplace(std::minmax({triangles[f][k], triangles[f][(k + 1) % 3]}), f);
      if (!is_new) sets.unite(f, entry->second);
    }
  }
  std::map<std::uint32_t, SurfacePatch> patches;
  for (std::uint32_t f = 0; f < triangles.size(); ++f)
    if (is_marked[f]) patches[sets.find(f)].triangles.push_back(f);
  std::vector<SurfacePatch> list;
  for (auto& [root, patch] : patches) {
    std::vector<Vec3> corners;
    for (const std::uint32_t f : patch.triangles) {
      const Triangle& t = triangles[f];
      for (const std::uint32_t v : t) corners.push_back(points[v]);
      patch.area += 0.5 * (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]).norm();
    }
    const BoundingBox box = bounding_box(corners);
    patch.place = 0.5 * (box.low + box.high);
    patch.size = box.diagonal();
    list.push_back(std::move(patch));
  }
  std::ranges::stable_sort(list, std::greater(), &SurfacePatch::size);
  return list;
}

}  // namespace scan2fea
