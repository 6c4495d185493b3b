// Files of meshes in parts: what they hold, what of them is read back, and what the command says of them.
#include "export/elmer.hpp"
#include "export/formats.hpp"
#include "export/partition.hpp"
#include "export/vtk.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/output_file.hpp"
#include "tests/error_from.hpp"
#include "tests/part_with_sets.hpp"
#include "tests/run_command.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <set>

namespace scan2fea {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

struct Divided {
  TetMesh mesh;
  FileOptions options;
};

Divided divided_part(int order, std::size_t parts) {
  Divided made{.mesh = analytic::part_with_sets(order, {8, 4, 2}), .options = {}};
  made.options.part_sizes = order_by_parts(made.mesh, parts);
  return made;
}

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

void replace_in(const fs::path& file, const std::string& from, const std::string& to) {
  std::string text = contents(file);
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  write_text(file, text.replace(at, from.size(), to));
}

class MeshInParts : public testing::TestWithParam<int> {
 protected:
  // As a shell's word.
  std::string path(const std::string& name) const { return "'" + (folder_ / name).string() + "'"; }

  TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Order, MeshInParts, testing::Values(1, 2));

TEST_P(MeshInParts, PiecesOfPvtuArePutTogether) {
  for (const std::size_t parts : {1U, 2U, 7U}) {
    auto [mesh, options] = divided_part(GetParam(), parts);
    options.element_fields = {{.name = "number", .values = std::vector<double>(mesh.tetrahedra.size(), 3)}};
    EXPECT_EQ(write_volume(mesh, folder_ / "a&b.pvtu", options), Notes{});
    const MeshFile read = read_mesh(folder_ / "a&b.pvtu");
    EXPECT_EQ(read.other_arrays, std::vector<std::string>{"number"});
    const auto& found = std::get<TetMesh>(read.mesh);
    EXPECT_EQ(found.nodes, mesh.nodes);
    EXPECT_EQ(found.tetrahedra, mesh.tetrahedra);
    EXPECT_EQ(found.mid_edge_nodes, mesh.mid_edge_nodes);
    EXPECT_EQ(found.node_sets, mesh.node_sets);
    EXPECT_EQ(found.element_sets, mesh.element_sets);
    EXPECT_EQ(found.unit, "mm");
    ASSERT_EQ(found.face_sets.size(), mesh.face_sets.size());
    for (std::size_t s = 0; s < mesh.face_sets.size(); ++s)
      EXPECT_EQ(nodes_of_faces(found, found.face_sets[s].members), nodes_of_faces(mesh, mesh.face_sets[s].members));
    // Each piece is a mesh of its own.
    double volume = 0;
    for (const fs::path& piece : pieces_of_pvtu(folder_ / "a&b.pvtu", parts))
      volume += total_volume(read_volume(piece));
    EXPECT_NEAR(volume, 8, 1e-12);
  }
}

TEST_P(MeshInParts, AnEarlierLargerNumberOfPiecesIsNotOfTheMesh) {
  for (const std::size_t parts : {4U, 2U}) {
    const auto [mesh, options] = divided_part(GetParam(), parts);
    write_volume(mesh, folder_ / "part.pvtu", options);
  }
  EXPECT_EQ(names_in(folder_.path()),
            (std::set<std::string>{"part.pvtu", "part_0.vtu", "part_1.vtu", "part_2.vtu", "part_3.vtu"}));
  EXPECT_NEAR(total_volume(read_volume(folder_ / "part.pvtu")), 8, 1e-12);
}

TEST_P(MeshInParts, WhatIsWrongWithPiecesIsTold) {
  const auto [mesh, options] = divided_part(GetParam(), 2);
  const fs::path file = folder_ / "part.pvtu";
  const auto error = [&] { return std::string(error_from<InvalidInput>([&] { read_mesh(file); }).what()); };
  const auto renew = [&, &made = mesh, &as = options] { write_volume(made, file, as); };

  renew();
  fs::remove(folder_ / "part_1.vtu");
  EXPECT_THAT(error(), HasSubstr("part_1.vtu"));
  renew();
  replace_in(folder_ / "part_1.vtu", "\"GlobalNodeIds\" format", "\"GlobalNodeIdx\" format");
  EXPECT_THAT(error(), HasSubstr("part_1.vtu: has no array GlobalNodeIds"));
  renew();
  replace_in(file, "GhostLevel=\"0\"", "GhostLevel=\"1\"");
  EXPECT_THAT(error(), HasSubstr("ghost cells"));
  renew();
  replace_in(file, "PUnstructuredGrid", "PPolyData");
  EXPECT_THAT(error(), HasSubstr("PPolyData"));
  renew();
  const auto other = divided_part(GetParam(), 2);
  TetMesh moved = other.mesh;
  for (Vec3& p : moved.nodes) p.x() += 1;
  write_volume(moved, folder_ / "moved.pvtu", other.options);
  fs::copy_file(folder_ / "moved_1.vtu", folder_ / "part_1.vtu", fs::copy_options::overwrite_existing);
  EXPECT_THAT(error(), HasSubstr("a node at different places"));
  write_text(file, "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\"></VTKFile>\n");
  EXPECT_THAT(error(), HasSubstr("has no piece"));
}

TEST_P(MeshInParts, ElmersFolderIsTheWholeMeshToo) {
  const auto [mesh, options] = divided_part(GetParam(), 3);
  write_volume(mesh, folder_ / "mesh.header", options);
  EXPECT_EQ(read_volume(folder_ / "mesh.header").tetrahedra, mesh.tetrahedra);
  std::size_t files = 0;
  for (std::size_t part = 1; part <= 3; ++part)
    for (const fs::path& file : files_of_elmer_part(folder_ / "mesh.header", 3, part)) files += fs::exists(file);
  EXPECT_EQ(files, 15U);
}

TEST_P(MeshInParts, FilesAreThoseThatTheTableTells) {
  for (const FileFormat& format : file_formats()) {
    if (format.write_volume == nullptr) continue;
    auto [mesh, options] = divided_part(GetParam(), 3);
    if (format.parts == Parts::never) options.part_sizes.clear();
    const fs::path folder = folder_ / std::string(format.extension.substr(1));
    fs::create_directory(folder);
    const fs::path file = folder / ("mesh" + std::string(format.extension));
    write_volume(mesh, file, options);
    std::set<fs::path> there;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (!entry.is_directory()) there.insert(entry.path());
    const std::vector<fs::path> told = files_of_volume(file, format.parts == Parts::never ? 0 : 3);
    EXPECT_EQ(there, std::set<fs::path>(told.begin(), told.end())) << format.extension;
    EXPECT_EQ(told.back(), file);
  }
}

using CommandInParts = MeshInParts;
INSTANTIATE_TEST_SUITE_P(Order, CommandInParts, testing::Values(1, 2));

TEST_P(CommandInParts, FiguresAreThoseOfTheWholeMesh) {
  const auto [mesh, options] = divided_part(GetParam(), 1);
  write_volume(mesh, folder_ / "part.inp");
  const std::string convert = "convert " + path("part.inp") + " -o ";
  const CommandResult made = run_command(convert + path("part.pvtu") + " --parts 3");
  ASSERT_EQ(made.exit_code, 0) << made.standard_error;
  EXPECT_THAT(made.standard_error, HasSubstr("3 parts of "));
  ASSERT_EQ(run_command("convert " + path("part.inp") + " -o " + path("part.vtu")).exit_code, 0);
  const auto figures = [&](const std::string& file) {
    const CommandResult checked = run_command("check " + path(file) + " --json - --quiet");
    EXPECT_EQ(checked.exit_code, 0) << checked.standard_error;
    return nlohmann::json::parse(checked.standard_output);
  };
  const nlohmann::json whole = figures("part.vtu"), parts = figures("part.pvtu");
  for (const char* figure : {"nodes", "tetrahedra", "order", "inverted"})
    EXPECT_EQ(parts["volume_mesh"][figure], whole["volume_mesh"][figure]) << figure;
  EXPECT_EQ(parts["surface"]["closed"], true);
  EXPECT_EQ(parts["surface"]["components"], 1);
  EXPECT_EQ(parts["sets"].size(), whole["sets"].size());
  const CommandResult back = run_command("convert " + path("part.pvtu") + " -o " + path("back.inp"));
  EXPECT_EQ(back.standard_error.find("left out"), std::string::npos) << back.standard_error;
}

TEST_P(CommandInParts, FormatsThatHoldPartsAreNamed) {
  const auto [mesh, options] = divided_part(GetParam(), 1);
  write_volume(mesh, folder_ / "part.inp");
  const std::string convert = "convert " + path("part.inp") + " -o ";
  const CommandResult never = run_command(convert + path("part.med") + " --parts 3");
  EXPECT_EQ(never.exit_code, 2);
  EXPECT_THAT(never.standard_error,
              testing::AllOf(HasSubstr("--parts 3"), HasSubstr(".pvtu"), HasSubstr(".xdmf"), HasSubstr(".header")));
  const CommandResult none = run_command(convert + path("part.pvtu"));
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.standard_error, HasSubstr("--parts 4"));
  EXPECT_EQ(run_command(convert + path("part.pvtu") + " --parts 0").exit_code, 2);
  const CommandResult many = run_command(convert + path("part.pvtu") + " --parts 100000");
  EXPECT_EQ(many.exit_code, 2);
  EXPECT_THAT(many.standard_error, HasSubstr("(limit: 384)"));
  EXPECT_EQ(run_command(convert + "- --to pvtu --parts 2").exit_code, 2);
  EXPECT_EQ(names_in(folder_.path()), std::set<std::string>{"part.inp"});
}

// All of them are checked before any work, and put in place together.
TEST_P(CommandInParts, NoPieceIsOverwrittenWithoutForce) {
  const auto [mesh, options] = divided_part(GetParam(), 1);
  write_volume(mesh, folder_ / "part.inp");
  write_text(folder_ / "part_1.vtu", "mine");
  const std::string convert = "convert " + path("part.inp") + " -o ";
  const CommandResult refused = run_command(convert + path("part.pvtu") + " --parts 2");
  EXPECT_EQ(refused.exit_code, 6);
  EXPECT_THAT(refused.standard_error, HasSubstr("part_1.vtu"));
  EXPECT_EQ(contents(folder_ / "part_1.vtu"), "mine");
  EXPECT_EQ(names_in(folder_.path()), (std::set<std::string>{"part.inp", "part_1.vtu"}));
  EXPECT_EQ(run_command(convert + path("part.pvtu") + " --parts 2 --force").exit_code, 0);
  EXPECT_NEAR(total_volume(read_volume(folder_ / "part.pvtu")), 8, 1e-12);
  write_text(folder_ / "other_facets.xdmf", "mine");
  EXPECT_EQ(run_command(convert + path("other.xdmf")).exit_code, 6);
  EXPECT_EQ(contents(folder_ / "other_facets.xdmf"), "mine");
  fs::remove(folder_ / "part_1.vtu");
  fs::create_directory(folder_ / "part_1.vtu");
  EXPECT_EQ(run_command(convert + path("part.pvtu") + " --parts 2 --force").exit_code, 6);
}

// More than a process may open by default.
TEST(ManyParts, AreAsManyFilesAsTheyNeed) {
  const TemporaryFolder folder;
  TetMesh mesh = analytic::tetrahedra_of_box({4, 2, 1}, {8, 8, 8}, 1);
  mesh.boundary = find_boundary(mesh.tetrahedra);
  write_volume(mesh, folder / "part.inp");
  const std::string input = "convert '" + (folder / "part.inp").string() + "' --parts 1500 -o '";
  for (const char* name : {"mesh.header", "part.pvtu"}) {
    const CommandResult made = run_command(input + (folder / name).string() + "'", {}, "ulimit -Sn 256;");
    ASSERT_EQ(made.exit_code, 0) << made.standard_error;
  }
  EXPECT_EQ(names_in(folder / "partitioning.1500").size(), 7500U);
  EXPECT_EQ(read_volume(folder / "part.pvtu").tetrahedra.size(), mesh.tetrahedra.size());
}

}  // namespace
}  // namespace scan2fea
