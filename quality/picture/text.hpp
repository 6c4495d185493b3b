// Text in pictures: by FreeType, in a font that is built in. Both throw IoError where FreeType is not installed.
#pragma once

#include "quality/picture/colour_maps.hpp"
#include "quality/picture/raster.hpp"

#include <string_view>

namespace scan2fea {

// In pixels, of UTF-8 of one line; what is not UTF-8, or not in the font, is drawn as the font's box. `size`: of the
// font, above 0.
double text_width(std::string_view text, double size);

// From `x` on, the letters standing on the line `y` pixels from the top; what is outside of the picture is left out.
void draw_text(Raster& raster, std::string_view text, double x, double y, double size, const Rgb& ink);

}  // namespace scan2fea
