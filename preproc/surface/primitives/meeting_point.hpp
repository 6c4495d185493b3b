// Where shapes meet: the nearest point of a crease (two) or corner (three), or of one shape.
#pragma once

#include "preproc/surface/primitives/shape.hpp"

#include <optional>
#include <span>

namespace scan2fea {

// From `start` by Newton's method with the smallest steps onto one, two or three shapes. Nothing where they do not meet
// near by, or two run within 15 degrees of one another there (or three within as little of a line): the meeting is then
// not told by them.
std::optional<Vec3> meeting_point(std::span<const Shape* const> shapes, const Vec3& start);

}  // namespace scan2fea
