// What <numbers> and <limits> have long names for.
#pragma once

#include <limits>
#include <numbers>

namespace scan2fea {

inline constexpr double degrees = 180 / std::numbers::pi;  // in a radian
inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace scan2fea
