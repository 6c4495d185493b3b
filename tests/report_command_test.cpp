// What the command tells of single elements, and the report that it writes, seen from outside.
#include "preproc/mesh/write_surface.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/run_command.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace scan2fea {
namespace {

using nlohmann::json;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

class ReportCommand : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string quoted(const std::string& name) const { return "'" + path(name) + "'"; }

  // The figures that the command prints as JSON.
  static json figures(const std::string& arguments) {
    const auto result = run_command(arguments + " --json - --quiet");
    EXPECT_EQ(result.exit_code, 0) << arguments << result.standard_error;
    return json::parse(result.standard_output);
  }

  void write_ball(const std::string& name, double radius = 10) const {
    write_surface(analytic::sphere(radius, 4), path(name));
  }

  json run_ball(const std::string& output, const std::string& flags = {}) const {
    write_ball("ball.ply");
    return figures("run " + quoted("ball.ply") + " -o " + quoted(output) + " --faces 500 --force " + flags);
  }

  TemporaryFolder folder_;
};

TEST_F(ReportCommand, FiguresOfAResultAreThoseOfItsFile) {
  for (const std::string order : {"1", "2"}) {
    const json made = run_ball("part.inp", "--order " + order);
    const json checked = figures("check " + quoted("part.inp") + " --reference " + quoted("ball.ply"));
    for (const char* section :
         {"surface", "deviation", "volume_mesh", "histograms", "worst_elements", "size", "reference"})
      EXPECT_EQ(made[section], checked[section]) << section << " of order " << order;
    EXPECT_EQ(checked["worst_elements"]["elements"].size(), 10U);
    EXPECT_EQ(checked["worst_elements"]["elements"][0]["scaled_jacobian"],
              checked["volume_mesh"]["scaled_jacobian"]["min"]);
  }
}

// Fields of 20 and of 16 characters are too narrow for small numbers.
TEST_F(ReportCommand, FiguresAreThoseOfTheRoundedFile) {
  SurfaceMesh ball = analytic::sphere(0.01, 4);
  for (Vec3& p : ball.vertices) p += Vec3(0.0123456789012345, -0.003, 0.0001);
  write_surface(ball, path("small.ply"));
  for (const std::string name : {"part.inp", "part.bdf"}) {
    const json made = figures("run " + quoted("small.ply") + " -o " + quoted(name) + " --faces 500");
    const json checked = figures("check " + quoted(name) + " --reference " + quoted("small.ply"));
    for (const char* section : {"surface", "deviation", "volume_mesh", "histograms", "worst_elements", "size"})
      EXPECT_EQ(made[section], checked[section]) << section << " of " << name;
  }
}

TEST_F(ReportCommand, ElementNumbersAreThoseOfTheFile) {
  const auto worst = [](const json& report) { return report["worst_elements"]["elements"][0]["element"].get<int>(); };
  const int number = worst(run_ball("part.inp"));
  EXPECT_EQ(worst(run_ball("again.inp", "--first-element 1001")), number + 1000);
  EXPECT_EQ(worst(figures("check " + quoted("again.inp"))), number + 1000);
  for (const std::string extension : {"msh", "bdf", "unv", "mail", "cdb", "exo"}) {
    ASSERT_EQ(run_command("convert " + quoted("part.inp") + " -o " + quoted("c." + extension)).exit_code, 0);
    EXPECT_EQ(worst(figures("check " + quoted("c." + extension))), number) << extension;
  }
  for (const std::string extension : {"vtu", "xdmf", "su2"}) {  // counted from 0
    ASSERT_EQ(run_command("convert " + quoted("part.inp") + " -o " + quoted("c." + extension)).exit_code, 0);
    EXPECT_EQ(worst(figures("check " + quoted("c." + extension))), number - 1) << extension;
  }
}

TEST_F(ReportCommand, FilesAreKnownByTheirSha256) {
  write_text(path("one.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const json input = figures("check " + quoted("one.obj"))["inputs"][0];
  EXPECT_EQ(input["bytes"], 32);
  EXPECT_EQ(input["sha256"], "697b00ab13410c52a542d2e9c63711fcc04e9cbf6c0d3439a9b43cc812e6e713");  // by sha256sum
}

TEST_F(ReportCommand, WhatIsWrittenIsKnownByItsSha256) {
  json outputs = run_ball("part.inp", "--unit mm --deck static --set 'fixed=z<-5' --set 'loaded=z>5'")["outputs"];
  const json of_two_files = run_ball("part.xdmf");
  for (const json& output : of_two_files["outputs"]) outputs.push_back(output);
  std::vector<std::string> roles;
  for (const json& output : outputs) {
    const std::string file = output["file"];
    roles.push_back(output["role"]);
    EXPECT_EQ(output["bytes"], std::filesystem::file_size(file)) << file;
    EXPECT_EQ(output["written"], true);
    if (file == path("part.inp") || file == path("part.xdmf")) {
      EXPECT_EQ(output["sha256"], figures("check '" + file + "'")["inputs"][0]["sha256"]);
    }
  }
  EXPECT_THAT(roles, UnorderedElementsAre("mesh", "deck", "mesh", "mesh"));
}

TEST_F(ReportCommand, AFailedGateIsInTheReportAndTheMeshIsNot) {
  write_ball("ball.ply");
  const auto result = run_command("surface " + quoted("ball.ply") + " -o " + quoted("out.ply") +
                                  " --faces 500 --report " + quoted("report") + " --require 'edge_ratio.mean<=1.0'");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_FALSE(std::filesystem::exists(path("out.ply")));
  const std::string page = contents(path("report/report.html"));
  EXPECT_THAT(page, HasSubstr("1 of 1 gates failed"));
  EXPECT_THAT(page, HasSubstr("mesh, not written: a gate failed"));
}

// A box with a hole in its top: the middle of the filling is as far from the scan as the rim is.
TEST_F(ReportCommand, ThatTheFarthestPointIsOnAFillingIsTold) {
  SurfaceMesh open = analytic::box({20, 20, 4}, 1);
  std::erase_if(open.triangles, [&](const Triangle& t) {
    const Vec3 middle = (open.vertices[t[0]] + open.vertices[t[1]] + open.vertices[t[2]]) / 3;
    return middle.z() > 3.9 && (middle.head<2>() - Eigen::Vector2d(10, 10)).norm() < 3;
  });
  write_surface(open, path("open.ply"));
  const json made = figures("run " + quoted("open.ply") + " -o " + quoted("part.inp") + " --faces 1500");
  EXPECT_EQ(made["deviation"]["farthest_is_on_filling"], true);
  EXPECT_EQ(figures("check " + quoted("part.inp") + " --reference " + quoted("open.ply"))["deviation"],
            made["deviation"]);
  EXPECT_THAT(run_command("check " + quoted("part.inp") + " --reference " + quoted("open.ply")).standard_output,
              HasSubstr(", where a hole was closed"));
  EXPECT_EQ(run_ball("ball.inp")["deviation"]["farthest_is_on_filling"], false);
}

TEST_F(ReportCommand, OfAMeshThatIsInsideOutSaysSo) {
  SurfaceMesh ball = analytic::sphere(10, 3);
  for (Triangle& t : ball.triangles) std::swap(t[0], t[1]);
  write_surface(ball, path("in.ply"));
  ASSERT_EQ(run_command("check " + quoted("in.ply") + " --report " + quoted("r")).exit_code, 0);
  EXPECT_THAT(contents(path("r/report.html")), HasSubstr("The surface has faults: inside out"));
}

TEST_F(ReportCommand, NamesMayBeAnyBytes) {
  write_ball(
      "gr\xf6\xdf"
      "e.ply");
  ASSERT_EQ(run_command("check " +
                        quoted("gr\xf6\xdf"
                               "e.ply") +
                        " --report " + quoted("r"))
                .exit_code,
            0);
  EXPECT_THAT(json::parse(contents(path("r/report.json")))["input"].get<std::string>(), HasSubstr("e.ply"));
}

// What is not written anew would be of another mesh.
TEST_F(ReportCommand, APdfOfAnEarlierReportGoes) {
  write_ball("ball.ply");
  std::filesystem::create_directory(path("r"));
  write_text(path("r/report.pdf"), "old");
  const std::string check = "check " + quoted("ball.ply") + " --report " + quoted("r");
  EXPECT_EQ(run_command(check).exit_code, 6);
  EXPECT_EQ(contents(path("r/report.pdf")), "old");
  EXPECT_EQ(run_command(check + " --force").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(path("r/report.pdf")));
}

TEST_F(ReportCommand, TheJsonOfAReportIsThatOfTheFlag) {
  write_ball("ball.ply");
  ASSERT_EQ(
      run_command("check " + quoted("ball.ply") + " --report " + quoted("r") + " --json " + quoted("j.json")).exit_code,
      0);
  EXPECT_EQ(contents(path("r/report.json")), contents(path("j.json")));
}

TEST_F(ReportCommand, CompareMeasuresTheSecondFromTheFirstAndBothFromTheReference) {
  write_ball("a.ply", 10);
  write_ball("b.ply", 10.5);
  write_ball("scan.ply", 10.1);
  const json report =
      figures("compare " + quoted("a.ply") + " " + quoted("b.ply") + " --reference " + quoted("scan.ply"));
  const auto distance = [](const json& of, double diagonal) {
    return of["deviation"]["hausdorff_pct_diagonal"].get<double>() / 100 * diagonal;
  };
  const double diagonal = report["reference"]["diagonal"];
  EXPECT_NEAR(distance(report, diagonal), 0.5, 0.03);
  EXPECT_NEAR(distance(report["compared"]["first"], 1.01 * diagonal), 0.1, 0.03);
  EXPECT_NEAR(distance(report["compared"]["second"], 1.01 * diagonal), 0.4, 0.03);
  EXPECT_NEAR(report["compared"]["reference"]["diagonal"].get<double>(), 1.01 * diagonal, 1e-5);
  EXPECT_EQ(report["compared"]["first"]["surface"], figures("check " + quoted("a.ply"))["surface"]);
  ASSERT_EQ(run_command("compare " + quoted("a.ply") + " " + quoted("b.ply") + " --report " + quoted("r")).exit_code,
            0);
  const std::string table = run_command("compare " + quoted("a.ply") + " " + quoted("b.ply")).standard_output;
  EXPECT_THAT(table, ContainsRegex("\n +first +second\n"));
  EXPECT_THAT(table, ContainsRegex("\n +Triangles +[0-9]+ +[0-9]+\n"));
  EXPECT_THAT(table, HasSubstr("\nthe second from the first: deviation"));
  const std::string page = contents(path("r/report.html"));
  EXPECT_THAT(page, HasSubstr("a.ply and b.ply"));
  EXPECT_THAT(page, HasSubstr("The second mesh, <code>" + path("b.ply") + "</code>, is closed"));
  EXPECT_THAT(page, HasSubstr("Worst element of <code>" + path("b.ply")));
  EXPECT_THAT(page, HasSubstr("first mesh: what the second is measured from"));
}

// As it is printed, where the first run's files are.
TEST_F(ReportCommand, ThePrintedCommandMakesTheSameBytesAgain) {
  write_ball("ball.ply");
  ASSERT_EQ(run_command("run " + quoted("ball.ply") + " -o " + quoted("part.inp") + " --faces 500 --quiet --report " +
                        quoted("r"))
                .exit_code,
            0);
  const std::string page = contents(path("r/report.html")), first = contents(path("part.inp"));
  const std::size_t begin = page.find("scan2fea run ", page.find("id=\"command\"")) + std::string("scan2fea ").size();
  const std::string again = page.substr(begin, page.find("</pre>", begin) - begin);
  EXPECT_EQ(run_command(again).exit_code, 0) << again;
  EXPECT_EQ(contents(path("part.inp")), first);
}

TEST_F(ReportCommand, TheVerdictIsNoLessThanWhatThePageShows) {
  write_surface(analytic::sphere(10, 2), path("coarse.ply"));
  write_ball("ball.ply");
  const json report = figures("check " + quoted("coarse.ply") + " --reference " + quoted("ball.ply"));
  const double largest =
      report["deviation"]["hausdorff_pct_diagonal"].get<double>() / 100 * report["reference"]["diagonal"].get<double>();
  const json& deviation = report["histograms"][0];
  ASSERT_EQ(deviation["measure"], "deviation");
  const std::size_t bars = deviation["counts"].size();
  const double low = deviation["low"], high = deviation["high"];
  for (std::size_t i = 0; i < bars; ++i) {
    const double nearer =
        std::min(std::abs(low + (high - low) * static_cast<double>(i) / static_cast<double>(bars)),
                 std::abs(low + (high - low) * static_cast<double>(i + 1) / static_cast<double>(bars)));
    if (deviation["counts"][i] > 0) EXPECT_LE(i == bars / 2 ? 0 : nearer, largest * (1 + 1e-9)) << i;
  }
}

TEST_F(ReportCommand, ThePdfIsPartOfAReport) {
  write_ball("ball.ply");
  EXPECT_EQ(run_command("check " + quoted("ball.ply") + " --report-pdf").exit_code, 2);
}

TEST_F(ReportCommand, PagesOfAllCommandsNameTheirFile) {
  write_ball("ball.ply");
  for (const std::string command : {"surface", "repair", "simplify"}) {
    const std::string output = command + ".stl";
    ASSERT_EQ(run_command(command + " " + quoted("ball.ply") + " -o " + quoted(output) + " --report " + quoted(command))
                  .exit_code,
              0);
    const std::string page = contents(path(command + "/report.html"));
    EXPECT_THAT(page, HasSubstr("<title>" + output)) << command;
    EXPECT_THAT(page, Not(HasSubstr("{{")));
  }
}

}  // namespace
}  // namespace scan2fea
