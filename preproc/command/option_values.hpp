// Values that options take, checked as they are read: what is wrong, what is allowed, what to try.
#pragma once

#include <CLI/Error.hpp>
#include <CLI/Validators.hpp>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace scan2fea::command {

// A finite number, and nothing but it.
std::optional<double> number_in(const std::string& text);

// A number above 0.
CLI::Validator positive(const std::string& advice);

// From `low` to `high`, which are shown; `advice` may be empty.
CLI::Validator between(double low, double high, const std::string& advice);
// To transform the option: 1e5 is a whole number too, which CLI11 would not read.
CLI::Validator whole_between(double low, double high, const std::string& advice);

// One of some names, in whatever case: to transform the option into it.
CLI::Validator one_of(const std::vector<std::string>& names);

// A length in model units, or as a share of something the input tells.
struct RelativeLength {
  double value = 0;
  bool relative = false;
};

// "0.5" or, with the suffix, "0.1%" (returned as 0.001) or "1.6x". Throws CLI::ValidationError.
inline constexpr char no_suffix = 0;
RelativeLength parse_length(const std::string& flag, const std::string& text, char suffix);

}  // namespace scan2fea::command
