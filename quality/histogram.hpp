// How many elements have which value of a measure, in bars whose elements can be found again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace scan2fea {

// A range in bars of equal width, each in equal steps. A value is known by the number of its step, in 16 bits, so that
// whoever has the steps alone counts the same elements into the same bar. What lies beyond an end is in the bar there.
struct BarScale {
  double low = 0, high = 1;  // low < high, finite
  std::uint16_t bars = 1;    // 1 to 1000

  std::uint16_t steps_per_bar() const { return static_cast<std::uint16_t>(60'000 / bars); }
  std::uint16_t step_of(double value) const;  // `no_step` for what is not finite
  double edge(std::size_t bar) const { return low + (high - low) * static_cast<double>(bar) / bars; }
};

inline constexpr std::uint16_t no_step = 65535;

// One measure of all elements of a kind.
struct MeasuredElements {
  std::string measure;  // "scaled_jacobian"
  std::string of;       // "tetrahedra" or "triangles"
  BarScale scale;
  std::vector<std::uint16_t> steps;  // per element
  std::vector<std::size_t> counts;   // per bar
  std::size_t beyond = 0;            // how many of them are in a bar at an end that lie beyond it
};

// O(n).
MeasuredElements count_elements(std::string measure, std::string of, std::span<const double> values,
                                const BarScale& scale);

// Around zero, so far that 99 of 100 values are in it, since one closed hole would leave no colours for all else, but
// at least as far as `least`, above 0, so that rounding fills no scale; rounded up to one or two digits. An odd number
// of bars, so that one lies around zero. O(n).
BarScale scale_around_zero(std::span<const double> values, double least);

}  // namespace scan2fea
