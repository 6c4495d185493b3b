// Units of length, as users and files write them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace scan2fea {

// The short name of the unit, "mm" for "MM" or "millimetres"; nothing for what is not known. Known are um, mm, cm, m,
// in and ft.
std::optional<std::string> length_unit(std::string_view text);

// In metres. Precondition: `unit` is what `length_unit` returned.
double metres(std::string_view unit);

// For messages: "um, mm, cm, m, in or ft".
inline constexpr std::string_view known_length_units = "um, mm, cm, m, in or ft";

}  // namespace scan2fea
