#include "export/formats.hpp"

#include "preproc/mesh/error.hpp"
#include "tests/error_from.hpp"
#include "tests/part_with_sets.hpp"
#include "tests/structured_tets.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

namespace scan2fea {
namespace {

TEST(Formats, AreToldByTheExtensionInAnyCase) {
  EXPECT_EQ(find_format("a/part.inp")->extension, ".inp");
  EXPECT_EQ(find_format("PART.VTU")->extension, ".vtu");
  EXPECT_EQ(find_format("part.old.msh")->extension, ".msh");
  EXPECT_EQ(find_format("part.xyz"), nullptr);
  EXPECT_EQ(find_format("inp"), nullptr);
  EXPECT_FALSE(writes_volume("part.stl"));
  EXPECT_TRUE(writes_surface("part.stl"));
}

TEST(Formats, AllCarryTheSameMesh) {
  const TemporaryFolder folder;
  const TetMesh mesh = analytic::tetrahedra_of_box({3, 2, 1}, {3, 2, 2}, 2);
  for (const char* name : {"box.inp", "box.msh", "box.vtu"}) {
    write_volume(mesh, folder / name);
    const TetMesh read = read_volume(folder / name);
    EXPECT_EQ(read.tetrahedra, mesh.tetrahedra) << name;
    EXPECT_EQ(read.mid_edge_nodes, mesh.mid_edge_nodes) << name;
    EXPECT_NEAR(total_volume(read), 6, 1e-12) << name;
  }
}

// Neither the clock nor anything else of the moment is in a file.
TEST(Formats, AreTheSameBytesWheneverTheyAreWritten) {
  const TemporaryFolder folder;
  const TetMesh mesh = analytic::tetrahedra_of_box({3, 2, 1}, {3, 2, 2}, 1);
  std::map<std::string, std::string> first;
  for (const bool again : {false, true}) {
    if (again) std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5 counts seconds
    for (const FileFormat& format : file_formats()) {
      if (format.write_volume == nullptr) continue;
      const std::string name = "mesh" + std::string(format.extension);  // as Elmer wants it
      write_volume(mesh, folder / name);
      if (!again) first[name] = contents(folder / name);
      EXPECT_EQ(contents(folder / name) == first[name], true) << name;
    }
  }
  EXPECT_EQ(read_volume(folder / "mesh.med").tetrahedra.size(), mesh.tetrahedra.size());
}

TEST(Formats, AnUnknownExtensionIsWrongUsageThatListsTheKnown) {
  const TemporaryFolder folder;
  const TetMesh mesh = analytic::tetrahedra_of_box({1, 1, 1}, {1, 1, 1}, 1);
  EXPECT_THAT(error_from<WrongUsage>([&] { write_volume(mesh, folder / "box.xyz"); }).what(),
              ::testing::HasSubstr(".inp (Abaqus, CalculiX)"));
  EXPECT_THROW(read_volume(folder / "box.xyz"), WrongUsage);
}

// XDMF has the facets of part.xdmf in part_facets.xdmf, which can be a mesh that has nothing to do with it.
TEST(Formats, AMeshNamedAsFacetsIsNotPutOnTopOfAnother) {
  const TemporaryFolder folder;
  const TetMesh mesh = analytic::tetrahedra_of_box({1, 1, 1}, {1, 1, 1}, 1);
  write_volume(mesh, folder / "part.xdmf");
  write_volume(mesh, folder / "part_facets.xdmf");
  EXPECT_THAT(error_from<InvalidInput>([&] { read_volume(folder / "part.xdmf"); }).what(),
              ::testing::HasSubstr("are not triangles"));
  EXPECT_EQ(read_volume(folder / "part_facets.xdmf").tetrahedra, mesh.tetrahedra);
}

TEST(Formats, AFailureLeavesAnExistingFile) {
  const TemporaryFolder folder;
  const TetMesh mesh = analytic::tetrahedra_of_box({1, 1, 1}, {1, 1, 1}, 1);
  for (const char* name : {"box.inp", "box.msh", "box.vtu"})
    EXPECT_THROW(write_volume(mesh, folder / "missing" / name), IoError) << name;
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(Formats, NumbersAndPrefixesAreReadBackAsTheSameMesh) {
  const FileOptions options{.set_prefix = "PIN_", .numbers = {.first_node = 70001, .first_element = 80001}};
  const TetMesh mesh = analytic::part_with_sets(2);
  for (const FileFormat& format : file_formats()) {
    if (format.write_volume == nullptr) continue;
    const TemporaryFolder folder;
    const auto file = folder / (format.extension == ".header" ? "mesh.header" : "part" + std::string(format.extension));
    const Notes notes = write_volume(mesh, file, options);
    const TetMesh read = read_volume(file);
    EXPECT_EQ(read.tetrahedra, mesh.tetrahedra) << format.extension;
    const auto has = [&](const std::vector<NamedSet>& sets, const char* name) {
      const std::size_t s = find_set(sets, name);
      return s < sets.size() ? sets[s].members : std::vector<std::uint32_t>{};
    };
    if (format.volume->element_sets) {
      EXPECT_EQ(has(read.element_sets, "PIN_BRACKET"), mesh.element_sets[0].members) << format.extension;
    }
    if (format.volume->face_sets) {
      EXPECT_EQ(has(read.face_sets, "PIN_FIXED").size(), mesh.face_sets[0].members.size()) << format.extension;
    }
    if (format.volume->node_sets) {
      EXPECT_EQ(has(read.node_sets, "PIN_PINS"), mesh.node_sets[0].members) << format.extension;
    }
    const bool is_numbered = format.volume->largest_number > 0;
    EXPECT_EQ(::testing::Value(notes, ::testing::Contains(::testing::HasSubstr("holds no numbers"))), !is_numbered)
        << format.extension;
    if (!is_numbered || format.extension == ".med" || format.extension.starts_with(".e")) continue;  // not of text
    const std::string text = text_of(file);
    EXPECT_NE(text.find("70001"), std::string::npos) << format.extension;
    EXPECT_NE(text.find("80001"), std::string::npos) << format.extension;
  }
}

TEST(Formats, NumbersOfAnotherFileAreKeptOrToldToBeOthers) {
  const TemporaryFolder folder;
  const TetMesh mesh = analytic::part_with_sets(2);
  FileOptions numbered;
  for (std::uint64_t n = 0; n < mesh.nodes.size(); ++n) numbered.numbers.own.nodes.push_back(10 + 3 * n + n * n);
  for (std::uint64_t t = 0; t < mesh.tetrahedra.size(); ++t) numbered.numbers.own.elements.push_back(500 + 2 * t);
  numbered.numbers.largest_of_own = numbered.numbers.own.elements.back();
  write_volume(mesh, folder / "given.inp", numbered);
  const MeshFile given = read_mesh(folder / "given.inp");
  EXPECT_EQ(given.numbers.nodes, numbered.numbers.own.nodes);
  EXPECT_EQ(given.numbers.elements, numbered.numbers.own.elements);
  for (const FileFormat& format : file_formats()) {
    if (format.write_volume == nullptr) continue;
    const auto file = folder / (format.extension == ".header" ? "mesh.header" : "part" + std::string(format.extension));
    FileOptions options;
    const Notes notes = keep_numbers(given, file, options);
    write_volume(std::get<TetMesh>(given.mesh), file, options);
    const MeshFile read = read_mesh(file);
    const auto& found = std::get<TetMesh>(read.mesh);
    EXPECT_EQ(found.tetrahedra, mesh.tetrahedra) << format.extension;
    EXPECT_EQ(notes.empty(), format.volume->own_numbers) << format.extension;
    if (notes.empty()) {
      EXPECT_EQ(read.numbers.nodes, given.numbers.nodes) << format.extension;
      EXPECT_EQ(read.numbers.elements, given.numbers.elements) << format.extension;
      for (std::size_t s = 0; s < mesh.face_sets.size(); ++s)
        EXPECT_EQ(found.face_sets[s].members, mesh.face_sets[s].members) << format.extension;
      const std::size_t pins = find_set(found.node_sets, "PINS");
      ASSERT_LT(pins, found.node_sets.size()) << format.extension;
      EXPECT_EQ(found.node_sets[pins].members, mesh.node_sets[0].members) << format.extension;
    } else {
      EXPECT_THAT(notes[0], ::testing::HasSubstr("elements 500.." + std::to_string(given.numbers.elements.back())));
    }
  }
  // Those that are asked for are the user's.
  FileOptions options{.numbers = {.first_node = 7}};
  EXPECT_TRUE(keep_numbers(given, folder / "part.bdf", options).empty());
  EXPECT_TRUE(options.numbers.own.empty());
}

TEST(Formats, NumbersThatDoNotFitAreWrongUsage) {
  const TemporaryFolder folder;
  const TetMesh mesh = analytic::tetrahedra_of_box({1, 1, 1}, {1, 1, 1}, 1);
  EXPECT_THAT(error_from<WrongUsage>([&] {
                write_volume(mesh, folder / "box.bdf", {.numbers = {.first_node = 99999999}});
              }).what(),
              ::testing::HasSubstr("limit: 99999999"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// As *INCLUDE of both does it, and a bulk that holds both.
TEST(Formats, TwoMeshesGoIntoOneDeck) {
  const TemporaryFolder folder;
  const TetMesh mesh = analytic::part_with_sets(1);
  TetMesh other = mesh;
  for (Vec3& p : other.nodes) p.x() += 10;
  const FileOptions behind{.set_prefix = "B_", .numbers = {.first_node = mesh.nodes.size() + 1, .first_element = 1001}};
  for (const char* extension : {".inp", ".bdf"}) {
    const auto a = folder / (std::string("a") + extension), b = folder / (std::string("b") + extension);
    write_volume(mesh, a);
    write_volume(other, b, behind);
    std::string first = text_of(a), second = text_of(b);
    if (const std::size_t end = first.find("ENDDATA"); end != std::string::npos) first.resize(end);
    if (const std::size_t begin = second.find("BEGIN BULK\n"); begin != std::string::npos) second.erase(begin, 11);
    std::ofstream(folder / (std::string("both") + extension)) << first << second;
    const TetMesh both = read_volume(folder / (std::string("both") + extension));
    EXPECT_EQ(both.tetrahedra.size(), 2 * mesh.tetrahedra.size()) << extension;
    EXPECT_NEAR(total_volume(both), 2 * total_volume(mesh), 1e-12) << extension;
    for (const NamedSet& set : mesh.element_sets)
      for (const char* prefix : {"", "B_"}) {
        const std::size_t s = find_set(both.element_sets, prefix + set.name);
        ASSERT_LT(s, both.element_sets.size()) << extension << prefix << set.name;
        EXPECT_EQ(both.element_sets[s].members.size(), set.members.size()) << extension << prefix << set.name;
      }
    for (const char* name : {"FIXED", "B_FIXED"})
      EXPECT_LT(find_set(both.face_sets, name), both.face_sets.size()) << extension << name;
  }
}

TEST(Formats, WarnsOfElementsThatCalculixRefuses) {
  const TemporaryFolder folder;
  TetMesh mesh = analytic::tetrahedra_of_box({1, 1, 1}, {1, 1, 1}, 1);
  EXPECT_TRUE(write_volume(mesh, folder / "good.inp").empty());
  std::swap(mesh.tetrahedra[2][0], mesh.tetrahedra[2][1]);
  const auto warnings = write_volume(mesh, folder / "inverted.inp");
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings.front(), ::testing::HasSubstr("CalculiX will refuse element 3: Jacobian determinant -1 "));
}

}  // namespace
}  // namespace scan2fea
