// Numbers and places as error messages show them: six significant digits, whatever the locale.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <string>

namespace scan2fea {

std::string error_text(double value);
std::string error_text(const Vec3& place);  // "(1.5, 0, 2)"

}  // namespace scan2fea
