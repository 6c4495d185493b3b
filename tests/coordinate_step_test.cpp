// How coarse coordinates are.
#include "preproc/mesh/coordinate_step.hpp"

#include <gtest/gtest.h>

namespace scan2fea {
namespace {

TEST(FloatStep, IsThatOfTheFarthestCoordinate) {
  EXPECT_DOUBLE_EQ(float_step({{1, 2, 3}, {-6329871.5, 4, 5}}), 0.5);
  EXPECT_DOUBLE_EQ(float_step({{16777216, 0, 0}}), 2);
}

TEST(FloatStep, OfCoordinatesWithMoreDigitsIsNone) {
  EXPECT_EQ(float_step({{1, 2, 3}, {0.1, 6329871.5, 0}}), 0);
}

}  // namespace
}  // namespace scan2fea
