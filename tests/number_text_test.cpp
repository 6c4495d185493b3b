#include "export/number_text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

namespace scan2fea {
namespace {

std::string text(double value) {
  char characters[longest_number];
  return {characters, write_number(characters, value)};
}

TEST(NumberText, ShortFormsAreExactAndShort) {
  EXPECT_EQ(text(0), "0");
  EXPECT_EQ(text(-2.5), "-2.5");
  EXPECT_EQ(text(1e-5), "1e-5");
  EXPECT_EQ(text(1e22), "1e22");
  EXPECT_EQ(text(0.1), "0.1");
}

TEST(NumberText, TheNumberThatCalculixRefusedNowFits) {
  const std::string written = text(-9.2418718850240111E-05);
  EXPECT_LE(written.size(), 20U);
  EXPECT_NEAR(std::strtod(written.c_str(), nullptr), -9.2418718850240111E-05, 1e-19);
}

TEST(NumberText, RoundTripsWhereTwentyCharactersSuffice) {
  // Up to 17 digits, sign, point and leading zero.
  for (const double value : {-0.12345678901234568, 123456.78901234567, -98765432.101234567, 0.012345678901234567})
    EXPECT_EQ(std::strtod(text(value).c_str(), nullptr), value) << text(value);
}

TEST(NumberText, EveryNumberFitsAndKeepsItsDigits) {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> mantissa(-10, 10);
  std::uniform_int_distribution<int> any_exponent(-305, 305);
  std::uniform_int_distribution<int> common_exponent(-9, 17);
  for (int i = 0; i < 200000; ++i) {
    const bool common = i % 2 == 0;
    const double value =
        mantissa(generator) * std::pow(10, common ? common_exponent(generator) : any_exponent(generator));
    const std::string written = text(value);
    ASSERT_LE(written.size(), longest_number) << written;
    const double read = std::strtod(written.c_str(), nullptr);
    // Half a unit of the last of 15 (13) digits, relative to a mantissa of at least 1 but for the draws near zero.
    ASSERT_LE(std::abs(read - value), std::abs(value) * (common && std::abs(value) > 1e-9 ? 5e-15 : 5e-13)) << written;
  }
}

TEST(NumberText, ExtremesFit) {
  using limits = std::numeric_limits<double>;
  for (const double value : {limits::max() / 3, limits::lowest() / 3, limits::min(), -limits::min()}) {
    EXPECT_LE(text(value).size(), longest_number);
    EXPECT_NEAR(std::strtod(text(value).c_str(), nullptr) / value, 1, 1e-12);
  }
}

TEST(NumberText, IsReadBackAsTold) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> mantissa(-10, 10), exponent(-12, 9);
  for (int i = 0; i < 20000; ++i) {
    const double value = mantissa(random) * std::pow(10, std::floor(exponent(random)));
    EXPECT_EQ(as_written(as_written(value)), as_written(value)) << value;
    EXPECT_NEAR(as_written(value), value, 1e-12 * std::abs(value));
    EXPECT_EQ(as_written_for_nastran(as_written_for_nastran(value)), as_written_for_nastran(value)) << value;
    EXPECT_NEAR(as_written_for_nastran(value), value, 1e-10 * std::abs(value));
  }
}

}  // namespace
}  // namespace scan2fea
