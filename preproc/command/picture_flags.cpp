#include "preproc/command/picture_flags.hpp"

#include "preproc/command/option_text.hpp"
#include "preproc/mesh/joined.hpp"

#include <CLI/Error.hpp>

#include <array>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <utility>
#include <vector>

namespace scan2fea::command {
namespace {

// All of the text, with this between the numbers; empty where it is anything else.
std::vector<double> numbers_in(const std::string& text, char separator) {
  std::vector<double> numbers;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, separator);) {
    char* end = nullptr;
    numbers.push_back(std::strtod(part.c_str(), &end));
    if (part.empty() || *end != '\0' || !std::isfinite(numbers.back())) return {};
  }
  return text.ends_with(separator) ? std::vector<double>() : numbers;
}

// "x", "-z" or "1,1,0", made a unit.
std::optional<Vec3> direction_in(const std::string& text) {
  const bool is_negative = text.starts_with('-');
  const std::string axis = is_negative ? text.substr(1) : text;
  for (int k = 0; k < 3; ++k)
    if (axis == std::string(1, static_cast<char>('x' + k))) return Vec3((is_negative ? -1.0 : 1.0) * Vec3::Unit(k));
  const std::vector<double> numbers = numbers_in(text, ',');
  if (numbers.size() != 3) return {};
  const Vec3 direction = Vec3(numbers[0], numbers[1], numbers[2]).stableNormalized();
  return direction.isZero(0) ? std::nullopt : std::optional(direction);
}

CutFlag cut_in(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::optional<Vec3> normal = direction_in(text.substr(0, equals));
  const std::vector<double> offset =
      equals == std::string::npos ? std::vector<double>() : numbers_in(text.substr(equals + 1), ' ');
  if (!normal || (equals != std::string::npos && offset.size() != 1))
    throw CLI::ValidationError("--cut", "'" + text + "' is no plane, as x, z=12.5 and 1,1,0=20 are");
  return {.normal = *normal, .offset = offset.empty() ? std::nullopt : std::optional(offset.front())};
}

PictureSize size_in(const std::string& text) {
  constexpr double least = 64, most = 8192;
  const std::vector<double> numbers = numbers_in(text, 'x');
  const auto fits = [](double n) { return n >= least && n <= most && n == std::floor(n); };
  if (numbers.size() != 2 || !fits(numbers[0]) || !fits(numbers[1]))
    throw CLI::ValidationError("--size", "'" + text + "' is no size from 64x64 to 8192x8192, as 1280x960 is");
  return {.width = static_cast<std::uint32_t>(numbers[0]), .height = static_cast<std::uint32_t>(numbers[1])};
}

ColourRange range_in(const std::string& text) {
  const std::vector<double> numbers = numbers_in(text, ':');
  if (numbers.size() != 2 || !(numbers[0] < numbers[1]))
    throw CLI::ValidationError("--range",
                               "'" + text + "' is no range from a smaller to a larger value, as -0.2:0.2 is");
  return {.low = numbers[0], .high = numbers[1]};
}

}  // namespace

Vec3 view_direction(const std::string& text) {
  static const std::array<std::pair<const char*, Vec3>, 8> names{{{"iso", {1, -1.4, 0.9}},
                                                                  {"iso-back", {-1, 1.4, 0.9}},
                                                                  {"front", {0, -1, 0}},
                                                                  {"back", {0, 1, 0}},
                                                                  {"left", {-1, 0, 0}},
                                                                  {"right", {1, 0, 0}},
                                                                  {"top", {0, 0, 1}},
                                                                  {"bottom", {0, 0, -1}}}};
  std::vector<std::string> known;
  for (const auto& [name, direction] : names) {
    if (text == name) return direction.normalized();
    known.emplace_back(name);
  }
  const std::optional<Vec3> direction = direction_in(text);
  if (!direction)
    throw CLI::ValidationError("--view", "'" + text + "' is none of " + joined(known) + ", and no direction 1,-2,0.5" +
                                             did_you_mean(text, known));
  return *direction;
}

void add_picture_flags(CLI::App& command, std::optional<ColourRange>& range, std::optional<CutFlag>& cut, Vec3& eye,
                       PictureSize& size) {
  command
      .add_option_function<std::string>(
          "--range", [&range](const std::string& text) { range = range_in(text); },
          "What the ends of the colour bar stand for; by default those of the report")
      ->type_name("LOW:HIGH");
  command
      .add_option_function<std::string>(
          "--cut", [&cut](const std::string& text) { cut = cut_in(text); },
          "Leave out what lies before a plane: x, through the middle, z=12.5, or a normal, 1,1,0=20; tetrahedra are "
          "left "
          "out whole")
      ->type_name("PLANE");
  command
      .add_option_function<std::string>(
          "--view", [&eye](const std::string& text) { eye = view_direction(text); },
          "From where: iso, iso-back, front (from -y), back, left, right, top, bottom, or a direction, 1,-2,0.5")
      ->default_str("iso")
      ->type_name("VIEW");
  command
      .add_option_function<std::string>(
          "--size", [&size](const std::string& text) { size = size_in(text); }, "In pixels, the legend included")
      ->default_str("1280x960")
      ->type_name("WxH");
}

}  // namespace scan2fea::command
