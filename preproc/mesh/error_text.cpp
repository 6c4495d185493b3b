#include "preproc/mesh/error_text.hpp"

#include <charconv>

namespace scan2fea {

std::string error_text(double value, int significant_digits) {
  if (value == 0) value = 0;  // no sign
  char buffer[32];
  const auto end =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, significant_digits).ptr;
  return {buffer, end};
}

std::string error_text(const Vec3& place) {
  return "(" + error_text(place.x()) + ", " + error_text(place.y()) + ", " + error_text(place.z()) + ")";
}

}  // namespace scan2fea
