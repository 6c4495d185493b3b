// The empty inside of a part's holes: nothing of the part may be there, however few points show the wall.
#pragma once

#include "preproc/surface/primitives/find_primitives.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

// A hollow cylinder or cone from one end to the other.
struct HoleVoid {
  std::uint32_t primitive;  // its place in the list
  Shape shape;
  double low, high;        // ends, along the axis from the shape's origin
  double margin;           // within this of the wall nothing is said
  std::size_t points = 0;  // on the wall

  Vec3 on_axis(double height) const { return shape.origin + height * shape.axis; }
  double height(const Vec3& p) const { return (p - shape.origin).dot(shape.axis); }
  double radius_at(double height) const;
  bool contains(const Vec3& p) const;
};

// Of holes, and of hollow cones over half of a turn. A void ends where the points of its wall do, or at the face beyond
// that it opens into, or that is its floor: a plane of points about the axis, at most three spacings away. O(points x
// holes).
std::vector<HoleVoid> find_hole_voids(const std::vector<Vec3>& points, const Primitives& found);

// A void that a surface passes through nearer to its axis than half of its radius, between points of which none lies in
// it: what was a hole is closed there, or its floor was not seen.
struct BridgedVoid {
  std::uint32_t of;  // place in the list of voids
  Vec3 place;        // on the surface, where that is nearest to the axis
  std::vector<std::uint32_t> triangles;
};
std::vector<BridgedVoid> find_bridged_voids(const SurfaceMesh& surface, const std::vector<HoleVoid>& voids);

}  // namespace scan2fea
