// A picture with what its colours mean beside it.
#pragma once

#include "quality/picture/element_colours.hpp"
#include "quality/picture/raster.hpp"

namespace scan2fea {

// So many pixels at the right of a picture that is so large with it; 0 for none.
std::uint32_t legend_width(const Legend& legend, std::uint32_t width_of_all, std::uint32_t height);

// The picture on a white ground, and the legend at its right: a bar with ticks at round numbers, or names, as many as
// there is room for, and how many more there are.
Raster with_legend(const Raster& picture, const Legend& legend, std::uint32_t width_of_all);

}  // namespace scan2fea
