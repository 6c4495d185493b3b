// Where nodes of a boundary may go when the tetrahedra behind it are optimised.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstdint>
#include <functional>
#include <optional>

namespace scan2fea {

// A place that a node may take, and the directions in which it may go on from there: along `axis`, a unit vector, where
// it is on a line, else across it.
struct WayPoint {
  Vec3 place;
  Vec3 axis;
  bool is_on_line = false;

  Vec3 allowed(const Vec3& direction) const {
    const Vec3 along = axis * axis.dot(direction);
    return is_on_line ? along : Vec3(direction - along);
  }
};

// The way point of a node of the boundary that is nearest to the place where it is wanted, or about so; none where it
// is to stay. It may remember where it was asked last: not for several threads at once.
using BoundaryWays = std::function<std::optional<WayPoint>(std::uint32_t node, const Vec3& wanted)>;

}  // namespace scan2fea
