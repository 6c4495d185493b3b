#include "quality/histogram.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace scan2fea {
namespace {

// The next of 1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten.
double rounded_up(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double digit : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (value <= digit * power) return digit * power;
  return 10 * power;
}

}  // namespace

std::uint16_t BarScale::step_of(double value) const {
  if (!std::isfinite(value)) return no_step;
  const double steps = static_cast<double>(bars) * steps_per_bar();
  return static_cast<std::uint16_t>(std::clamp(std::floor((value - low) / (high - low) * steps), 0.0, steps - 1));
}

MeasuredElements count_elements(std::string measure, std::string of, std::span<const double> values,
                                const BarScale& scale) {
  MeasuredElements measured{std::move(measure), std::move(of), scale, {}, std::vector<std::size_t>(scale.bars, 0), 0};
  measured.steps.reserve(values.size());
  for (const double value : values) {
    const std::uint16_t step = measured.steps.emplace_back(scale.step_of(value));
    if (step == no_step) continue;
    ++measured.counts[step / scale.steps_per_bar()];
    if (value < scale.low || value > scale.high) ++measured.beyond;
  }
  return measured;
}

BarScale scale_around_zero(std::span<const double> values, double least) {
  constexpr std::uint16_t bars = 41;
  std::vector<double> sizes;
  for (const double value : values)
    if (std::isfinite(value)) sizes.push_back(std::abs(value));
  double farthest = least;
  if (!sizes.empty()) {
    const auto last = sizes.begin() + static_cast<std::ptrdiff_t>((99 * sizes.size() + 99) / 100) - 1;
    std::nth_element(sizes.begin(), last, sizes.end());
    farthest = std::max(farthest, *last);
  }
  const double end = rounded_up(farthest);
  return {.low = -end, .high = end, .bars = bars};
}

}  // namespace scan2fea
