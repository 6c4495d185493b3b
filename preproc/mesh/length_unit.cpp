#include "preproc/mesh/length_unit.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace scan2fea {
namespace {

struct Unit {
  std::string_view name;
  double metres;
  std::array<std::string_view, 6> other_names;
};

// In lower case and in the singular. Only the short form of micrometres has a letter that is not ASCII (in UTF-8, as
// the micro sign and as the Greek letter).
constexpr std::array<Unit, 6> units{{
    {"um", 1e-6, {"micrometre", "micrometer", "micron", "\xc2\xb5m", "\xce\xbcm", {}}},
    {"mm", 1e-3, {"millimetre", "millimeter", {}, {}, {}, {}}},
    {"cm", 1e-2, {"centimetre", "centimeter", {}, {}, {}, {}}},
    {"m", 1, {"metre", "meter", {}, {}, {}, {}}},
    {"in", 0.0254, {"inch", "inche", "\"", {}, {}, {}}},
    {"ft", 0.3048, {"foot", "feet", "'", {}, {}, {}}},
}};

}  // namespace

std::optional<std::string> length_unit(std::string_view text) {
  std::string name(text);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (int attempt = 0; attempt < 2; ++attempt) {
    for (const Unit& unit : units)
      if (name == unit.name || (!name.empty() && std::find(unit.other_names.begin(), unit.other_names.end(), name) !=
                                                     unit.other_names.end()))
        return std::string(unit.name);
    if (name.size() < 4 || name.back() != 's') break;  // a plural of a word
    name.pop_back();
  }
  return {};
}

double metres(std::string_view unit) {
  for (const Unit& known : units)
    if (known.name == unit) return known.metres;
  return 1;
}

}  // namespace scan2fea
