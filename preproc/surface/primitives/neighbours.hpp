// Which points are neighbours: those nearest in space, or nearest along a surface.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

// Per point a list, nearest first, the point itself left out.
struct Neighbours {
  std::vector<std::uint32_t> all;
  std::vector<std::size_t> first{0};

  std::size_t size() const { return first.size() - 1; }
  std::span<const std::uint32_t> of(std::uint32_t point) const {
    return std::span(all).subspan(first[point], first[point + 1] - first[point]);
  }
};

// The `count` points that are nearest in space and whose `normals` (one a point; or none at all) are not opposed: those
// of the other side of a wall are no neighbours. At most 31. k-d tree; O(n log n).
Neighbours nearest_in_space(const std::vector<Vec3>& points, const std::vector<Vec3>& normals, std::size_t count);

// The `count` vertices met first when spreading from each vertex along edges, by distance in space. Vertices of no
// triangle have none. O(n count log count).
Neighbours nearest_on_surface(const SurfaceMesh& mesh, std::size_t count);

// The `count` nearest to each of the points `within`, of those that are reached from it through their lists without
// leaving them. The other points have none.
Neighbours neighbours_within(const Neighbours& all, const std::vector<Vec3>& points, const std::vector<bool>& within,
                             std::size_t count);

}  // namespace scan2fea
