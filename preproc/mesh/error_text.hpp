// Numbers and places as messages show them, whatever the locale.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <string>

namespace scan2fea {

std::string error_text(double value, int significant_digits = 6);
std::string error_text(const Vec3& place);  // "(1.5, 0, 2)"

}  // namespace scan2fea
