#include "quality/picture/colour_maps.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

struct OkLab {
  double lightness, a, b;
};

OkLab of_hue(double lightness, double chroma, double hue_deg) {
  const double hue = hue_deg * std::numbers::pi / 180;
  return {lightness, chroma * std::cos(hue), chroma * std::sin(hue)};
}

OkLab between(const OkLab& from, const OkLab& to, double t) {
  return {std::lerp(from.lightness, to.lightness, t), std::lerp(from.a, to.a, t), std::lerp(from.b, to.b, t)};
}

std::uint8_t encoded(double linear) {
  const double value = std::clamp(linear, 0.0, 1.0);
  const double s = value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * s));
}

Rgb to_rgb(const OkLab& c) {
  const auto cubed = [](double x) { return x * x * x; };
  const double l = cubed(c.lightness + 0.3963377774 * c.a + 0.2158037573 * c.b);
  const double m = cubed(c.lightness - 0.1055613458 * c.a - 0.0638541728 * c.b);
  const double s = cubed(c.lightness - 0.0894841775 * c.a - 1.2914855480 * c.b);
  return {encoded(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          encoded(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          encoded(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

// Through the colours at equal distances.
template <std::size_t n>
ColourMap map_through(const std::array<OkLab, n>& colours) {
  ColourMap map;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const double place = static_cast<double>(i) / static_cast<double>(map.size() - 1) * (n - 1);
    const std::size_t k = std::min(static_cast<std::size_t>(place), n - 2);
    map[i] = to_rgb(between(colours[k], colours[k + 1], place - static_cast<double>(k)));
  }
  return map;
}

}  // namespace

const ColourMap& diverging_colours() {
  static const ColourMap map =
      map_through<5>({of_hue(0.42, 0.13, 258), of_hue(0.66, 0.11, 250), of_hue(0.90, 0.005, 90), of_hue(0.66, 0.14, 45),
                      of_hue(0.42, 0.13, 33)});
  return map;
}

const ColourMap& sequential_colours() {
  static const ColourMap map =
      map_through<4>({of_hue(0.92, 0.035, 95), of_hue(0.73, 0.11, 68), of_hue(0.53, 0.15, 35), of_hue(0.33, 0.10, 5)});
  return map;
}

Rgb category_colour(std::size_t index) {
  constexpr double golden_angle_deg = 137.508;
  const double lightness = index % 2 == 0 ? 0.66 : 0.76;
  return to_rgb(of_hue(lightness, 0.11, 235 + golden_angle_deg * static_cast<double>(index)));
}

}  // namespace scan2fea
