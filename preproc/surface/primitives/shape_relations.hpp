// What a designer would have drawn: faces in the same plane, parallel and perpendicular directions, common axes, equal
// radii, roundings tangent to what they join.
#pragma once

#include "preproc/surface/primitives/shape_set.hpp"

namespace scan2fea {

// Each relation that is nearly there is imposed where the description gets shorter by it: that the shape has one number
// less to be told outweighs what its points move away. In this order: shapes that are one are made one; axes within 4
// degrees of a direction of more support, or of one square to two such, get it; pieces of cylinder and torus become
// roundings tangent to their neighbours; axes become common; radii equal. O(shapes^2 + points).
// Not guaranteed: that relations hold exactly after shapes are fitted again.
void impose_relations(const OrientedPoints& cloud, const Neighbours& neighbours, const ShapeNoise& noise,
                      ShapeSet& set);

}  // namespace scan2fea
