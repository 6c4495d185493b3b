// What a person meets who types the command: help, advice about mistakes, configurations, pipes, lines of progress.
#include "preproc/mesh/read_surface.hpp"
#include "preproc/mesh/write_surface.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/run_command.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>
#include <string>

namespace scan2fea {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

class CommandLine : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::string sphere() const {
    write_surface(analytic::sphere(10, 4), path("sphere.stl"));
    return "'" + path("sphere.stl") + "'";
  }

  static std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  }

  // Wrong usage, told in one line that has all of these.
  static void expect_told(const std::string& arguments, const std::vector<std::string>& parts) {
    const CommandResult result = run_command(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments << ": " << result.standard_error;
    EXPECT_EQ(lines_of(result.standard_error).size(), 1U) << arguments << ": " << result.standard_error;
    for (const std::string& part : parts) EXPECT_THAT(result.standard_error, HasSubstr(part)) << arguments;
  }

  TemporaryFolder folder_;
};

TEST_F(CommandLine, HelpNamesEachOptionInAGroupWithItsValuesAndDefault) {
  const CommandResult help = run_command("run --help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.standard_output,
              AllOf(HasSubstr("How many triangles, at most one of:"), HasSubstr("--effort low|normal|high"),
                    HasSubstr("[normal]"), HasSubstr("Examples:\n  scan2fea run "), HasSubstr("-o FILE [OPTIONS]")));
  EXPECT_EQ(run_command("-h").standard_output, run_command("--help").standard_output);
  // Each line fits, and what was declared without a group would be in one of no name.
  for (const std::string& line : lines_of(help.standard_output)) {
    EXPECT_LE(line.size(), 80U) << line;
    EXPECT_NE(line, "Options:");
  }
}

TEST_F(CommandLine, HelpIsAsWideAsTheTerminal) {
  for (const std::size_t columns : {30, 60, 100})
    for (const std::string& line :
         lines_of(run_command("check --help", {}, "COLUMNS=" + std::to_string(columns)).standard_output))
      if (!line.starts_with("  scan2fea") && !line.starts_with("Usage") && !line.starts_with("  -")) {
        EXPECT_LE(line.size(), columns) << line;
      }
}

TEST_F(CommandLine, MistypedNamesAreAnsweredWithWhatWasMeant) {
  expect_told("chekc part.inp", {"no command 'chekc'", "did you mean check?"});
  expect_told("'" + path("sphere.stl") + "x'", {"there are: run, surface"});
  expect_told("run " + sphere() + " -o x.inp --facse 300", {"no option '--facse'", "did you mean --faces?"});
  expect_told("run " + sphere() + " -o x.inp --edge 3", {"did you mean --edge-length?"});
  expect_told("run " + sphere() + " -o x.inp -faces 300", {"did you mean --faces?"});
  expect_told("run " + sphere() + " -o x.inp --effort hihg", {"'hihg' is none of low, normal, high", "mean high?"});
  expect_told("check " + sphere() + " --gates abacus", {"'abacus' is none of abaqus", "mean abaqus?"});
  expect_told("picture " + sphere() + " -o x.png --view frnt", {"none of iso", "mean front?"});
  expect_told("surface " + sphere() + " -o x.ply --order 2", {"one of run, tetrahedralize"});
  expect_told("check " + sphere() + " another.ply", {"'another.ply' is one argument too many"});
  expect_told(sphere(), {"is a file; did you mean: scan2fea run"});
  expect_told("--verison", {"did you mean --version?"});
  write_text(path("typo.toml"), "facse = 300\n");
  expect_told("run " + sphere() + " -o x.inp --config '" + path("typo.toml") + "'", {"did you mean faces?"});
}

TEST_F(CommandLine, WhatIsMissingIsNamed) {
  expect_told("run", {"missing: FILE"});
  expect_told("run " + sphere(), {"missing: -o, --output FILE"});
  expect_told("compare " + sphere(), {"missing: FILE, The second mesh"});
  expect_told("run " + sphere() + " -o x.inp --faces", {"--faces takes a value: --faces N"});
  expect_told("check " + sphere() + " --json a --json b", {"--json is given more than once"});
  expect_told("", {"no command is given"});
}

TEST_F(CommandLine, ValuesOutOfRangeAreErrorsWithAdvice) {
  const std::string run = "run " + sphere() + " -o '" + path("x.inp") + "' ";
  for (const std::string wrong :
       {"--faces 0", "--faces -5", "--faces 3", "--faces nan", "--faces 1e99", "--ratio 0", "--ratio nan", "--ratio -1",
        "--edge-length 0", "--edge-length inf", "--edge-length nan", "--deviation 200%", "--deviation nan",
        "--deviation 1e-9%", "--deviation -1%", "--deviation 0", "--gradation nan", "--gradation 2", "--grading 0",
        "--interior-size -1x", "--interior-size nanx", "--max-volume 0", "--elements-across 0", "--order 3",
        "--threads -1", "--time-limit 0", "--largest-hole 200%", "--largest-hole 35", "--feature-angle 190",
        "--report ''", "--report -", "--feature-angle nan", "--size-box 0 0 0 1 1 1 -1", "--size-box 0 0 0 1 1 1 nan",
        "--size-ball 0 0 0 -1 1", "--first-node 0",
        // Of a sphere of diameter 20, so that nothing in it is as long.
        "--edge-length 50", "--deviation 20", "--interior-size 50", "--thickness 50", "--size-ball 10 0 0 3 100",
        "--size-box 500 0 0 600 1 1 0.5", "--enrich --sampling-radius 100"}) {
    const CommandResult result = run_command(run + wrong);
    EXPECT_EQ(result.exit_code, 2) << wrong << ": " << result.standard_error;
    const std::vector<std::string> lines = lines_of(result.standard_error);
    ASSERT_FALSE(lines.empty()) << wrong;
    EXPECT_THAT(lines.back(), AllOf(StartsWith("scan2fea: "), HasSubstr("; try: "))) << wrong;
    EXPECT_FALSE(std::filesystem::exists(path("x.inp"))) << wrong;
  }
}

TEST_F(CommandLine, NumbersMayHaveExponents) {
  const std::string surface = "surface " + sphere() + " --quiet -o '";
  ASSERT_EQ(run_command(surface + path("plain.ply") + "' --faces 400 --seed 1000").exit_code, 0);
  const CommandResult result = run_command(surface + path("short.ply") + "' --faces 4e2 --seed 1e3 --time-limit 1e12");
  ASSERT_EQ(result.exit_code, 0) << result.standard_error;
  EXPECT_EQ(contents(path("short.ply")), contents(path("plain.ply")));
}

TEST_F(CommandLine, APrintedConfigurationMakesTheSameBytes) {
  const std::string flags =
      " --faces 400 --order 2 --effort low --size-ball 10 0 0 4 0.8 --size-ball -10 0 0 4 0.9"
      " --set 'top=z>5' --no-primitives --feature-angle off --unit mm --threads 1";
  const std::string files = sphere() + " -o '" + path("first.inp") + "'";
  const CommandResult printed = run_command("run " + files + flags + " --print-config");
  ASSERT_EQ(printed.exit_code, 0) << printed.standard_error;
  EXPECT_FALSE(std::filesystem::exists(path("first.inp"))) << "it prints, and does nothing else";
  write_text(path("part.toml"), printed.standard_output);
  EXPECT_THAT(printed.standard_output, HasSubstr("size-ball = [[10, 0, 0, 4, 0.8], [-10, 0, 0, 4, 0.9]]"));

  ASSERT_EQ(run_command("run " + files + flags + " --quiet").exit_code, 0);
  const std::string made = contents(path("first.inp"));
  const CommandResult again = run_command("run --config '" + path("part.toml") + "' --force --quiet");
  ASSERT_EQ(again.exit_code, 0) << again.standard_error;
  EXPECT_EQ(contents(path("first.inp")), made);
  // And prints itself.
  const CommandResult twice = run_command("run --config '" + path("part.toml") + "' --print-config");
  EXPECT_EQ(twice.standard_output, printed.standard_output);
}

TEST_F(CommandLine, ADefaultConfigurationIsAllComments) {
  const CommandResult printed = run_command("surface --print-config");
  ASSERT_EQ(printed.exit_code, 0);
  for (const std::string& line : lines_of(printed.standard_output))
    EXPECT_TRUE(line.empty() || line.starts_with("#") || line == "[surface]") << line;
  EXPECT_THAT(printed.standard_output, HasSubstr("# effort = 'normal'"));
}

TEST_F(CommandLine, BoxesAndBallsAreListsOfLists) {
  write_text(path("flat.toml"), "size-ball = [10, 0, 0, 4, 0.8, -10, 0, 0, 4, 0.8]\n");
  write_text(path("lists.toml"), "size-ball = [[10, 0, 0, 4, 0.8], [-10, 0, 0, 4, 0.8]]\n");
  write_text(path("short.toml"), "faces = 5\nsize-ball = [[10, 0, 0, 4]]\n");
  const auto made = [&](const std::string& config) {
    const CommandResult result = run_command("surface " + sphere() + " -o '" + path("out.ply") +
                                             "' --faces 400 --force --quiet --config '" + path(config) + "'");
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    return contents(path("out.ply"));
  };
  EXPECT_EQ(made("flat.toml"), made("lists.toml"));
  expect_told("surface " + sphere() + " -o out.ply --config '" + path("short.toml") + "'",
              {"short.toml:2", "4 values", "limit: 5"});
}

TEST_F(CommandLine, NoPrimitivesInAConfigurationIsNoPrimitives) {
  write_text(path("no.toml"), "no-primitives = true\n");
  write_text(path("not.toml"), "primitives = false\n");
  const auto printed = [&](const std::string& config) {
    return run_command("enrich --print-config --config '" + path(config) + "'").standard_output;
  };
  EXPECT_THAT(printed("no.toml"), HasSubstr("\nprimitives = false\n"));
  EXPECT_EQ(printed("no.toml"), printed("not.toml"));
}

TEST_F(CommandLine, PipesGiveTheBytesOfFiles) {
  const std::string file = sphere();
  ASSERT_EQ(run_command("surface " + file + " -o '" + path("file.obj") + "' --faces 400 --quiet").exit_code, 0);
  const CommandResult piped = run_command("surface - --from stl -o - --to obj --faces 400", {}, {}, path("sphere.stl"));
  ASSERT_EQ(piped.exit_code, 0) << piped.standard_error;
  write_text(path("piped.obj"), piped.standard_output);
  const SurfaceMesh from_file = read_surface(path("file.obj")), from_pipe = read_surface(path("piped.obj"));
  EXPECT_EQ(from_pipe.vertices, from_file.vertices);
  EXPECT_EQ(from_pipe.triangles, from_file.triangles);
  // No table of figures among the bytes, no temporary path in words.
  EXPECT_THAT(piped.standard_output, Not(HasSubstr("edge ratio")));
  EXPECT_THAT(piped.standard_error, Not(HasSubstr("standard-input.tmp")));
  const CommandResult converted = run_command("convert - --from stl -o - --to off", {}, {}, path("sphere.stl"));
  EXPECT_THAT(converted.standard_output, StartsWith("OFF"));
  const CommandResult checked = run_command("check - --from stl --json -", {}, {}, path("sphere.stl"));
  EXPECT_EQ(nlohmann::json::parse(checked.standard_output)["inputs"][0]["bytes"],
            std::filesystem::file_size(path("sphere.stl")));
}

TEST_F(CommandLine, PipesThatCannotWorkAreTold) {
  const std::string file = sphere();
  expect_told("surface - -o '" + path("out.ply") + "'", {"format", "--from"});
  expect_told("surface " + file + " -o -", {"format", "--to"});
  expect_told("surface " + file + " -o out.ply --to ply", {"--to is for -o - alone"});
  expect_told("run " + file + " -o - --to xdmf", {"several files"});
  expect_told("run " + file + " -o - --to inp --json -", {"--json -"});
  // A failure sends nothing.
  const CommandResult failed = run_command("run - --from stl -o - --to inp", {}, {}, "/dev/null");
  EXPECT_EQ(failed.exit_code, 3);
  EXPECT_THAT(failed.standard_output, IsEmpty());
  EXPECT_THAT(failed.standard_error, HasSubstr("standard input"));
  const CommandResult refused =
      run_command("surface " + file + " -o - --to ply --faces 400 --require 'edge_ratio.mean<=1'");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.standard_output, IsEmpty());
}

TEST_F(CommandLine, ProgressInJsonIsOneObjectALineAndNeverGoesBack) {
  const CommandResult result = run_command("run " + sphere() + " -o '" + path("x.inp") +
                                           "' --faces 3000 --order 2 --progress json --json '" + path("x.json") + "'");
  ASSERT_EQ(result.exit_code, 0) << result.standard_error;
  double fraction = 0;
  std::vector<std::string> stages;
  for (const std::string& line : lines_of(result.standard_error)) {
    const auto object = nlohmann::json::parse(line);
    if (object.at("type") != "progress") {
      EXPECT_FALSE(object.at("text").get<std::string>().empty());
      continue;
    }
    EXPECT_GE(object.at("fraction").get<double>(), fraction);
    fraction = object.at("fraction");
    EXPECT_LE(fraction, 1);
    EXPECT_GE(object.at("seconds_left").get<double>(), 0);
    EXPECT_FALSE(object.at("words").get<std::string>().empty());
    if (stages.empty() || stages.back() != object.at("stage")) stages.push_back(object.at("stage"));
  }
  EXPECT_EQ(fraction, 1);
  // Those of the figures are told, in their order, but for any that were over sooner than a line is written.
  std::vector<std::string> made;
  const auto report = nlohmann::json::parse(contents(path("x.json")));
  for (const auto& stage : report["stages"]) made.push_back(stage["name"]);
  EXPECT_THAT(made, ::testing::Contains("simplify"));
  EXPECT_THAT(stages, ::testing::Contains("simplify"));
  std::erase_if(stages, [&](const std::string& stage) { return std::ranges::find(made, stage) == made.end(); });
  std::erase_if(made, [&](const std::string& stage) { return std::ranges::find(stages, stage) == stages.end(); });
  EXPECT_EQ(stages, made);
}

TEST_F(CommandLine, ErrorsAreJsonWhereProgressIs) {
  for (const std::string arguments : {"run absent.stl -o x.inp --progress json", "run --progress=json --facse",
                                      "check absent.stl --progress json --quiet"}) {
    const CommandResult result = run_command(arguments);
    const std::vector<std::string> lines = lines_of(result.standard_error);
    ASSERT_FALSE(lines.empty()) << arguments;
    for (const std::string& line : lines) EXPECT_NO_THROW(nlohmann::json::parse(line)) << line;
    EXPECT_EQ(nlohmann::json::parse(lines.back())["type"], "error");
  }
}

TEST_F(CommandLine, NothingIsDrawnIntoAPipe) {
  const std::string run = "surface " + sphere() + " -o '" + path("x.ply") + "' --faces 400 --force ";
  EXPECT_THAT(run_command(run).standard_error, Not(HasSubstr("\033")));
  EXPECT_THAT(run_command(run + "--progress bar").standard_error, HasSubstr("\033[K"));
  EXPECT_EQ(run_command(run + "--quiet").standard_error, "");
}

// Of a part whose edges are rounded over two or three faces of the scan.
TEST_F(CommandLine, EdgesThatWereFoundAndAreNotKeptAreWarnedOf) {
  const std::string run =
      "surface '" SCAN2FEA_EXAMPLES "/bracket.ply' -o '" + path("x.ply") + "' --faces 4000 --effort low --force";
  const CommandResult made = run_command(run + " --json '" + path("x.json") + "'");
  ASSERT_EQ(made.exit_code, 0) << made.standard_error;
  const auto report = nlohmann::json::parse(contents(path("x.json")));
  const auto simplify = std::ranges::find(report["stages"], "simplify", [](const auto& s) { return s["name"]; });
  const auto lost = simplify->at("feature_edges_unsupported").template get<std::size_t>();
  ASSERT_GT(lost, 0U);
  EXPECT_THAT(made.standard_error, AllOf(HasSubstr("scan2fea: warning: "), HasSubstr(std::to_string(lost)),
                                         HasSubstr("sharp edges found on the scan"), HasSubstr("--features-from")));
  // Where they are is told on request.
  EXPECT_THAT(made.standard_error, Not(HasSubstr("the longest at")));
  EXPECT_THAT(run_command(run + " --verbose").standard_error,
              AllOf(HasSubstr("are not kept as creases: "), HasSubstr("the surface of "), HasSubstr("is accepted")));
  EXPECT_EQ(run_command(run + " --quiet").standard_error, "");
}

TEST_F(CommandLine, VersionNamesTheLibrariesAndTheFormatOfFigures) {
  const CommandResult version = run_command("--version");
  EXPECT_EQ(version.exit_code, 0);
  const auto figures = nlohmann::json::parse(run_command("check " + sphere() + " --json - --quiet").standard_output);
  EXPECT_THAT(version.standard_output, AllOf(StartsWith("scan2fea "), HasSubstr(figures["schema"].get<std::string>())));
  for (const auto& [name, number] : figures["program"]["libraries"].items())
    EXPECT_THAT(version.standard_output, AllOf(HasSubstr(name), HasSubstr(number.get<std::string>())));
}

}  // namespace
}  // namespace scan2fea
