#include "quality/limits.hpp"

#include "preproc/mesh/error.hpp"
#include "quality/figure_names.hpp"
#include "quality/figure_path.hpp"
#include "quality/gate_list.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

namespace scan2fea {
namespace {

using testing::HasSubstr;

TEST(Limits, EachIsOnAFigureAndHasASource) {
  std::set<char> letters;
  for (const LimitSource& source : limit_sources()) {
    EXPECT_TRUE(letters.insert(source.letter).second) << source.letter;
    EXPECT_FALSE(source.text.empty());
  }
  for (const MeasureLimit& limit : measure_limits()) {
    EXPECT_TRUE(find_figure_path(limit.figure)) << limit.figure;
    EXPECT_TRUE(letters.contains(limit.source)) << limit.figure;
    EXPECT_TRUE(limit.set.empty() || std::ranges::count(gate_sets(), limit.set) == 1) << limit.set;
    const bool is_of_tetrahedra = limit.figure.starts_with("volume_mesh.");
    EXPECT_EQ(is_of_tetrahedra, limit.of == MeasureLimit::Of::tetrahedra) << limit.figure;
  }
}

// An error is worse than a warning of the same program, and no set asks for both.
TEST(Limits, ErrorsLieBeyondWarnings) {
  for (const MeasureLimit& warning : measure_limits())
    for (const MeasureLimit& error : measure_limits()) {
      if (warning.figure != error.figure || warning.source != error.source) continue;
      if (warning.beyond != MeasureLimit::Beyond::warning || error.beyond != MeasureLimit::Beyond::error) continue;
      if (warning.comparison == Comparison::at_most || warning.comparison == Comparison::below)
        EXPECT_LT(warning.value, error.value) << warning.figure;
      else
        EXPECT_GT(warning.value, error.value) << warning.figure;
      EXPECT_TRUE(error.set.empty()) << error.figure;
    }
}

TEST(Limits, EverySetHoldsVolumeMeshesToThatNothingIsInsideOutButThePaper) {
  for (const std::string_view set : gate_sets()) {
    const std::vector<Gate> gates = gates_of_set(set, true);
    for (const Gate& gate : gates) {
      EXPECT_EQ(gate.set, set);
      EXPECT_FALSE(gate.source.empty());
    }
    EXPECT_EQ(std::ranges::count(gates, "volume_mesh.inverted", &Gate::name), set == "paper" ? 0 : 1) << set;
  }
}

TEST(Limits, TrianglesOfABoundaryAreNoElements) {
  for (const Gate& gate : gates_of_set("nastran", true))
    EXPECT_TRUE(gate.name.starts_with("volume_mesh.")) << gate.name;
  for (const Gate& gate : gates_of_set("nastran", false)) EXPECT_TRUE(gate.name.starts_with("surface.")) << gate.name;
  EXPECT_EQ(gates_of_set("paper", true).size(), gates_of_set("paper", false).size());
  EXPECT_THROW(gates_of_set("calculix", false), WrongUsage);
}

TEST(GateList, TheTableHasEveryFigureAndEverySet) {
  const std::string table = gate_list_table();
  for (const NamedFigure& figure : all_figures()) EXPECT_THAT(table, HasSubstr("  " + figure.name + " "));
  for (const std::string_view set : gate_sets()) EXPECT_THAT(table, HasSubstr("  " + std::string(set) + " "));
  const Json json = gate_list_json();
  EXPECT_EQ(json["figures"].size(), all_figures().size());
  EXPECT_EQ(json["sets"].size(), gate_sets().size());
}

}  // namespace
}  // namespace scan2fea
