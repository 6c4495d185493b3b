#include "preproc/command/option_values.hpp"

#include "preproc/command/option_text.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh/joined.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>

namespace scan2fea::command {
namespace {

std::string tried(const std::string& advice) {
  return advice.empty() ? "" : "; try: " + advice;
}

// Counts as they are; other numbers short.
std::string bound_text(double bound) {
  return bound == std::floor(bound) && std::abs(bound) < 1e15 ? std::to_string(static_cast<long long>(bound))
                                                              : error_text(bound);
}

// CLI11's own lets NaN pass. No description: it would stand in the help.
CLI::Validator checked(double low, double high, bool whole, const std::string& advice) {
  return CLI::Validator(
      [=](std::string& text) {
        const std::optional<double> value = number_in(text);
        const bool fits = value && *value >= low && *value <= high && (!whole || *value == std::floor(*value));
        const bool is_plain = std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
        if (fits && whole && !is_plain) text = std::to_string(static_cast<std::uint64_t>(*value));
        return fits ? std::string()
                    : "'" + text + "' is " + (whole ? "no whole number" : "no number") + " from " + bound_text(low) +
                          " to " + bound_text(high) + tried(advice);
      },
      "");
}

}  // namespace

std::optional<double> number_in(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value)) return {};
  return value;
}

CLI::Validator positive(const std::string& advice) {
  return CLI::Validator(
      [advice](std::string& text) {
        const std::optional<double> value = number_in(text);
        return value && *value > 0 ? std::string() : "'" + text + "' is no number above 0" + tried(advice);
      },
      "");
}

CLI::Validator between(double low, double high, const std::string& advice) {
  return checked(low, high, false, advice);
}

CLI::Validator whole_between(double low, double high, const std::string& advice) {
  return checked(low, high, true, advice);
}

CLI::Validator one_of(const std::vector<std::string>& names) {
  return CLI::Validator(
      [names](std::string& text) {
        const std::string lower = CLI::detail::to_lower(text);
        const auto found = std::ranges::find(names, lower);
        if (found == names.end()) return "'" + text + "' is none of " + joined(names) + did_you_mean(lower, names);
        text = *found;
        return std::string();
      },
      "");
}

RelativeLength parse_length(const std::string& flag, const std::string& text, char suffix) {
  RelativeLength length;
  length.relative = suffix != no_suffix && !text.empty() && text.back() == suffix;
  const std::optional<double> value = number_in(length.relative ? text.substr(0, text.size() - 1) : text);
  if (!value || *value <= 0)
    throw CLI::ValidationError(flag, "'" + text + "' is no length above 0, as 0.5" +
                                         (suffix == no_suffix ? " is" : std::string(" or 0.5") + suffix + " are"));
  length.value = suffix == '%' && length.relative ? *value / 100 : *value;
  return length;
}

}  // namespace scan2fea::command
