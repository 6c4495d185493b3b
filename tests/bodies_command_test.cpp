// `run` with several bodies, as a user's script calls it.
#include "export/formats.hpp"
#include "preproc/mesh/write_surface.hpp"
#include "tests/run_command.hpp"
#include "tests/temporary_folder.hpp"
#include "tests/touching_bodies.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace scan2fea {
namespace {

using analytic::moved;
using testing::HasSubstr;

SurfaceMesh box(double x, double y, double z, double edge, const Vec3& at) {
  return moved(analytic::box({x, y, z}, edge), at);
}

// Solids of one ASCII file.
void write_solids(const std::vector<Body>& bodies, const std::filesystem::path& file) {
  std::ofstream out(file);
  out.precision(9);
  for (const Body& body : bodies) {
    out << "solid " << body.name << "\n";
    for (const Triangle& t : body.surface.triangles) {
      out << "facet normal 0 0 0\nouter loop\n";
      for (const std::uint32_t v : t) out << "vertex " << body.surface.vertices[v].transpose() << "\n";
      out << "endloop\nendfacet\n";
    }
    out << "endsolid\n";
  }
}

class BodiesCommand : public testing::Test {
 protected:
  void SetUp() override {
    write_surface(base_, folder_ / "base.stl", {});
    write_surface(top_, folder_ / "top part.stl", {});
  }
  CommandResult run(const std::string& arguments) { return run_command("run '" + path("base.stl") + "' " + arguments); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  TemporaryFolder folder_;
  SurfaceMesh base_ = box(10, 8, 2, 2, {0, 0, 0}), top_ = box(4, 3, 5, 1.7, {3, 2, 2});
};

TEST_F(BodiesCommand, FilesAreBodiesNamedByTheirStems) {
  const CommandResult made =
      run("'" + path("top part.stl") + "' -o '" + path("both.inp") + "' --unit mm --json '" + path("both.json") + "'");
  ASSERT_EQ(made.exit_code, 0) << made.standard_error;
  EXPECT_THAT(made.standard_error, HasSubstr("body 'top part' is named top_part"));
  EXPECT_THAT(made.standard_error, HasSubstr("base and top_part touch: "));
  EXPECT_THAT(made.standard_error, HasSubstr("the largest gap 0, "));
  const TetMesh mesh = read_volume(folder_ / "both.inp");
  ASSERT_EQ(mesh.element_sets.size(), 2U);
  EXPECT_EQ(mesh.element_sets[0].name, "BASE");
  EXPECT_EQ(mesh.element_sets[1].name, "TOP_PART");
  const std::size_t s = find_set(mesh.face_sets, "INTERFACE_base_top_part");
  ASSERT_LT(s, mesh.face_sets.size());
  EXPECT_EQ(mesh.face_sets[s].members.size(), mesh.faces_between);
  const nlohmann::json json = nlohmann::json::parse(contents(folder_ / "both.json"));
  EXPECT_NEAR(json["bodies"][1]["volume"].get<double>(), 60, 1e-6);
  EXPECT_EQ(json["contacts"][0]["set"], "INTERFACE_base_top_part");
  EXPECT_GT(json["contacts"][0]["triangles_closed"].get<int>(), 0);

  // In every format, and back by `check`.
  for (const FileFormat& format : file_formats()) {
    if (format.write_volume == nullptr || format.read == nullptr || !format.volume->faces_between) continue;
    const std::string target =
        path(format.extension == ".header" ? "mesh.header" : "to" + std::string(format.extension));
    const std::string parts = format.parts == Parts::never ? "" : " --parts 2";
    ASSERT_EQ(run_command("convert '" + path("both.inp") + "' -o '" + target + "' --quiet" + parts).exit_code, 0);
    const CommandResult checked = run_command("check '" + target + "' --json - --quiet");
    ASSERT_EQ(checked.exit_code, 0) << checked.standard_error;
    std::map<std::string, nlohmann::json> sets;
    const nlohmann::json report = nlohmann::json::parse(checked.standard_output);
    for (const auto& set : report["sets"]) sets[set["name"]] = set;
    EXPECT_NEAR(sets["TOP_PART"].value("volume", 0.), 60, 1e-6) << target;
    EXPECT_NEAR(sets["BASE"].value("volume", 0.), 160, 1e-6) << target;
    EXPECT_NEAR(sets["INTERFACE_BASE_TOP_PART"].value("area", 0.), 12, 1e-6) << target;
    EXPECT_EQ(report["surface"]["components"], 1) << target;
  }
}

TEST_F(BodiesCommand, ClosedGroupsOfOneFileAreBodies) {
  write_solids({{"base", base_}, {"top", top_}}, folder_ / "both.stl");
  const std::string both = "run '" + path("both.stl") + "' -o '";
  ASSERT_EQ(run_command("convert '" + path("both.stl") + "' -o '" + path("both.obj") + "' --quiet").exit_code, 0);
  ASSERT_EQ(run_command("run '" + path("both.obj") + "' -o '" + path("obj.vtu") + "' --quiet").exit_code, 0);
  EXPECT_GT(read_volume(folder_ / "obj.vtu").faces_between, 0U);
  const CommandResult made = run_command(both + path("both.vtu") + "' --quiet");
  ASSERT_EQ(made.exit_code, 0) << made.standard_error;
  EXPECT_EQ(read_volume(folder_ / "both.vtu").element_sets.size(), 2U);
  ASSERT_EQ(run_command(both + path("one.vtu") + "' --quiet --one-body").exit_code, 0);
  EXPECT_TRUE(read_volume(folder_ / "one.vtu").element_sets.empty());
}

TEST_F(BodiesCommand, TheSameBytesForAnyNumberOfThreads) {
  write_surface(analytic::bored_block({30, 20, 10}, 5, 96, 3), folder_ / "bracket.stl", {});
  write_surface(moved(analytic::cylinder(5, 24, 80, 6), {0, 0, -7}), folder_ / "pin.stl", {});
  std::string first;
  for (const char* threads : {"1", "2", "7"}) {
    const CommandResult made = run_command("run '" + path("bracket.stl") + "' '" + path("pin.stl") + "' -o '" +
                                           path("part.inp") + "' --force --quiet --order 2 --threads " + threads);
    ASSERT_EQ(made.exit_code, 0) << made.standard_error;
    const std::string bytes = contents(folder_ / "part.inp");
    if (first.empty()) first = bytes;
    EXPECT_EQ(bytes, first) << threads;
  }
}

TEST_F(BodiesCommand, AGapOrAnOverlapIsAnErrorWhoseAdviceWorks) {
  for (const double offset : {0.001, -0.2}) {
    write_surface(box(4, 3, 5, 1.7, {3, 2, 2 + offset}), folder_ / "off.stl", {});
    const std::string arguments = "'" + path("off.stl") + "' -o '" + path("off.inp") + "' --force --quiet";
    const CommandResult failed = run(arguments);
    EXPECT_EQ(failed.exit_code, 4) << failed.standard_error;
    EXPECT_THAT(failed.standard_error, HasSubstr("base and off at ("));
    const std::size_t at = failed.standard_error.find("--contact ");
    ASSERT_NE(at, std::string::npos) << failed.standard_error;
    const std::string advice =
        failed.standard_error.substr(at, failed.standard_error.find_first_of(" ,", at + 10) - at);
    const CommandResult made = run(arguments + " " + advice);
    EXPECT_EQ(made.exit_code, 0) << advice << ": " << made.standard_error;
  }
}

// A cavity that another body fills is not empty, and what figures compare with is all scans.
TEST_F(BodiesCommand, FiguresCompareWithTheScansOfAllBodies) {
  write_surface(analytic::join(analytic::sphere(10, 4), analytic::reversed(analytic::sphere(8, 4))),
                folder_ / "shell.stl", {});
  write_surface(analytic::sphere(8, 3), folder_ / "ball.stl", {});
  for (const char* order : {"1", "2"}) {
    const CommandResult made =
        run_command("run '" + path("shell.stl") + "' '" + path("ball.stl") + "' -o '" + path("both.vtu") +
                    "' --force --quiet --json '" + path("run.json") + "' --order " + order);
    ASSERT_EQ(made.exit_code, 0) << made.standard_error;
    const nlohmann::json json = nlohmann::json::parse(contents(folder_ / "run.json"));
    const nlohmann::json& deviation = json["deviation"];
    double scans = 0;
    for (const auto& body : json["bodies"]) {
      EXPECT_LT(std::abs(body["volume_difference_pct"].get<double>()), 1) << "two tessellations of one ball";
      EXPECT_NEAR(body["volume"].get<double>(), body["volume_joined"].get<double>(),
                  1e-5 * body["volume"].get<double>());
      scans += body["volume_of_scan"].get<double>();
    }
    const double volume = json["volume_mesh"]["volume"];
    EXPECT_NEAR(deviation["volume_difference_pct"].get<double>(), 100 * (volume / scans - 1), 1e-9);
    EXPECT_LT(std::abs(deviation["volume_difference_pct"].get<double>()), 0.5);
    EXPECT_LT(std::abs(deviation["area_difference_pct"].get<double>()), 1);
    EXPECT_LT(deviation["hausdorff_pct_diagonal"].get<double>(), 1);
    const CommandResult checked = run_command("check '" + path("both.vtu") + "' --reference '" + path("shell.stl") +
                                              "' --reference '" + path("ball.stl") + "' --json - --quiet");
    ASSERT_EQ(checked.exit_code, 0) << checked.standard_error;
    const nlohmann::json again = nlohmann::json::parse(checked.standard_output)["deviation"];
    if (std::string(order) == "1") {
      EXPECT_EQ(again, deviation);
    } else {  // samples of curved triangles go by their first corners
      EXPECT_NEAR(again["rms_pct_diagonal"].get<double>(), deviation["rms_pct_diagonal"].get<double>(), 1e-3);
      EXPECT_EQ(again["volume_difference_pct"], deviation["volume_difference_pct"]);
    }
  }
}

TEST_F(BodiesCommand, AGapThatStaysOpenIsInTheFiguresAndAGateNamesIt) {
  write_surface(box(4, 3, 5, 1.7, {3, 2, 2.05}), folder_ / "off.stl", {});
  const std::string arguments = "'" + path("off.stl") + "' -o '" + path("off.inp") + "' --force --json '" +
                                path("off.json") + "' --require 'stages.contact.open_gaps";
  EXPECT_EQ(run(arguments + "==0'").exit_code, 1);
  const CommandResult made = run(arguments + "==1'");
  ASSERT_EQ(made.exit_code, 0) << made.standard_error;
  EXPECT_THAT(made.standard_error, HasSubstr("base and off face one another across a gap of 0.05"));
  const nlohmann::json json = nlohmann::json::parse(contents(folder_ / "off.json"));
  ASSERT_EQ(json["gaps"].size(), 1U);
  EXPECT_NEAR(json["gaps"][0]["size"].get<double>(), 0.05, 1e-6);
  EXPECT_NEAR(json["gaps"][0]["place"][2].get<double>(), 2.025, 1e-6);
  EXPECT_EQ(json["gaps"][0]["bodies"], nlohmann::json({"base", "off"}));
}

TEST_F(BodiesCommand, WhatCrossesBecomesOneBodyAsTheErrorAdvises) {
  write_surface(box(1, 12, 1, 0.7, {5, -2, 0.6}), folder_ / "bar.stl", {});
  const std::string arguments = "'" + path("bar.stl") + "' -o '" + path("one.inp") + "' --force --quiet";
  const CommandResult failed = run(arguments);
  ASSERT_EQ(failed.exit_code, 4) << failed.standard_error;
  EXPECT_THAT(failed.standard_error, HasSubstr("--one-body"));
  const CommandResult made = run(arguments + " --one-body");
  ASSERT_EQ(made.exit_code, 0) << made.standard_error;
  EXPECT_NEAR(total_volume(read_volume(folder_ / "one.inp")), 160 + 12 - 8, 0.01);
}

TEST_F(BodiesCommand, TwoMeshesOfOneDeckHaveNamesAndNumbersOfTheirOwn) {
  const CommandResult made =
      run("-o '" + path("a.inp") + "' --quiet --set-prefix A_ --first-node 5001 --first-element 7001");
  ASSERT_EQ(made.exit_code, 0) << made.standard_error;
  const std::string text = contents(folder_ / "a.inp");
  EXPECT_THAT(text, HasSubstr("*NODE, NSET=A_NALL\n5001, "));
  EXPECT_THAT(text, HasSubstr("ELSET=A_EALL\n7001,"));
  EXPECT_THAT(text, HasSubstr("*SURFACE, NAME=A_SALL"));
  ASSERT_EQ(
      run_command("convert '" + path("a.inp") + "' -o '" + path("b.bdf") + "' --quiet --first-node 101").exit_code, 0);
  EXPECT_THAT(contents(folder_ / "b.bdf"), HasSubstr("GRID*   101 "));
  ASSERT_EQ(run_command("convert '" + path("a.inp") + "' -o '" + path("kept.bdf") + "' --quiet").exit_code, 0);
  EXPECT_THAT(contents(folder_ / "kept.bdf"), HasSubstr("GRID*   5001 "));
  EXPECT_THAT(run_command("convert '" + path("a.inp") + "' -o '" + path("told.msh") + "' --quiet").standard_error,
              HasSubstr("does not keep the numbers that the input gives: nodes 5001.."));
  EXPECT_EQ(run("-o '" + path("c.inp") + "' --set-prefix 7").exit_code, 2);
  EXPECT_EQ(run("-o '" + path("c.bdf") + "' --quiet --first-node 99999999").exit_code, 2);
}

TEST_F(BodiesCommand, WhatDoesNotGoWithBodiesIsWrongUsage) {
  std::ofstream(folder_ / "cloud.xyz") << "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  for (const std::string& arguments : {"'" + path("cloud.xyz") + "'", "'" + path("top part.stl") + "' --enrich",
                                       "'" + path("top part.stl") + "' --method collapse"}) {
    const CommandResult failed = run(arguments + " -o '" + path("x.inp") + "' --quiet");
    EXPECT_EQ(failed.exit_code, 2) << failed.standard_error;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "x.inp"));
  }
  EXPECT_EQ(run("'" + path("missing.stl") + "' -o '" + path("x.inp") + "' --quiet").exit_code, 3);
}

}  // namespace
}  // namespace scan2fea
