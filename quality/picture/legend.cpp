#include "quality/picture/legend.hpp"

#include "quality/picture/text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace scan2fea {
namespace {

constexpr Rgb ink{34, 38, 44};

// All lengths are multiples of the height of letters.
double letter_height(std::uint32_t width, std::uint32_t height) {
  return std::max(11.0, std::min(height / 42.0, width / 36.0));
}

struct Tick {
  double value;
  std::string text;
};

// At 1, 2 or 5 times a power of ten, about five of them.
std::vector<Tick> ticks_of(const Legend& legend) {
  const double rough = (legend.high - legend.low) / 5, power = std::pow(10.0, std::floor(std::log10(rough)));
  const double digit = rough / power, step = power * (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10);
  const auto first = std::ceil(legend.low / step - 1e-9), last = std::floor(legend.high / step + 1e-9);
  std::vector<Tick> ticks;
  for (double k = first; k <= last; ++k) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", k * step + 0.0);
    ticks.push_back({k * step, text});
  }
  return ticks;
}

void fill_box(Raster& raster, double left, double top, double right, double bottom, const Rgb& colour) {
  const auto inside = [](double at, std::uint32_t size) {
    return static_cast<std::uint32_t>(std::clamp(std::round(at), 0.0, static_cast<double>(size)));
  };
  for (std::uint32_t y = inside(top, raster.height); y < inside(bottom, raster.height); ++y)
    for (std::uint32_t x = inside(left, raster.width); x < inside(right, raster.width); ++x)
      std::copy(colour.begin(), colour.end(), raster.pixel(x, y));
}

void draw_bar(Raster& raster, const Legend& legend, double left, double top, double em) {
  const double bottom = raster.height - (legend.has_gaps ? 3.4 : 2) * em, right = left + 1.2 * em,
               height = bottom - top;
  for (double y = std::round(top); y < bottom; ++y) {
    const double share = 1 - (y + 0.5 - top) / height;
    const auto stop =
        static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(legend.ramp.size() - 1));
    fill_box(raster, left, y, right, y + 1, legend.ramp[stop]);
  }
  for (const Tick& tick : ticks_of(legend)) {
    const double y = bottom - height * (tick.value - legend.low) / (legend.high - legend.low);
    fill_box(raster, right, y - 0.5, right + 0.3 * em, y + 0.5, ink);
    draw_text(raster, tick.text, right + 0.6 * em, y + 0.36 * em, em, ink);
  }
}

constexpr const char *of_the_beyond = "ends: and beyond", *of_the_gaps = "grey: not known";

void draw_names(Raster& raster, const Legend& legend, double left, double top, double em) {
  constexpr double line = 1.6;
  const auto room = static_cast<std::size_t>(std::max(1.0, (raster.height - top - em) / (line * em)));
  const std::size_t shown = legend.names.size() <= room ? legend.names.size() : room - 1;
  double y = top;
  for (std::size_t i = 0; i < shown; ++i, y += line * em) {
    fill_box(raster, left, y, left + em, y + em, legend.names[i].colour);
    draw_text(raster, legend.names[i].name, left + 1.5 * em, y + 0.86 * em, em, ink);
  }
  if (shown < legend.names.size())
    draw_text(raster, "and " + std::to_string(legend.names.size() - shown) + " more", left, y + 0.86 * em, em, ink);
}

}  // namespace

std::uint32_t legend_width(const Legend& legend, std::uint32_t width_of_all, std::uint32_t height) {
  if (legend.empty()) return 0;
  const double em = letter_height(width_of_all, height), most = 16 * em;  // a longer name is cut off
  double width = text_width(legend.title, em);
  if (!legend.ramp.empty())
    for (const Tick& tick : ticks_of(legend)) width = std::max(width, 1.8 * em + text_width(tick.text, em));
  if (legend.is_open) width = std::max(width, text_width(of_the_beyond, em));
  if (legend.has_gaps) width = std::max(width, text_width(of_the_gaps, em));
  for (const Legend::Entry& entry : legend.names) width = std::max(width, 1.5 * em + text_width(entry.name, em));
  return static_cast<std::uint32_t>(std::ceil(std::min(width, most) + 1.5 * em));
}

Raster with_legend(const Raster& picture, const Legend& legend, std::uint32_t width_of_all) {
  Raster raster{.width = width_of_all, .height = picture.height, .rgba = {}};
  raster.rgba.assign(std::size_t{4} * raster.width * raster.height, 255);
  for (std::uint32_t y = 0; y < picture.height; ++y)
    for (std::uint32_t x = 0; x < picture.width; ++x) {
      const std::uint8_t* from = picture.rgba.data() + 4 * (std::size_t{y} * picture.width + x);
      for (std::size_t c = 0; c < 3; ++c)
        raster.pixel(x, y)[c] = static_cast<std::uint8_t>((from[c] * from[3] + 255 * (255 - from[3])) / 255);
    }
  if (legend.empty()) return raster;
  const double em = letter_height(width_of_all, picture.height), left = picture.width + 0.5 * em;
  draw_text(raster, legend.title, left, 1.8 * em, em, ink);
  if (legend.is_open) draw_text(raster, of_the_beyond, left, raster.height - 0.6 * em, em, ink);
  if (legend.has_gaps) draw_text(raster, of_the_gaps, left, raster.height - 2 * em, em, ink);
  if (!legend.ramp.empty())
    draw_bar(raster, legend, left, 3.2 * em, em);
  else
    draw_names(raster, legend, left, 3 * em, em);
  return raster;
}

}  // namespace scan2fea
