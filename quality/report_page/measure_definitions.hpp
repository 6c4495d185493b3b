// What the figures of a report mean, and what solvers and others ask of them.
#pragma once

#include <span>
#include <string_view>

namespace scan2fea {

struct MeasureDefinition {
  std::string_view figure;  // its name in the JSON
  std::string_view label;
  enum class Unit { none, degrees, percent, percent_of_diagonal, model, model_squared, model_cubed } unit;
  std::string_view definition;
  std::string_view limits;  // with the sources' letters in brackets; may be empty
};

struct LimitSource {
  std::string_view letter, text;
};

// In the order in which a report shows them.
std::span<const MeasureDefinition> measure_definitions();
std::span<const LimitSource> limit_sources();

}  // namespace scan2fea
