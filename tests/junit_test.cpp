#include "quality/junit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace scan2fea {
namespace {

using testing::HasSubstr;
using testing::Not;

Json gate(const char* name, const char* sign, const Json& value, double limit, bool pass) {
  return {{"name", name}, {"operator", sign}, {"value", value}, {"limit", limit}, {"pass", pass}};
}

TEST(Junit, CountsAndNames) {
  Json report{{"gates", {gate("surface.area", "<=", 5, 6, true), gate("surface.faces", ">=", 1, 2, false)}}};
  report["gates"][1]["set"] = "nastran";
  report["gates"][1]["place"] = {1, 2.5, 3};
  report["gates"][1]["element"] = 42;
  const std::string text = junit_text(report, "results/part.v2.inp");
  EXPECT_THAT(text, HasSubstr("tests=\"2\" failures=\"1\" errors=\"0\""));
  EXPECT_THAT(text, HasSubstr("name=\"surface.faces &gt;= 2 (nastran)\" classname=\"scan2fea.part_v2_inp\""));
  EXPECT_THAT(text, HasSubstr("message=\"surface.faces is 1, limit &gt;= 2, element 42, at (1, 2.5, 3)\""));
}

TEST(Junit, ValuesAreWhole) {
  const std::string text =
      junit_text({{"gates", {gate("surface.area", "<=", 1.2000000000000002, 1.2, false)}}}, "a.stl");
  EXPECT_THAT(text, HasSubstr("surface.area is 1.2000000000000002, limit &lt;= 1.2"));
}

TEST(Junit, WhatHasNoValueSaysWhy) {
  Json report{{"gates", {gate("surface.genus", "==", nullptr, 0, false)}}};
  report["gates"][0]["reason"] = "this mesh has none";
  EXPECT_THAT(junit_text(report, "a.stl"), HasSubstr("no value, since this mesh has none"));
}

TEST(Junit, NamesMayHoldAnything) {
  const std::string file = "a\"<&>\x01\xff\xc3\x28 \xc3\xa9\xe2\x82\xac\xed\xa0\x80.stl";
  const std::string text = junit_text({{"gates", Json::array()}}, file);
  EXPECT_THAT(text, HasSubstr("a&quot;&lt;&amp;&gt;"));
  EXPECT_THAT(text, HasSubstr("\xc3\xa9\xe2\x82\xac"));
  EXPECT_THAT(text, Not(HasSubstr("\x01")));
  EXPECT_THAT(text, Not(HasSubstr("\xff")));
  EXPECT_THAT(text, Not(HasSubstr("\xed\xa0\x80")));
}

}  // namespace
}  // namespace scan2fea
