// Units are read, settled, converted and never relabelled.
#include "export/formats.hpp"
#include "preproc/mesh/length_unit.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/part_with_sets.hpp"
#include "tests/run_command.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace scan2fea {
namespace {

using testing::HasSubstr;

TEST(Units, AreUnderstoodAsUsersWriteThem) {
  for (const char* text : {"mm", "MM", "millimetre", "Millimeters"}) EXPECT_EQ(length_unit(text), "mm") << text;
  for (const char* text : {"in", "inch", "Inches", "\""}) EXPECT_EQ(length_unit(text), "in") << text;
  for (const char* text : {"ft", "foot", "feet"}) EXPECT_EQ(length_unit(text), "ft") << text;
  for (const char* text : {"um", "micron", "microns", "\xc2\xb5m"}) EXPECT_EQ(length_unit(text), "um") << text;
  EXPECT_EQ(length_unit("m"), "m");
  EXPECT_EQ(length_unit("metres"), "m");
  for (const char* text : {"", "s", "furlong", "mms", "kg"}) EXPECT_EQ(length_unit(text), std::nullopt) << text;
}

class UnitsOfFiles : public testing::Test {
 protected:
  void SetUp() override {
    const TetMesh mesh = analytic::part_with_sets(1);
    write_volume(mesh, folder_ / "part.inp");
  }
  CommandResult convert(const std::string& flags, const std::string& output) {
    return run_command("convert '" + (folder_ / "part.inp").string() + "' -o '" + (folder_ / output).string() +
                       "' --force " + flags);
  }
  TemporaryFolder folder_;
};

TEST_F(UnitsOfFiles, AreNotRelabelled) {
  const CommandResult wrong = convert("--unit m", "out.msh");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.standard_error, HasSubstr("the file says that its unit is mm"));
  EXPECT_THAT(wrong.standard_error, HasSubstr("--scale mm:m"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.msh"));
  EXPECT_EQ(convert("--unit MM", "out.msh").exit_code, 0);
  const CommandResult run = run_command("surface '" + (folder_ / "part.inp").string() + "' -o '" +
                                        (folder_ / "out.ply").string() + "' --unit inch");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.standard_error, HasSubstr("its unit is mm"));
  EXPECT_EQ(run_command("check '" + (folder_ / "part.inp").string() + "' --unit m").exit_code, 2);
  EXPECT_THAT(run_command("check '" + (folder_ / "part.inp").string() + "'").standard_error, HasSubstr(" mm"));
}

TEST_F(UnitsOfFiles, OfAReferenceAreThoseOfTheMesh) {
  ASSERT_EQ(convert("--scale mm:m", "metres.inp").exit_code, 0);
  const std::string mesh = "'" + (folder_ / "metres.inp").string() + "'";
  const std::string reference = "'" + (folder_ / "part.inp").string() + "'";
  for (const std::string& command : {"check " + mesh + " --reference " + reference, "compare " + mesh + " " + reference,
                                     "compare " + mesh + " " + mesh + " --reference " + reference}) {
    const CommandResult result = run_command(command);
    EXPECT_EQ(result.exit_code, 2) << command;
    EXPECT_THAT(result.standard_error, HasSubstr("its unit is mm")) << command;
    EXPECT_THAT(result.standard_error, HasSubstr("--scale mm:m")) << command;
  }
}

TEST_F(UnitsOfFiles, AreConvertedByScale) {
  const CommandResult scaled = convert("--scale mm:m", "out.vtu");
  EXPECT_EQ(scaled.exit_code, 0) << scaled.standard_error;
  EXPECT_THAT(scaled.standard_error, HasSubstr("converted from mm to m: coordinates times 0.001"));
  const TetMesh metres = read_volume(folder_ / "out.vtu");
  EXPECT_EQ(metres.unit, "m");
  EXPECT_NEAR(total_volume(metres), 8e-9, 1e-20);
  EXPECT_EQ(convert("--scale inch:m", "out.vtu").exit_code, 2) << "the file is in millimetres";
  EXPECT_EQ(convert("--scale mm", "out.vtu").exit_code, 2);
}

TEST_F(UnitsOfFiles, GoThroughAllSurfaces) {
  NamedSurface ball;
  ball.mesh = analytic::sphere(10, 2);
  ball.unit = "in";
  for (const FileFormat& format : file_formats()) {
    if (format.write_surface == nullptr) continue;
    for (const bool ascii : {false, true}) {
      FileOptions options;
      options.ascii = ascii;
      const auto file = folder_ / ("ball" + std::string(format.extension));
      EXPECT_EQ(write_surface(ball, file, options), Notes{}) << file;
      const MeshFile read = read_mesh(file);
      const auto& surface = std::get<NamedSurface>(read.mesh);
      EXPECT_EQ(surface.unit, "in") << file;
      EXPECT_EQ(surface.mesh.triangles.size(), ball.mesh.triangles.size()) << file;
      EXPECT_NEAR(enclosed_volume(surface.mesh), enclosed_volume(ball.mesh), 1e-3) << file;
    }
  }
}

TEST_F(UnitsOfFiles, StandBesideTheNamesOfSurfaces) {
  write_text(
      folder_ / "two.stl",
      "solid BRACKET unit of length: mm\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
      "endloop\nendfacet\nendsolid\nsolid PIN\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1\nvertex 1 0 1\n"
      "vertex 0 1 1\nendloop\nendfacet\nendsolid\n");
  write_text(folder_ / "two.obj",
             "# unit of length: mm\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\ng BRACKET\nusemtl steel\nf 1 2 3\ng PIN\n"
             "f 2 4 3\ng empty\n");
  for (const char* name : {"two.stl", "two.obj"}) {
    const MeshFile read = read_mesh(folder_ / name);
    const auto& surface = std::get<NamedSurface>(read.mesh);
    EXPECT_EQ(surface.unit, "mm") << name;
    ASSERT_EQ(surface.face_sets.size(), std::string(name) == "two.stl" ? 2U : 3U) << name;
    EXPECT_EQ(surface.face_sets[0], (NamedSet{"BRACKET", {0}})) << name;
    EXPECT_EQ(surface.face_sets.back(), (NamedSet{"PIN", {1}})) << name;
    write_surface(surface, folder_ / "again.obj");
    const MeshFile again = read_mesh(folder_ / "again.obj");
    for (const NamedSet& set : surface.face_sets) {
      const auto& sets = std::get<NamedSurface>(again.mesh).face_sets;
      ASSERT_LT(find_set(sets, set.name), sets.size()) << set.name;
      EXPECT_EQ(sets[find_set(sets, set.name)].members, set.members);
    }
  }
}

TEST_F(UnitsOfFiles, OfCompressedScansAreOfNoMatter) {
  NamedSurface ball;
  ball.mesh = analytic::sphere(10, 2);
  for (const char* name : {"ball.stl", "ball.obj", "ball.ply", "ball.off", "ball.vtp"}) {
    const std::string file = (folder_ / name).string();
    write_surface(ball, file);
    ASSERT_EQ(std::system(("gzip -k '" + file + "'").c_str()), 0);
    const MeshFile read = read_mesh(file + ".gz");
    EXPECT_EQ(std::get<NamedSurface>(read.mesh).mesh.triangles.size(), ball.mesh.triangles.size()) << name;
    const std::string bytes = contents(file + ".gz");
    write_text(folder_ / (std::string("cut-") + name + ".gz"), bytes.substr(0, bytes.size() / 2));
    EXPECT_EQ(run_command("check '" + (folder_ / (std::string("cut-") + name + ".gz")).string() + "'").exit_code, 3);
  }
}

}  // namespace
}  // namespace scan2fea
