// Shapes grown over points, and which of them describes which point.
// A point costs the squares of its distance from its shape and of its normal's turn, each over what noise explains; one
// without a shape costs more than any that has one; a shape costs its degrees of freedom. What is looked for are the shapes that
// make the sum smallest (a description length), greedily, the best first.
#pragma once

#include "preproc/surface/primitives/fit_shape.hpp"
#include "preproc/surface/primitives/neighbours.hpp"
#include "preproc/surface/primitives/shape_rating.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace scan2fea {

struct GrownShape {
  Shape shape;
  ShapeFreedom freedom;                // what may still change; less than the kind has where relations hold it
  std::vector<std::uint32_t> points;  // that it describes, ascending
  double gain = 0;                     // of description length
  // What it is tangent to, in the list of shapes; the shape then follows from these and its radius.
  std::optional<std::array<std::uint32_t, 2>> blend_of;
};

inline constexpr std::uint32_t no_shape = ~std::uint32_t{0};

struct GrownShapes {
  std::vector<GrownShape> shapes;
  std::vector<std::uint32_t> labels;  // per point, in `shapes`; no_shape: none
};

// Called now and then; throws to end the work.
using Interrupt = std::function<void()>;

// `normals`: own_side_normals of the points; those that no plane describes are estimated anew among themselves, since a
// plane through the wall of a small hole is never as flat as one through the face around it. `outwards` as there.
// Deterministic, one thread. About 50 microseconds a point that no shape describes; less for others.
GrownShapes grow_shapes(const std::vector<Vec3>& points, const Neighbours& neighbours,
                        const std::vector<Vec3>& outwards, const ShapeNoise& noise, std::vector<Vec3>& normals,
                        const Interrupt& interrupt);

// Each point goes to the shape of its own or of a neighbour that costs least, shapes are fitted to what they then have,
// and those that no longer pay are dropped; `rounds` times.
void compete_for_points(const OrientedPoints& cloud, const Neighbours& neighbours, const ShapeNoise& noise, int rounds,
                        GrownShapes& grown);

}  // namespace scan2fea
