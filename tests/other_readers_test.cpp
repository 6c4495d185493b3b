// Readers that know nothing of scan2fea (meshio, VTK, Gmsh, DOLFINx) find in our files what we wrote: nodes, elements,
// volume, the order of mid-edge nodes and the sizes of sets. DOLFINx solves a patch test on them, too.
#include "export/formats.hpp"
#include "tests/part_with_sets.hpp"
#include "tests/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <sstream>
#include <string>
#include <sys/wait.h>
#include <vector>

namespace scan2fea {
namespace {

struct Case {
  std::string library;
  std::string file;
  std::map<std::string, double> sets;  // names as the library tells them, and sizes
  MshVersion msh_version = MshVersion::v4_1;
};

// Otherwise the test's name shows the bytes of the struct, pointers among them.
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.library << " " << c.file << (c.msh_version == MshVersion::v2_2 ? " 2.2" : "");
}

// Of the part: twelve tetrahedra to a unit of length, four triangles at each end.
const std::map<std::string, double> bodies{{"BRACKET", 24}, {"PIN", 24}}, ends{{"FIXED", 4}, {"LOADED", 4}},
    pins{{"PINS", 3}};

std::map<std::string, double> both(std::map<std::string, double> a, const std::map<std::string, double>& b) {
  a.insert(b.begin(), b.end());
  return a;
}

const auto all = both(both(bodies, ends), pins), tags = both(bodies, ends);

class OtherReaders : public testing::TestWithParam<std::tuple<Case, int>> {};
INSTANTIATE_TEST_SUITE_P(
    LibraryAndOrder, OtherReaders,
    testing::Combine(
        testing::Values(
            Case{"meshio", "box.inp", both(bodies, pins)}, Case{"meshio", "box.msh", all, MshVersion::v2_2},
            Case{"meshio", "box.msh", all}, Case{"meshio", "box.vtu", all},
            Case{"meshio", "box.med", both(all, {{"EALL", 48}, {"SALL", 56}})},
            Case{"meshio", "box.xdmf", both(tags, pins)},
            Case{"meshio", "box.bdf", {{"property_2", 24}, {"property_3", 24}}}, Case{"vtk", "box.vtu", all},
            Case{"vtk", "box.exo", both(all, {{"SALL", 56}, {"EALL", 48}, {"area_of_FIXED", 2}, {"area_of_SALL", 28}})},
            Case{"meshio", "box.exo", pins}, Case{"gmsh", "box.msh", all, MshVersion::v2_2},
            Case{"gmsh", "box.msh", both(all, {{"SALL", 48}})},
            Case{"gmsh",
                 "box.unv",
                 {{"physical_3_2", 24}, {"physical_3_3", 24}, {"physical_2_5", 4}, {"physical_2_6", 4}}},
            Case{"dolfinx", "box.xdmf", both(tags, {{"area_of_FIXED", 2}})},
            Case{"dolfinx", "box.msh", both(tags, {{"area_of_FIXED", 2}})}),
        testing::Values(1, 2)));

// Debian's own interpreter, which has Debian's packages; another one may come first on the path. The exit status, and
// what is printed.
std::pair<int, std::string> read_by(const std::string& script, const std::string& library,
                                    const std::filesystem::path& file) {
  const std::string command =
      "/usr/bin/python3 '" SCAN2FEA_TESTS_FOLDER "/" + script + "' " + library + " '" + file.string() + "' 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return {127, ""};
  std::string printed;
  for (int byte; (byte = std::fgetc(pipe)) != EOF;) printed += static_cast<char>(byte);
  return {WEXITSTATUS(pclose(pipe)), printed};
}

// What the scripts print, beside the warnings of libraries: a line of figures after its first word, and sizes of sets.
struct Told {
  std::vector<double> figures;
  std::map<std::string, double> sets;
};

Told told_after(const std::string& head, const std::string& printed) {
  Told told;
  std::istringstream lines(printed);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string first, name;
    words >> first;
    if (first == head)
      for (double figure; words >> figure;) told.figures.push_back(figure);
    if (first == "set") words >> name >> told.sets[name];
  }
  return told;
}

TEST_P(OtherReaders, FindTheSameMesh) {
  const auto& [c, order] = GetParam();
  const TetMesh mesh = analytic::part_with_sets(order);
  const TemporaryFolder folder;
  FileOptions options;
  options.provenance = "a test";
  options.msh_version = c.msh_version;
  EXPECT_EQ(write_volume(mesh, folder / c.file, options), Notes{});

  const auto [status, printed] = read_by("read_volume_mesh.py", c.library, folder / c.file);
  if (status == 77 || status == 127) GTEST_SKIP() << c.library << " is not installed (see examples/setup)";
  ASSERT_EQ(status, 0) << printed;

  const auto [figures, sets] = told_after("mesh", printed);
  ASSERT_EQ(figures.size(), 4U) << printed;
  EXPECT_EQ(figures[0], static_cast<double>(mesh.nodes.size())) << printed;
  EXPECT_EQ(figures[1], static_cast<double>(mesh.tetrahedra.size()));
  EXPECT_NEAR(figures[2], 8, 1e-12);
  EXPECT_LE(figures[3], 1e-12);  // how far mid-edge nodes are from the middles
  for (const auto& [name, size] : c.sets) {
    ASSERT_TRUE(sets.contains(name)) << name << " in:\n" << printed;
    EXPECT_NEAR(sets.at(name), size, 1e-12) << name;
  }
}

class OtherReadersOfSurfaces : public testing::TestWithParam<std::pair<std::string, std::string>> {};
INSTANTIATE_TEST_SUITE_P(LibraryAndFile, OtherReadersOfSurfaces,
                         testing::Values(std::pair("vtk", "box.vtp"), std::pair("vtk", "box.vtu"),
                                         std::pair("vtk", "box.exo"), std::pair("meshio", "box.vtu"),
                                         std::pair("meshio", "box.inp")));

TEST_P(OtherReadersOfSurfaces, FindTheSameSurface) {
  const auto& [library, file] = GetParam();
  const TemporaryFolder folder;
  Notes notes;
  TetMesh solid = analytic::part_with_sets(1);
  solid.element_sets.clear();
  const NamedSurface surface = named_boundary(solid, notes);
  EXPECT_EQ(write_surface(surface, folder / file), Notes{});
  const auto [status, printed] = read_by("read_surface_mesh.py", library, folder / file);
  if (status == 77 || status == 127) GTEST_SKIP() << library << " is not installed (see examples/setup)";
  ASSERT_EQ(status, 0) << printed;
  const auto [figures, sets] = told_after("surface", printed);
  ASSERT_EQ(figures.size(), 4U) << printed;
  EXPECT_EQ(figures[0], static_cast<double>(surface.mesh.vertices.size())) << printed;
  EXPECT_EQ(figures[1], static_cast<double>(surface.mesh.triangles.size()));
  EXPECT_NEAR(figures[2], 2 * (4 * 2 + 4 * 1 + 2 * 1), 1e-12);
  EXPECT_NEAR(figures[3], 8, 1e-12);
  for (const auto* named : {&surface.face_sets, &surface.node_sets})
    for (const NamedSet& set : *named) {
      ASSERT_TRUE(sets.contains(set.name)) << set.name << printed;
      EXPECT_EQ(sets.at(set.name), static_cast<double>(set.members.size())) << set.name << printed;
    }
}

}  // namespace
}  // namespace scan2fea
