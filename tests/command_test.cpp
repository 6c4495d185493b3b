// The command's contract, seen from outside: exit codes, one-line errors, no output on failure, the same bytes always.
#include "preproc/mesh/read_surface.hpp"
#include "preproc/mesh/write_surface.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/run_command.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>

namespace scan2fea {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Command : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::string scan_of_a_sphere() const {
    write_surface(analytic::sphere(10, 4), path("sphere.ply"));
    return path("sphere.ply");
  }

  // A failure exits with `code`, says one line that names the input, and leaves no output.
  void expect_failure(const std::string& input, int code) const {
    const std::string output = path("out.inp");
    const auto result = run_command("run '" + path(input) + "' -o '" + output + "' --faces 500");
    EXPECT_EQ(result.exit_code, code) << result.standard_error;
    EXPECT_EQ(result.standard_output, "");
    EXPECT_FALSE(std::filesystem::exists(output));
    const std::string last_line = last_line_of(result.standard_error);
    EXPECT_THAT(last_line, HasSubstr("scan2fea: "));
    EXPECT_THAT(last_line, HasSubstr(input)) << "the line must name the file";
  }

  static std::string last_line_of(std::string text) {
    while (!text.empty() && text.back() == '\n') text.pop_back();
    const auto start = text.rfind('\n');
    return start == std::string::npos ? text : text.substr(start + 1);
  }

  TemporaryFolder folder_;
};

TEST_F(Command, EmptyFileIsUnreadable) {
  write_text(path("empty.stl"), "");
  expect_failure("empty.stl", 3);
}

TEST_F(Command, CloudsBecomeMeshes) {
  std::string rows = "x,y,z\n";
  for (const Vec3& p : analytic::sphere(10, 4).vertices) {
    char row[100];
    std::snprintf(row, sizeof row, "%.9g,%.9g,%.9g\n", p.x(), p.y(), p.z());
    rows += row;
  }
  write_text(path("ball.csv"), rows);
  const std::string input = " '" + path("ball.csv") + "' --json - --quiet -o ";
  const auto run = run_command("run" + input + "'" + path("ball.inp") + "' --faces 1000");
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  const auto report = nlohmann::json::parse(run.standard_output);
  EXPECT_EQ(report["stages"][0]["name"], "reconstruct");
  EXPECT_EQ(report["points"]["count"], analytic::sphere(10, 4).vertices.size());
  EXPECT_LT(report["points"]["largest_distance"], 0.2);
  EXPECT_TRUE(report["surface"]["closed"]);
  EXPECT_NEAR(report["surface"]["volume"], 4189, 0.02 * 4189);
  EXPECT_EQ(run_command("surface" + input + "'" + path("ball.stl") + "' --faces 1000").exit_code, 0);
  ASSERT_EQ(run_command("reconstruct" + input + "'" + path("ball.ply") + "'").exit_code, 0);
  EXPECT_EQ(read_surface(path("ball.ply")).vertices.size(), analytic::sphere(10, 4).vertices.size());
  const auto check = run_command("check '" + path("ball.ply") + "' --reference" + " '" + path("ball.csv") +
                                 "' --quiet --require 'points.largest_distance<=1e-6'");
  EXPECT_EQ(check.exit_code, 0) << check.standard_error;
  EXPECT_EQ(run_command("repair" + input + "'" + path("again.ply") + "'").exit_code, 3) << "no surface";
}

TEST_F(Command, BadCloudsAreOneLine) {
  std::string line, plane;
  for (int i = 0; i < 30; ++i) {
    line += std::to_string(i) + " 0 0\n";
    for (int j = 0; j < 30; ++j) plane += std::to_string(i) + " " + std::to_string(j) + " 7\n";
  }
  const std::vector<std::pair<std::string, int>> clouds{{"", 3},
                                                        {"0 0 0\n1 0 0\n0 1 0\n", 3},
                                                        {"0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n", 4},
                                                        {line, 4},
                                                        {plane, 4},
                                                        {plane + "nan nan nan\n", 3},
                                                        {plane + "one two three\n", 3},
                                                        {"1000000000\n" + plane, 3}};
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    const std::string name = "cloud" + std::to_string(i) + ".xyz";
    write_text(path(name), clouds[i].first);
    expect_failure(name, clouds[i].second);
  }
}

TEST_F(Command, HolesAreClosedOrKept) {
  SurfaceMesh tube = analytic::cylinder(1, 4, 40, 20);
  std::erase_if(tube.triangles, [&](const Triangle& t) { return *std::max_element(t.begin(), t.end()) >= 21 * 40; });
  write_surface(tube, path("tube.ply"));
  const std::string input = "'" + path("tube.ply") + "' -o '" + path("out.ply") + "' --force ";
  EXPECT_EQ(run_command("repair " + input).exit_code, 4) << "its ends are too large to close";
  EXPECT_EQ(run_command("repair " + input + "--holes keep").exit_code, 0);
  EXPECT_EQ(read_surface(path("out.ply")).triangles.size(), tube.triangles.size());
  EXPECT_EQ(run_command("repair " + input + "--holes patch").exit_code, 2);
}

TEST_F(Command, FeaturesThatWereWrittenCanBeGiven) {
  write_surface(analytic::box({4, 3, 2}, 0.25), path("box.ply"));
  const std::string input = "surface '" + path("box.ply") + "' --faces 1200 --force -o '" + path("out.ply") + "' ";
  const std::string edges = path("edges.obj");
  ASSERT_EQ(run_command(input + "--features '" + edges + "'").exit_code, 0);
  const std::string found = contents(path("out.ply")), lines = contents(edges);
  ASSERT_EQ(run_command(input + "--features-from '" + edges + "' --features '" + path("again.obj") + "'").exit_code, 0);
  EXPECT_EQ(contents(path("again.obj")), lines);
  EXPECT_EQ(contents(path("out.ply")), found);
  EXPECT_EQ(run_command(input + "--feature-angle 30 --features-from '" + edges + "'").exit_code, 2);
}

TEST_F(Command, AFileOfFeaturesWithoutLinesMeansNoneAndIsTold) {
  write_surface(analytic::box({4, 3, 2}, 0.25), path("box.ply"));
  write_text(path("edges.obj"), "v 0 0 0\n");
  const auto result = run_command("surface '" + path("box.ply") + "' --faces 600 -o '" + path("out.ply") +
                                  "' --features-from '" + path("edges.obj") + "'");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.standard_error, HasSubstr("no lines"));
}

TEST_F(Command, GivenFeaturesMustBeOnTheScan) {
  write_text(path("edges.obj"), "v 0 0 0\nv 30 0 0\nl 1 2\n");
  const auto result = run_command("surface '" + scan_of_a_sphere() + "' -o '" + path("out.ply") +
                                  "' --faces 500 --features-from '" + path("edges.obj") + "'");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(last_line_of(result.standard_error), HasSubstr("(0, 0, 0)"));
}

TEST_F(Command, AVolumeNeedsItsHolesClosed) {
  const auto result = run_command("run '" + scan_of_a_sphere() + "' -o '" + path("out.inp") + "' --holes keep");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(last_line_of(result.standard_error), HasSubstr("closed"));
}

TEST_F(Command, TakesSizesOfSeveralPlacesFromFlagsAndFiles) {
  // At either end of a bar: before and behind the name of the scan, and in a row in the file.
  write_surface(analytic::box({60, 10, 10}, 2), path("bar.ply"));
  write_text(path("sizes.toml"), "size-ball = [0, 5, 5, 8, 1, 60, 5, 5, 8, 1]\n");
  const std::string wanted = "' -o '" + path("out.ply") + "' --edge-length 5 --force ";
  const auto faces = [&](const std::string& before, const std::string& after) {
    const auto result = run_command("surface " + before + " '" + path("bar.ply") + wanted + after);
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    return read_surface(path("out.ply")).triangles.size();
  };
  const std::size_t none = faces("", ""), one = faces("--size-ball 0 5 5 8 1", "");
  const std::size_t both = faces("--size-ball 0 5 5 8 1", "--size-ball 60 5 5 8 1");
  EXPECT_GT(one, 1.5 * none);
  EXPECT_GT(both, 1.3 * one);
  EXPECT_EQ(faces("", "--config '" + path("sizes.toml") + "'"), both);
}

TEST_F(Command, TruncatedBinaryStlIsUnreadable) {
  write_surface(analytic::sphere(1, 2), path("whole.stl"));
  const std::string whole = contents(path("whole.stl"));
  write_text(path("cut.stl"), whole.substr(0, whole.size() / 2));
  expect_failure("cut.stl", 3);
}

TEST_F(Command, TextNamedStlIsUnreadable) {
  write_text(path("notes.stl"), "Minutes of the meeting.\nNothing was decided.\n");
  expect_failure("notes.stl", 3);
}

TEST_F(Command, ObjIndexOutOfRangeNamesTheLine) {
  write_text(path("bad.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n");
  expect_failure("bad.obj", 3);
  EXPECT_THAT(run_command("check '" + path("bad.obj") + "'").standard_error, HasSubstr("bad.obj:4"));
}

TEST_F(Command, NotANumberIsUnreadable) {
  write_text(path("nan.obj"), "v 0 0 0\nv 1 nan 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  expect_failure("nan.obj", 3);
}

TEST_F(Command, PlyThatPromisesMoreThanItHoldsIsUnreadable) {
  write_text(path("short.ply"),
             "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\n"
             "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  expect_failure("short.ply", 3);
}

TEST_F(Command, DirectoryIsUnreadable) {
  std::filesystem::create_directory(path("folder.stl"));
  expect_failure("folder.stl", 3);
}

TEST_F(Command, MissingFileIsUnreadable) {
  expect_failure("absent.ply", 3);
}

TEST_F(Command, SingleTriangleIsNotMeshable) {
  write_text(path("one.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_failure("one.obj", 4);
}

TEST_F(Command, FlatClosedSurfaceIsNotMeshable) {
  write_text(path("flat.obj"), "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\nf 1 3 2\nf 1 4 3\n");
  expect_failure("flat.obj", 4);
}

TEST_F(Command, WrongFlagsAreWrongUsage) {
  const std::string scan = scan_of_a_sphere();
  const std::string out = " -o '" + path("out.ply") + "'";
  EXPECT_EQ(run_command("").exit_code, 2);
  const CommandResult unknown = run_command("fly");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.standard_error, HasSubstr("no command 'fly'; there are: run, surface, "));
  EXPECT_EQ(run_command("surface '" + scan + "'").exit_code, 2) << "no output";
  EXPECT_EQ(run_command("surface '" + scan + "'" + out + " --faces 500 --ratio 0.5").exit_code, 2) << "two sizes";
  EXPECT_EQ(run_command("surface '" + scan + "'" + out + " --faces -3").exit_code, 2);
  const CommandResult no_deviation = run_command("surface '" + scan + "'" + out + " --deviation 0");
  EXPECT_EQ(no_deviation.exit_code, 2);
  EXPECT_THAT(no_deviation.standard_error, HasSubstr("--deviation: '0' is no length above 0"));
  EXPECT_EQ(run_command("surface '" + scan + "'" + out + " --method magic").exit_code, 2);
  EXPECT_EQ(run_command("surface '" + scan + "' -o '" + path("out.xyz") + "' --faces 500").exit_code, 2);
  EXPECT_EQ(run_command("surface '" + scan + "'" + out + " --faces 500 --require 'beauty<=3'").exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(path("out.ply")));
}

TEST_F(Command, ExistingOutputNeedsForce) {
  const std::string scan = scan_of_a_sphere();
  write_text(path("out.ply"), "precious");
  const std::string command = "surface '" + scan + "' -o '" + path("out.ply") + "' --faces 500";
  EXPECT_EQ(run_command(command).exit_code, 6);
  EXPECT_EQ(contents(path("out.ply")), "precious");
  EXPECT_EQ(run_command(command + " --force").exit_code, 0);
  EXPECT_GT(read_surface(path("out.ply")).triangles.size(), 400U);
}

TEST_F(Command, ExistingReportsNeedForce) {
  const std::string check = "check '" + scan_of_a_sphere() + "' --quiet ";
  const std::string json = check + "--json '" + path("check.json") + "'";
  const std::string report = check + "--report '" + path("a/report") + "'";
  const auto expect_refused_without_force = [&](const std::string& command, const std::string& file) {
    ASSERT_EQ(run_command(command).exit_code, 0);
    write_text(file, "precious");
    const auto again = run_command(command);
    EXPECT_EQ(again.exit_code, 6);
    EXPECT_THAT(again.standard_error, HasSubstr("--force"));
    EXPECT_EQ(contents(file), "precious");
    EXPECT_EQ(run_command(command + " --force").exit_code, 0);
    EXPECT_NE(contents(file), "precious");
  };
  expect_refused_without_force(json, path("check.json"));
  expect_refused_without_force(report, path("a/report/report.html"));
}

TEST_F(Command, OutputsAreDifferentFilesAndNoInputs) {
  const std::string scan = scan_of_a_sphere(), before = contents(scan);
  std::filesystem::create_directory(path("folder"));
  std::filesystem::create_symlink(scan, path("link.ply"));
  const std::string surface = "surface '" + scan + "' --faces 500 --force ";
  const auto expect_refused = [&](const std::string& command) {
    const auto result = run_command(command);
    EXPECT_EQ(result.exit_code, 2) << command;
    EXPECT_THAT(last_line_of(result.standard_error), HasSubstr("try: another name"));
  };
  const std::string out = "-o '" + path("out.ply") + "' ";
  expect_refused(surface + "-o '" + scan + "'");
  expect_refused(surface + "-o '" + path("folder/../sphere.ply") + "'");
  expect_refused(surface + "-o '" + path("link.ply") + "'");
  expect_refused(surface + out + "--json '" + scan + "'");
  expect_refused(surface + out + "--json '" + path("out.ply") + "'");
  expect_refused(surface + out + "--features '" + path("out.ply") + "'");
  expect_refused(surface + out + "--report '" + path("r") + "' --json '" + path("r/report.json") + "'");
  expect_refused(surface + out + "--report '" + path("out.ply") + "'");
  expect_refused(surface + out + "--features '" + path("r.obj") + "' --report '" + path("r.obj") + "'");
  expect_refused("check '" + scan + "' --force --json '" + scan + "'");
  expect_refused("check '" + path("link.ply") + "' --force --reference '" + scan + "' --json '" + scan + "'");
  expect_refused("convert '" + scan + "' --force -o '" + scan + "'");
  EXPECT_EQ(contents(scan), before);
  EXPECT_FALSE(std::filesystem::exists(path("out.ply")));
}

// Before any work: the scan is not even there.
TEST_F(Command, OutputsThatCannotBeWrittenAreToldAtOnce) {
  write_text(path("file"), "");
  std::filesystem::create_directory(path("folder.ply"));
  const std::string surface = "surface '" + path("absent.ply") + "' ", out = "-o '" + path("out.ply") + "' ";
  for (const std::string& outputs :
       {"-o '" + path("folder.ply") + "'", "-o '" + path("absent/out.ply") + "'", "-o '" + path("file/out.ply") + "'",
        out + "--json /dev/full", out + "--json '" + path("absent/out.json") + "'",
        out + "--features '" + path("absent/lines.obj") + "'", out + "--report '" + path("file") + "'",
        out + "--report '" + path("file/a/b") + "'"}) {
    const auto result = run_command(surface + outputs);
    EXPECT_EQ(result.exit_code, 6) << outputs << result.standard_error;
    EXPECT_THAT(result.standard_error, Not(HasSubstr("absent.ply")));
    EXPECT_EQ(std::count(result.standard_error.begin(), result.standard_error.end(), '\n'), 1);
  }
}

TEST_F(Command, AFailingStdoutLeavesNoMesh) {
  const std::string surface = "surface '" + scan_of_a_sphere() + "' --faces 500 -o '" + path("out.ply") + "' ";
  for (const std::string report : {"", "--json -", "--quiet --json -"}) {
    const auto result = run_command(surface + report, "/dev/full");
    EXPECT_EQ(result.exit_code, 6) << report;
    EXPECT_FALSE(std::filesystem::exists(path("out.ply")));
  }
}

TEST_F(Command, FailureLeavesAnExistingOutputAlone) {
  write_text(path("one.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write_text(path("out.ply"), "precious");
  EXPECT_EQ(run_command("surface '" + path("one.obj") + "' -o '" + path("out.ply") + "' --force").exit_code, 4);
  EXPECT_EQ(contents(path("out.ply")), "precious");
}

TEST_F(Command, MissingFolderCannotBeWritten) {
  EXPECT_EQ(run_command("surface '" + scan_of_a_sphere() + "' -o '" + path("no/such/out.ply") + "'").exit_code, 6);
}

TEST_F(Command, FailedGateExitsWithOneAndWritesNoMesh) {
  const std::string command = "surface '" + scan_of_a_sphere() + "' -o '" + path("out.ply") + "' --faces 500 --json '" +
                              path("report.json") + "' --require 'edge_ratio.mean<=1.0'";
  EXPECT_EQ(run_command(command).exit_code, 1);
  EXPECT_FALSE(std::filesystem::exists(path("out.ply")));
  const auto report = nlohmann::json::parse(contents(path("report.json")));
  EXPECT_FALSE(report.at("gates").at(0).at("pass").get<bool>());
}

TEST_F(Command, RunFillsTheVolumeOfTheScan) {
  const auto result = run_command("run '" + scan_of_a_sphere() + "' -o '" + path("part.inp") +
                                  "' --faces 1000 --order 2 --quiet --json -");
  ASSERT_EQ(result.exit_code, 0) << result.standard_error;
  EXPECT_EQ(result.standard_error, "");
  const auto report = nlohmann::json::parse(result.standard_output);
  const double scan_volume = enclosed_volume(analytic::sphere(10, 4));
  EXPECT_NEAR(report.at("volume_mesh").at("volume").get<double>(), scan_volume, 1e-3 * scan_volume);
  EXPECT_EQ(report.at("volume_mesh").at("inverted").get<int>(), 0);
  EXPECT_EQ(report.at("volume_mesh").at("order").get<int>(), 2);
  EXPECT_EQ(report.at("surface").at("self_intersections").get<int>(), 0);
  EXPECT_GE(report.at("stages").size(), 4U);
  EXPECT_THAT(contents(path("part.inp")), HasSubstr("C3D10"));
}

// The file tells what `run` told, and gates hold what the elements are, not what their corners are.
TEST_F(Command, FiguresOfSecondOrderAreOfTheCurvedElements) {
  const std::string scan = scan_of_a_sphere(), part = path("curved.vtu");
  const auto made = run_command("run '" + scan + "' -o '" + part + "' --faces 300 --order 2 --quiet --json -");
  ASSERT_EQ(made.exit_code, 0) << made.standard_error;
  const auto report = nlohmann::json::parse(made.standard_output);
  for (const auto& stage : report.at("stages"))
    if (stage.at("name") == "second order") {
      const double volume = report.at("volume_mesh").at("volume");
      EXPECT_NEAR(volume, stage.at("curved_volume").get<double>(), 1e-12 * volume);
      EXPECT_LE(report.at("volume_mesh").at("scaled_jacobian").at("min").get<double>(),
                stage.at("least_scaled_jacobian").get<double>() + 1e-9);  // which is of those with curved edges
    }
  EXPECT_EQ(report.at("surface").at("volume"), report.at("volume_mesh").at("volume"));
  const auto check = [&](const std::string& flags) { return run_command("check '" + part + "' --quiet " + flags); };
  const auto found = nlohmann::json::parse(check("--reference '" + scan + "' --json -").standard_output);
  for (const char* figure : {"volume", "edge_ratio", "min_dihedral_deg", "max_dihedral_deg"})
    EXPECT_NEAR(found.at("volume_mesh").at(figure).get<double>(), report.at("volume_mesh").at(figure).get<double>(),
                1e-9 * std::abs(report.at("volume_mesh").at(figure).get<double>()))
        << figure;
  for (const char* figure : {"hausdorff_pct_diagonal", "rms_pct_diagonal", "volume_difference_pct"})
    EXPECT_NEAR(found.at("deviation").at(figure).get<double>(), report.at("deviation").at(figure).get<double>(), 1e-4)
        << figure;
  // As surfaces they are the straight ones of the corners, which lie farther off.
  ASSERT_EQ(run_command("convert '" + part + "' -o '" + path("corners.ply") + "' --quiet").exit_code, 0);
  const auto corners = nlohmann::json::parse(
      run_command("check '" + path("corners.ply") + "' --reference '" + scan + "' --quiet --json -").standard_output);
  const double straight = corners.at("deviation").at("rms_pct_diagonal"),
               curved = found.at("deviation").at("rms_pct_diagonal");
  EXPECT_LT(curved, straight);
  const auto gate = [](const std::string& name, double limit) {
    return " --require '" + name + "<=" + std::to_string(limit) + "'";
  };
  const double between = 0.5 * (straight + curved);
  EXPECT_EQ(check("--reference '" + scan + "'" + gate("rms_pct_diagonal", between)).exit_code, 0);
  EXPECT_EQ(run_command("check '" + path("corners.ply") + "' --quiet --reference '" + scan + "'" +
                        gate("rms_pct_diagonal", between))
                .exit_code,
            1);
  // A second-order mesh as the reference is curved, too.
  const auto itself = nlohmann::json::parse(check("--reference '" + part + "' --json -").standard_output);
  EXPECT_LT(itself.at("deviation").at("hausdorff_pct_diagonal").get<double>(), 0.005);
  EXPECT_NEAR(itself.at("deviation").at("volume_difference_pct").get<double>(), 0, 1e-9);
}

TEST_F(Command, BytesAreTheSameForAnyNumberOfThreads) {
  const std::string command = "run '" + scan_of_a_sphere() + "' --faces 1000 -o '";
  ASSERT_EQ(run_command(command + path("one.inp") + "' --threads 1").exit_code, 0);
  ASSERT_EQ(run_command(command + path("two.inp") + "' --threads 2").exit_code, 0);
  ASSERT_EQ(run_command(command + path("again.inp") + "' --threads 2").exit_code, 0);
  const std::string one = contents(path("one.inp"));
  EXPECT_TRUE(one == contents(path("two.inp")));
  EXPECT_TRUE(one == contents(path("again.inp")));
}

TEST_F(Command, ConfigurationGivesWhatFlagsLeaveOut) {
  write_text(path("part.toml"), "ratio = 0.9\nseed = 3\n\n[surface]\nfaces = 300\n");
  const std::string scan = scan_of_a_sphere();
  ASSERT_EQ(
      run_command("surface '" + scan + "' -o '" + path("a.ply") + "' --config '" + path("part.toml") + "'").exit_code,
      0);
  EXPECT_NEAR(static_cast<double>(read_surface(path("a.ply")).triangles.size()), 300, 6);
  ASSERT_EQ(
      run_command("surface '" + scan + "' -o '" + path("b.ply") + "' --faces 600 --config '" + path("part.toml") + "'")
          .exit_code,
      0);
  EXPECT_NEAR(static_cast<double>(read_surface(path("b.ply")).triangles.size()), 600, 12);
  write_text(path("typo.toml"), "faecs = 300\n");
  const auto result =
      run_command("surface '" + scan + "' -o '" + path("c.ply") + "' --config '" + path("typo.toml") + "'");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.standard_error, HasSubstr("typo.toml:1"));
}

TEST_F(Command, ConvertKeepsTheMesh) {
  const std::string scan = scan_of_a_sphere();
  ASSERT_EQ(run_command("convert '" + scan + "' -o '" + path("sphere.off") + "'").exit_code, 0);
  EXPECT_EQ(read_surface(path("sphere.off")).vertices, read_surface(scan).vertices);
  ASSERT_EQ(run_command("run '" + scan + "' --faces 500 -o '" + path("part.vtu") + "'").exit_code, 0);
  ASSERT_EQ(run_command("convert '" + path("part.vtu") + "' -o '" + path("part.msh") + "' --msh-version 2.2").exit_code,
            0);
  EXPECT_TRUE(contents(path("part.msh")).starts_with("$MeshFormat\n2.2 0 8\n"));
  const auto report = nlohmann::json::parse(run_command("check '" + path("part.msh") + "' --json -").standard_output);
  EXPECT_EQ(report.at("volume_mesh").at("inverted").get<int>(), 0);
  EXPECT_EQ(run_command("convert '" + scan + "' -o '" + path("sphere.su2") + "'").exit_code, 2)
      << "a surface is no volume mesh";
}

TEST_F(Command, EnrichKeepsTheMeasuredPoints) {
  const std::string scan = scan_of_a_sphere();  // edges of about 0.75
  ASSERT_EQ(run_command("enrich '" + scan + "' -o '" + path("rich.ply") + "' --sampling-radius 0.4").exit_code, 0);
  const SurfaceMesh before = read_surface(scan), after = read_surface(path("rich.ply"));
  ASSERT_GT(after.vertices.size(), before.vertices.size());
  for (std::size_t v = 0; v < before.vertices.size(); ++v) ASSERT_EQ(after.vertices[v], before.vertices[v]);
  EXPECT_EQ(run_command("surface '" + scan + "' -o '" + path("s.ply") + "' --enrich --faces 500").exit_code, 0);
}

TEST_F(Command, EnrichesTheDomainOnly) {
  const std::string scan = scan_of_a_sphere();
  ASSERT_EQ(
      run_command("enrich '" + scan + "' -o '" + path("half.ply") + "' --sampling-radius 0.4 --domain 'x<0'").exit_code,
      0);
  const SurfaceMesh before = read_surface(scan), after = read_surface(path("half.ply"));
  ASSERT_GT(after.vertices.size(), before.vertices.size());
  for (std::size_t v = before.vertices.size(); v < after.vertices.size(); ++v) EXPECT_LT(after.vertices[v].x(), 1e-9);
  const CommandResult nothing = run_command("enrich '" + scan + "' -o '" + path("none.ply") + "' --domain 'x>1000'");
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_THAT(nothing.standard_error, HasSubstr("nothing"));
}

TEST_F(Command, ObjectivesBelongToCollapse) {
  const std::string scan = scan_of_a_sphere();
  for (const std::string objective :
       {"shannon", "a-entropy", "regularised-a-entropy", "entropy-weighted", "mean-edge-ratio", "midpoint"}) {
    const CommandResult result = run_command("surface '" + scan + "' -o '" + path(objective + ".ply") +
                                             "' --faces 500 --objective " + objective);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.standard_error, HasSubstr("made by --method collapse"));
  }
  const CommandResult refused =
      run_command("surface '" + scan + "' -o '" + path("x.ply") + "' --faces 500 --method lattice --objective shannon");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.standard_error, HasSubstr("scan2fea: --objective: belongs to --method collapse"));
}

TEST_F(Command, TetrahedraNeedAClosedSurface) {
  SurfaceMesh open = analytic::sphere(1, 3);
  open.triangles.pop_back();
  write_surface(open, path("open.ply"));
  const CommandResult result = run_command("tetrahedralize '" + path("open.ply") + "' -o '" + path("out.vtu") + "'");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(last_line_of(result.standard_error), HasSubstr("not closed"));
  EXPECT_FALSE(std::filesystem::exists(path("out.vtu")));
}

TEST_F(Command, CheckMeasuresAndGates) {
  const std::string scan = scan_of_a_sphere();
  const auto result = run_command("check '" + scan + "' --reference '" + scan + "' --json - --require closed==1");
  ASSERT_EQ(result.exit_code, 0) << result.standard_error;
  const auto report = nlohmann::json::parse(result.standard_output);
  EXPECT_TRUE(report.at("surface").at("closed").get<bool>());
  EXPECT_EQ(report.at("surface").at("genus").get<int>(), 0);
  EXPECT_NEAR(report.at("deviation").at("hausdorff_pct_diagonal").get<double>(), 0, 1e-9);
  EXPECT_EQ(run_command("check '" + scan + "' --require 'edge_ratio.max<=1.0'").exit_code, 1);
}

}  // namespace
}  // namespace scan2fea
