// Shapes grown over points: greedily, the best first (shape_set.hpp says what is good).
#pragma once

#include "preproc/surface/primitives/shape_set.hpp"

#include <functional>
#include <vector>

namespace scan2fea {

// Called now and then; throws to end the work.
using Interrupt = std::function<void()>;

// `normals`: own_side_normals of the points; those that no plane describes are estimated anew among themselves, since a
// plane through the wall of a small hole is never as flat as one through the face around it. `outwards` as there.
// Deterministic, one thread. About 50 microseconds a point that no shape describes; less for others.
ShapeSet grow_shapes(const std::vector<Vec3>& points, const Neighbours& neighbours, const std::vector<Vec3>& outwards,
                     const ShapeNoise& noise, std::vector<Vec3>& normals, const Interrupt& interrupt);

}  // namespace scan2fea
