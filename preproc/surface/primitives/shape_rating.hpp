// How well a shape describes points: what each of them costs, and whether what is left is noise.
#pragma once

#include "preproc/surface/primitives/neighbours.hpp"
#include "preproc/surface/primitives/shape_guess.hpp"

#include <cstdint>
#include <span>

namespace scan2fea {

struct ShapeNoise {
  double sigma = 0;        // of distances, model units, > 0
  double sigma_angle = 0;  // of normals, radians, > 0
};

// Costs are in squared sigmas: 4 sigmas are noise, more is another surface.
inline constexpr double most_cost = 16;

// Of a point: the squares of its distance and of its normal's turn, each over what noise explains. Above most_cost it
// is not the shape's.
double cost_of(const OrientedPoints& cloud, const ShapeNoise& noise, const Shape& shape, std::uint32_t point);

// The root mean square of the points' distances.
double rms_distance(const OrientedPoints& cloud, const Shape& shape, std::span<const std::uint32_t> which);

// Whether the points' distances look like noise: no larger, none like its neighbour's (their autocorrelation along the
// surface is below a half), not those of a bent strip where the shape is a plane; and whether a plane would not do as
// well where it is none. `which` ascending. O(points).
bool leaves_noise(const OrientedPoints& cloud, const Neighbours& neighbours, const ShapeNoise& noise,
                  const Shape& shape, std::span<const std::uint32_t> which);

}  // namespace scan2fea
