#include "preproc/mesh/error.hpp"
#include "preproc/surface/faces/selection.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace scan2fea {
namespace {

TEST(ParseSelection, BracketsAreNestedAsDeeplyAsOneWritesThem) {
  const auto nested = [](std::size_t levels, const std::string& opening, const std::string& closing) {
    std::string text = "a=";
    for (std::size_t i = 0; i < levels; ++i) text += opening;
    text += "plane";
    for (std::size_t i = 0; i < levels; ++i) text += closing;
    return text;
  };
  EXPECT_EQ(parse_selection(nested(50, "(", ")"), "").selection.kind, Selection::Kind::shape);
  EXPECT_EQ(parse_selection(nested(50, "not ", ""), "").selection.kind, Selection::Kind::inverse);
  constexpr std::size_t of_a_file = 1'000'000;
  EXPECT_THROW(parse_selection(nested(of_a_file, "(", ")"), ""), WrongUsage);
  EXPECT_THROW(parse_selection(nested(of_a_file, "not ", ""), ""), WrongUsage);
  EXPECT_THROW(parse_selection(nested(of_a_file, "largest(", ")"), ""), WrongUsage);
}

// Of text that nothing follows, not even a zero, no more is read than there is: AddressSanitizer sees it.
TEST(ParseSelection, TextMayEndAnywhere) {
  const std::string whole =
      "a=not (plane(axis=-z;15deg, x<+1mm) or largest(cylinder(r=5+-0.2, hole))) and box(0,0,0, 1,1,1) and "
      "normal(0,0,1)";
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    const std::vector<char> bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    try {
      parse_selection({bytes.data(), bytes.size()}, "mm");
    } catch (const WrongUsage&) {
      EXPECT_LT(size, whole.size());
    }
  }
}

}  // namespace
}  // namespace scan2fea
