// The colours of the report: made in OKLab (Ottosson, 2020), in which equal steps look equally large.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace scan2fea {

using Rgb = std::array<std::uint8_t, 3>;  // sRGB
using ColourMap = std::array<Rgb, 256>;

// From blue by a light grey to orange-red, as dark at both ends: for values with a sign. Told apart without red or
// green, too.
const ColourMap& diverging_colours();

// From pale sand to dark wine, ever darker: for shapes, whose worst is dark.
const ColourMap& sequential_colours();

// For names: no two that follow one another alike, as light as each other within a tenth.
Rgb category_colour(std::size_t index);

// What no value or name has.
inline constexpr Rgb neutral_colour{186, 190, 196};

}  // namespace scan2fea
