// Gates as a user's script asks for them: sets, lists, files, and what they are refused for.
#include "preproc/mesh/write_surface.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/run_command.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace scan2fea {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class GatesCommand : public ::testing::Test {
 protected:
  GatesCommand() {
    write_surface(analytic::sphere(10, 4), path("ball.ply"));
    SurfaceMesh open = analytic::sphere(10, 3);
    open.triangles.pop_back();
    write_surface(open, path("open.ply"));
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string quoted(const std::string& name) const { return "'" + path(name) + "'"; }
  bool exists(const std::string& name) const { return std::filesystem::exists(path(name)); }

  CommandResult check(const std::string& file, const std::string& flags) const {
    return run_command("check " + quoted(file) + " --quiet " + flags);
  }

  // Refused before any work is done, in one line that says what is near.
  void expect_refused(const std::string& arguments, const std::string& hint) const {
    const auto result = run_command(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments << result.standard_error;
    EXPECT_THAT(result.standard_error, HasSubstr(hint)) << arguments;
    EXPECT_EQ(result.standard_error.find('\n'), result.standard_error.size() - 1) << result.standard_error;
  }

  TemporaryFolder folder_;
};

TEST_F(GatesCommand, SetsAreGatesWithTheirSource) {
  const auto result = check("ball.ply", "--gates NASTRAN --gates abaqus --json -");
  EXPECT_EQ(result.exit_code, 0) << result.standard_error;
  const json gates = json::parse(result.standard_output)["gates"];
  ASSERT_EQ(gates.size(), 5U);
  EXPECT_EQ(gates[0]["set"], "nastran");
  EXPECT_EQ(gates[4]["set"], "abaqus");
  for (const json& gate : gates) EXPECT_FALSE(gate["source"].get<std::string>().empty());
}

TEST_F(GatesCommand, AnOwnGateReplacesThatOfASet) {
  const auto result = check("ball.ply", "--gates nastran --require 'min_angle_deg.min>=59' --json -");
  EXPECT_EQ(result.exit_code, 1);
  const json gates = json::parse(result.standard_output)["gates"];
  ASSERT_EQ(gates.size(), 2U);
  EXPECT_EQ(gates[0]["limit"], 59);
  EXPECT_FALSE(gates[0].contains("set"));
  EXPECT_EQ(gates[1]["name"], "surface.max_angle_deg");
  EXPECT_THAT(result.standard_error, HasSubstr("gate failed: surface.min_angle_deg.min is "));
  EXPECT_THAT(result.standard_error, HasSubstr(", element "));
}

TEST_F(GatesCommand, ThePapersNeedAReference) {
  EXPECT_EQ(check("ball.ply", "--gates paper --reference " + quoted("ball.ply")).exit_code, 0);
  expect_refused("check " + quoted("ball.ply") + " --quiet --gates paper", "--reference");
}

TEST_F(GatesCommand, WhatCannotBeIsRefusedBeforeAnyWork) {
  const std::string surface =
      "surface " + quoted("none.ply") + " -o " + quoted("out.ply");  // no such file: not read yet
  expect_refused(surface + " --require 'edge_rato.mean<=1.2'", "surface.edge_ratio.mean");
  expect_refused(surface + " --require 'stages.simplfy.faces_after<=1'", "stages.simplify.faces_after");
  expect_refused(surface + " --require 'faces.FACE_1.aera<=1'", "faces.FACE_1.area");
  expect_refused(surface + " --require 'edge_ratio.mean<=nan'", "a number");
  expect_refused(surface + " --require 'scaled_jacobian.min>=0.2'", "scan2fea run");
  expect_refused(surface + " --require 'faces<=9' --require 'surface.faces>9'", "surface.faces>9");
  expect_refused(surface + " --gates calculix", "no limit for surfaces");
  expect_refused(surface + " --gates patran", "abaqus");
  expect_refused(surface + " --junit " + quoted("gates.xml"), "--require");
}

TEST_F(GatesCommand, AFigureWithoutValueFails) {
  const auto result = check("open.ply", "--require 'surface.volume>=-1e300' --json - --junit " + quoted("gates.xml"));
  EXPECT_EQ(result.exit_code, 1);
  const json gate = json::parse(result.standard_output)["gates"][0];
  EXPECT_TRUE(gate["value"].is_null());
  EXPECT_EQ(gate["pass"], false);
  EXPECT_THAT(result.standard_error, HasSubstr("surface.volume has no value"));
  EXPECT_THAT(contents(path("gates.xml")), HasSubstr("no value"));
}

TEST_F(GatesCommand, FiguresOfListsAndOfFiles) {
  EXPECT_EQ(check("ball.ply", "--require 'size.box.x<=20.001' --require 'size.box.x>=19.9'").exit_code, 0);
  EXPECT_EQ(check("ball.ply",
                  "--require 'inputs.0.bytes>=1000' --require 'histograms.edge_ratio.counts.sum>100' "
                  "--require 'worst_elements.elements.count==10'")
                .exit_code,
            0);
  const std::string surface = "surface " + quoted("open.ply") + " -o " + quoted("out.ply") + " --faces 400 --quiet ";
  EXPECT_EQ(run_command(surface + "--require 'made_up.count==0'").exit_code, 1);
  EXPECT_FALSE(exists("out.ply"));
  EXPECT_EQ(run_command(surface + "--require 'made_up.count==1' --require 'stages.repair.closed_hole==1' "
                                  "--require 'stages.repair.dropped_speck==0' --require 'lost.area.sum<=0'")
                .exit_code,
            0);
  EXPECT_TRUE(exists("out.ply"));
}

TEST_F(GatesCommand, FacesHaveGates) {
  write_surface(analytic::box({2, 4, 6}, 1), path("box.ply"));
  EXPECT_EQ(run_command("faces " + quoted("box.ply") +
                        " --quiet --require 'faces.count==6' "
                        "--require 'faces.FACE_1.area==24'")
                .exit_code,
            0);
  const auto result =
      run_command("faces " + quoted("box.ply") + " --quiet -o " + quoted("f.ply") + " --require 'faces.area.max<=23'");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.standard_error, HasSubstr("faces.area.max is 24"));
  EXPECT_FALSE(exists("f.ply"));
}

TEST_F(GatesCommand, TheFileOfGatesIsAnOutputLikeAllOthers) {
  const std::string gates = "--gates nastran --junit ";
  EXPECT_EQ(check("ball.ply", gates + quoted("no/such/folder.xml")).exit_code, 6);
  EXPECT_EQ(check("ball.ply", gates + "/dev/full").exit_code, 6);
  EXPECT_EQ(check("ball.ply", gates + quoted("ball.ply") + " --force").exit_code, 2) << "the input";
  EXPECT_EQ(check("ball.ply", gates + quoted("g") + " --json " + quoted("g")).exit_code, 2) << "two of the same name";
  EXPECT_THAT(check("ball.ply", gates + "-").standard_output, HasSubstr("<?xml"));
  EXPECT_EQ(check("ball.ply", gates + "- --json -").exit_code, 2) << "one stdout";
  ASSERT_EQ(check("ball.ply", gates + quoted("g.xml")).exit_code, 0);
  const std::string before = contents(path("g.xml"));
  EXPECT_EQ(check("ball.ply", gates + quoted("g.xml")).exit_code, 6) << "it exists";
  EXPECT_EQ(contents(path("g.xml")), before);
  EXPECT_EQ(check("ball.ply", gates + quoted("g.xml") + " --force").exit_code, 0);
}

TEST_F(GatesCommand, ConfigurationsHoldThem) {
  write_text(path("c.toml"),
             "gates = [\"nastran\", \"ansys\"]\nrequire = [\"faces>=1\", \"closed==true\"]\njunit = \"" +
                 path("g.xml") + "\"\n");
  const auto result = check("ball.ply", "--json - --config " + quoted("c.toml"));
  EXPECT_EQ(result.exit_code, 0) << result.standard_error;
  EXPECT_EQ(json::parse(result.standard_output)["gates"].size(), 5U);
  EXPECT_THAT(contents(path("g.xml")), HasSubstr("tests=\"5\""));
  write_text(path("bad.toml"), "gates = \"patran\"\n");
  expect_refused("check " + quoted("ball.ply") + " --quiet --config " + quoted("bad.toml"), "bad.toml:1");
  write_text(path("list.toml"), "list-gates = true\n");
  expect_refused("check " + quoted("ball.ply") + " --quiet --config " + quoted("list.toml"), "list.toml:1");
}

TEST_F(GatesCommand, TheListNeedsNoInput) {
  const auto table = run_command("check --list-gates");
  EXPECT_EQ(table.exit_code, 0) << table.standard_error;
  EXPECT_THAT(table.standard_output, HasSubstr("surface.edge_ratio.mean"));
  EXPECT_EQ(run_command("--list-gates").standard_output, table.standard_output);
  EXPECT_EQ(run_command("--list-gates --json -").exit_code, 2) << "of a sub-command only";
  const auto list = run_command("run --list-gates --json -");
  EXPECT_EQ(list.exit_code, 0) << list.standard_error;
  const json figures = json::parse(list.standard_output)["figures"];
  // Each name that stands for itself can be asked for.
  for (const json& figure : figures) {
    const auto name = figure["name"].get<std::string>();
    EXPECT_THAT(table.standard_output, HasSubstr(name));
  }
}

}  // namespace
}  // namespace scan2fea
