// First shapes for a small patch of points with normals, in closed form, to start fits from.
#pragma once

#include "preproc/surface/primitives/shape.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace scan2fea {

struct OrientedPoints {
  const std::vector<Vec3>& points;
  const std::vector<Vec3>& normals;  // unit, outwards
};

// An axis that other shapes have already.
struct KnownAxis {
  Vec3 direction = Vec3::UnitZ();  // unit
  std::optional<Vec3> origin;      // none: the direction alone
};

struct ShapeGuess {
  Shape shape;
  bool on_known_direction = false;  // its axis is one of those given, or has its direction
  bool on_known_axis = false;
};

// The plane through the patch, those through its first point, its seed, the sphere whose radii its normals are, and
// about each likely direction of an axis a cylinder, a cone and a torus. Likely are the known ones, and those in which
// the patch's normals change least, or about which the centres of its curvature lie. Guesses that normals refuse (all
// alike, no axis that they meet) are left out. O(axes * patch).
std::vector<ShapeGuess> guess_shapes(const OrientedPoints& cloud, std::span<const std::uint32_t> patch,
                                     std::span<const KnownAxis> axes);

}  // namespace scan2fea
