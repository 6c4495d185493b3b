#include "quality/gates.hpp"

#include "preproc/mesh/error.hpp"
#include "quality/deviation.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/error_from.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace scan2fea {
namespace {

using testing::HasSubstr;

Json report_of(const SurfaceMesh& mesh) {
  Report report;
  report.surface = measure_surface(mesh);
  return to_json(report);
}

bool passes(const std::string& gate, const Json& report) {
  return all_pass(evaluate_gates({parse_gate(gate)}, report));
}

TEST(Gates, EveryOperator) {
  const Json box = report_of(analytic::box({1, 1, 1}, 1));  // 12 faces
  EXPECT_TRUE(passes("surface.faces<=12", box));
  EXPECT_FALSE(passes("surface.faces<=11", box));
  EXPECT_TRUE(passes("surface.faces>=12", box));
  EXPECT_FALSE(passes("surface.faces>=13", box));
  EXPECT_TRUE(passes("surface.faces<12.5", box));
  EXPECT_FALSE(passes("surface.faces<12", box));
  EXPECT_TRUE(passes("surface.faces>11", box));
  EXPECT_FALSE(passes("surface.faces>12", box));
  EXPECT_TRUE(passes("surface.faces==12", box));
  EXPECT_FALSE(passes("surface.faces==13", box));
}

// A ball of 0.99 of the radius has lost 3 % of the volume: no more than 0.1 %, were it not for the sign.
TEST(Gates, MagnitudesBoundBothSides) {
  Report report;
  report.surface = measure_surface(analytic::sphere(9.9, 3));
  report.deviation = measure_deviation(analytic::sphere(9.9, 3), analytic::sphere(10, 3));
  const Json shrunk = to_json(report);
  EXPECT_TRUE(passes("volume_difference_pct<=0.1", shrunk));
  EXPECT_FALSE(passes("abs(volume_difference_pct)<=0.1", shrunk));
  EXPECT_TRUE(passes("abs( deviation.volume_difference_pct ) <= 3", shrunk));
  EXPECT_EQ(to_json(evaluate_gates({parse_gate("abs(volume_difference_pct)<=3")}, shrunk))[0]["name"],
            "abs(deviation.volume_difference_pct)");
  const Gate bound = parse_gate("abs(volume_difference_pct)<=0.1");
  for (const char* paper : {"volume_difference_pct<=0.8", "volume_difference_pct>=-0.8"})
    EXPECT_EQ(combined({bound}, {parse_gate(paper)}).size(), 1U) << paper;
}

TEST(Gates, OneSideOfADifferenceAloneIsNoticed) {
  const auto is_open = [](std::vector<std::string> texts) {
    std::vector<Gate> gates;
    for (const std::string& text : texts) gates.push_back(parse_gate(text));
    return leaves_a_side_open(gates.front(), gates);
  };
  EXPECT_TRUE(is_open({"volume_difference_pct<=0.1"}));
  EXPECT_TRUE(is_open({"volume_difference_pct>=-0.1", "area_difference_pct<=1"}));
  EXPECT_FALSE(is_open({"volume_difference_pct<=0.1", "volume_difference_pct>=-0.5"}));
  EXPECT_FALSE(is_open({"abs(volume_difference_pct)<=0.1"}));
  EXPECT_FALSE(is_open({"volume_difference_pct<=-0.1"}));  // that something was taken away
  EXPECT_FALSE(is_open({"edge_ratio.mean<=1.2"}));
}

TEST(Gates, AFailedGateFailsTheWhole) {
  const auto results = evaluate_gates({parse_gate("edge_ratio.mean<=1.2"), parse_gate("genus==0")},
                                      report_of(analytic::box({1, 1, 1}, 1)));
  ASSERT_EQ(results.size(), 2U);
  EXPECT_FALSE(results[0].pass);
  EXPECT_NEAR(*results[0].value, std::sqrt(2.0), 1e-12);
  EXPECT_TRUE(results[1].pass);
  EXPECT_FALSE(all_pass(results));
  EXPECT_TRUE(all_pass({}));
}

TEST(Gates, NamesWithAndWithoutTheSection) {
  EXPECT_EQ(parse_gate("edge_ratio.mean<=1.2").name, "surface.edge_ratio.mean");
  EXPECT_EQ(parse_gate("surface.edge_ratio.mean<=1.2").name, "surface.edge_ratio.mean");
  EXPECT_EQ(parse_gate(" scaled_jacobian.min >= 0.2 ").name, "volume_mesh.scaled_jacobian.min");
  EXPECT_EQ(parse_gate("hausdorff_pct_diagonal<0.5").limit, 0.5);
  EXPECT_EQ(parse_gate("deviation.volume_difference_pct>=-1e-3").limit, -1e-3);
}

TEST(Gates, FiguresOfStages) {
  Json report = report_of(analytic::box({1, 1, 1}, 1));
  report["stages"] = {{{"name", "repair"}, {"seconds", 1}},
                      {{"name", "simplify"}, {"feature_edges_unsupported", 3}, {"seconds", 2}},
                      {{"name", "second order"}, {"nodes", 10}}};
  EXPECT_TRUE(passes("stages.simplify.feature_edges_unsupported<=3", report));
  EXPECT_FALSE(passes("stages.simplify.feature_edges_unsupported<=2", report));
  EXPECT_TRUE(passes("stages.second_order.nodes==10", report));
  EXPECT_TRUE(passes("stages.seconds.sum==3", report));
  // Kinds of changes are told where there are any.
  EXPECT_TRUE(passes("stages.repair.closed_hole==0", report));
  EXPECT_FALSE(passes("stages.renewal.seconds<=2", report)) << "there was none";
  EXPECT_FALSE(passes("stages.second_order.seconds<=2", report)) << "it has no such figure";
}

TEST(Gates, NamesOfStagesAreKnownBeforeAnyWork) {
  EXPECT_THAT(error_from<WrongUsage>([] { parse_gate("stages.repair.closed_holes==0"); }).what(),
              HasSubstr("stages.repair.closed_hole"));
  EXPECT_THAT(error_from<WrongUsage>([] { parse_gate("stages.simplfy.faces_after<=9"); }).what(),
              HasSubstr("stages.simplify.faces_after"));
}

TEST(Gates, AnOwnGateReplacesThatOfASetOnTheSameSide) {
  const auto names = [](const std::vector<Gate>& gates) {
    std::vector<std::string> list;
    for (const Gate& gate : gates)
      list.push_back(gate.set + ":" + gate.name + std::string(sign_of(gate.comparison)) +
                     std::to_string(static_cast<int>(gate.limit)));
    return list;
  };
  const std::vector<Gate> set{{"surface.area", Comparison::at_most, 5, "s", ""},
                              {"surface.area", Comparison::at_least, 1, "s", ""},
                              {"surface.faces", Comparison::below, 9, "s", ""}};
  EXPECT_THAT(names(combined({}, set)),
              testing::ElementsAre("s:surface.area<=5", "s:surface.area>=1", "s:surface.faces<9"));
  EXPECT_THAT(names(combined({parse_gate("surface.area<7")}, set)),
              testing::ElementsAre(":surface.area<7", "s:surface.area>=1", "s:surface.faces<9"));
  EXPECT_THAT(names(combined({parse_gate("surface.area==2")}, set)),
              testing::ElementsAre(":surface.area==2", "s:surface.faces<9"));
  EXPECT_EQ(combined({parse_gate("surface.area<7"), parse_gate("surface.area<7")}, {}).size(), 1U);
}

TEST(Gates, TwoThatNoValueMeetsAreRefused) {
  const auto refused = [](const std::string& a, const std::string& b) {
    try {
      refuse_contradictions({parse_gate(a), parse_gate(b)});
    } catch (const WrongUsage&) {
      return true;
    }
    return false;
  };
  EXPECT_TRUE(refused("surface.faces<=5", "surface.faces>=6"));
  EXPECT_TRUE(refused("surface.faces<5", "surface.faces>=5"));
  EXPECT_TRUE(refused("surface.faces==5", "surface.faces==6"));
  EXPECT_TRUE(refused("surface.faces>5", "surface.faces==5"));
  EXPECT_FALSE(refused("surface.faces<=5", "surface.faces>=5"));
  EXPECT_FALSE(refused("surface.faces<=5", "surface.faces<=6"));
  EXPECT_FALSE(refused("surface.faces==5", "surface.faces==5"));
  EXPECT_FALSE(refused("surface.faces<=5", "surface.area>=6"));
}

TEST(Gates, YesAndNo) {
  SurfaceMesh open = analytic::sphere(1, 1);
  EXPECT_TRUE(passes("closed==true", report_of(open)));
  open.triangles.pop_back();
  EXPECT_FALSE(passes("closed==true", report_of(open)));
  EXPECT_TRUE(passes("closed==0", report_of(open)));
}

TEST(Gates, AnUnknownNameIsAnsweredByTheNearest) {
  const auto error = error_from<WrongUsage>([] { parse_gate("edge_rato.mean<=1.2"); });
  EXPECT_THAT(error.what(), HasSubstr("surface.edge_ratio.mean"));
  EXPECT_EQ(error.parts().value, "edge_rato.mean");
  EXPECT_THROW(parse_gate("surface.edge_ratio<=1.2"), WrongUsage);
}

TEST(Gates, AnAmbiguousNameIsRefused) {
  EXPECT_THAT(error_from<WrongUsage>([] { parse_gate("volume>0"); }).what(),
              HasSubstr("surface.volume or volume_mesh.volume"));
}

TEST(Gates, ANameThatIsAGroupElsewhereIsAmbiguous) {
  EXPECT_EQ(parse_gate("volume_mesh.edge_ratio<=3").name, "volume_mesh.edge_ratio");
  EXPECT_THAT(error_from<WrongUsage>([] { parse_gate("edge_ratio<=1.2"); }).what(),
              HasSubstr("surface.edge_ratio.mean"));
}

TEST(Gates, WhatIsNoGateIsRefused) {
  for (const char* text : {"", "edge_ratio.mean", "edge_ratio.mean<=", "<=1", "edge_ratio.mean<=1.2x",
                           "edge_ratio.mean=1", "edge_ratio.mean=<1", "edge_ratio.mean<=nan", "edge_ratio.mean<=inf",
                           "edge_ratio.mean<=1e999", "edge_ratio.mean<==1", "edge_ratio.mean<=1,2"})
    EXPECT_THROW(parse_gate(text), WrongUsage) << text;
}

TEST(Gates, AMissingFigureIsNeverPassed) {
  const Json without_reference = report_of(analytic::sphere(1, 1));
  EXPECT_THAT(error_from<WrongUsage>([&] { passes("rms_pct_diagonal<=1", without_reference); }).what(),
              HasSubstr("--reference"));
  EXPECT_THROW(passes("scaled_jacobian.min>=0", without_reference), WrongUsage);

  SurfaceMesh open = analytic::sphere(1, 1);
  open.triangles.pop_back();
  for (const char* gate : {"genus<=100", "genus>=-100", "surface.volume<=1e9"}) {
    const auto results = evaluate_gates({parse_gate(gate)}, report_of(open));
    EXPECT_FALSE(results[0].pass) << gate;
    EXPECT_FALSE(results[0].value) << gate;
    EXPECT_NE(results[0].reason, "") << gate;
    EXPECT_TRUE(to_json(results)[0]["value"].is_null());
  }
}

TEST(Gates, JsonHoldsNameValueLimitAndPass) {
  const Json json = to_json(evaluate_gates({parse_gate("faces<=5")}, report_of(analytic::box({1, 1, 1}, 1))));
  ASSERT_EQ(json.size(), 1U);
  EXPECT_EQ(json[0]["name"], "surface.faces");
  EXPECT_EQ(json[0]["operator"], "<=");
  EXPECT_EQ(json[0]["value"], 12);
  EXPECT_EQ(json[0]["limit"], 5);
  EXPECT_EQ(json[0]["pass"], false);
}

}  // namespace
}  // namespace scan2fea
