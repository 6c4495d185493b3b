#include "quality/histogram.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace scan2fea {
namespace {

TEST(Histogram, EveryValueIsInTheBarThatItsRangeSays) {
  const BarScale scale{.low = 0, .high = 1, .bars = 4};
  const MeasuredElements m =
      count_elements("m", "triangles", std::vector<double>{0, 0.24, 0.25, 0.5, 0.74, 0.99}, scale);
  EXPECT_THAT(m.counts, testing::ElementsAre(2, 1, 2, 1));
}

TEST(Histogram, WhatLiesBeyondIsInTheBarAtTheEnd) {
  const MeasuredElements m =
      count_elements("m", "triangles", std::vector<double>{-7, 1, 99}, {.low = 0, .high = 1, .bars = 2});
  EXPECT_THAT(m.counts, testing::ElementsAre(1, 2));
}

TEST(Histogram, WhatHasNoValueIsInNoBar) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const MeasuredElements m =
      count_elements("m", "triangles", std::vector<double>{nan, inf, 0.5}, {.low = 0, .high = 1, .bars = 2});
  EXPECT_EQ(std::accumulate(m.counts.begin(), m.counts.end(), std::size_t{0}), 1U);
  EXPECT_EQ(m.steps[0], no_step);
}

// The page knows elements by their steps alone.
TEST(Histogram, StepsTellTheBars) {
  std::vector<double> values;
  for (int i = 0; i < 5000; ++i) values.push_back(3 * std::abs(std::sin(i)));
  for (const std::uint16_t bars : {1, 7, 41, 1000}) {
    const MeasuredElements m = count_elements("m", "tetrahedra", values, {.low = 1, .high = 2.5, .bars = bars});
    std::vector<std::size_t> counts(bars, 0);
    for (const std::uint16_t step : m.steps) ++counts.at(step / m.scale.steps_per_bar());
    EXPECT_EQ(counts, m.counts) << bars;
  }
}

TEST(Histogram, ScalesAroundZeroHoldAllOfFewValues) {
  for (const std::vector<double>& values : {std::vector<double>{0.003, -0.0181}, {-1e9, 3}, {1e-30}, {0, 0}, {}}) {
    const BarScale scale = scale_around_zero(values, 1e-6);
    EXPECT_GE(scale.high, 1e-6);
    EXPECT_EQ(scale.low, -scale.high);
    EXPECT_EQ(scale.bars % 2, 1);
    for (const double value : values) EXPECT_LE(std::abs(value), scale.high);
  }
}

// As where one hole was closed.
TEST(Histogram, FewThatAreFarAwaySetNoScale) {
  std::vector<double> values;
  for (int i = 0; i < 1000; ++i) values.push_back(i < 995 ? 0.1 * std::sin(i) : -30);
  const BarScale scale = scale_around_zero(values, 1e-6);
  EXPECT_GE(scale.high, 0.0999);
  EXPECT_LT(scale.high, 0.2);
  const MeasuredElements m = count_elements("deviation", "triangles", values, scale);
  EXPECT_GE(m.counts.front(), 5U);
  EXPECT_EQ(m.beyond, 5U);
}

}  // namespace
}  // namespace scan2fea
