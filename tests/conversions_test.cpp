// Between every pair of formats: what both hold is kept, and what the second one does not hold is named on stderr. The
// test prints the table of what is kept.
#include "export/formats.hpp"
#include "tests/part_with_sets.hpp"
#include "tests/run_command.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>

#include <cstdio>
#include <fstream>
#include <set>

namespace scan2fea {
namespace {

constexpr const char* interface = "INTERFACE_BRACKET_PIN";

// The faces of the first body at this x, between the bodies.
void add_interface(double x, TetMesh& mesh) {
  NamedSet& set = mesh.face_sets.emplace_back(NamedSet{interface, {}});
  for (const std::uint32_t t : mesh.element_sets[0].members)
    for (std::uint8_t k = 0; k < 4; ++k) {
      const Triangle corners = boundary_triangle(mesh, {t, k});
      if (!std::all_of(corners.begin(), corners.end(), [&](std::uint32_t n) { return mesh.nodes[n].x() == x; }))
        continue;
      set.members.push_back(static_cast<std::uint32_t>(mesh.boundary.size()));
      mesh.boundary.push_back({t, k});
      ++mesh.faces_between;
    }
}

// One set of faces overlaps the others, one lies between the bodies; coordinates have digits to lose.
TetMesh part(int order) {
  TetMesh mesh = analytic::part_with_sets(order);
  add_interface(2, mesh);
  for (Vec3& p : mesh.nodes) p = p * 1.1 + Vec3(0.3, -7, 100);
  std::vector<std::uint32_t> ends = mesh.face_sets[0].members;
  ends.insert(ends.end(), mesh.face_sets[1].members.begin(), mesh.face_sets[1].members.end());
  mesh.face_sets.push_back(named_set("ENDS", ends));
  return mesh;
}

std::vector<NamedSet> sorted(std::vector<NamedSet> sets) {
  std::sort(sets.begin(), sets.end(), [](const NamedSet& a, const NamedSet& b) { return a.name < b.name; });
  return sets;
}

// Where the faces of a set are, whatever the mesh is.
std::vector<std::pair<std::string, std::set<std::array<double, 3>>>> places(const std::vector<NamedSet>& sets,
                                                                            const auto& corners_of,
                                                                            const std::vector<Vec3>& nodes) {
  std::vector<std::pair<std::string, std::set<std::array<double, 3>>>> result;
  for (const NamedSet& set : sorted(sets)) {
    auto& [name, where] = result.emplace_back();
    name = set.name;
    for (const std::uint32_t f : set.members) {
      Vec3 sum = Vec3::Zero();
      for (const std::uint32_t n : corners_of(f)) sum += nodes[n];
      where.insert({std::round(sum.x() * 1e6), std::round(sum.y() * 1e6), std::round(sum.z() * 1e6)});
    }
  }
  return result;
}

auto face_places(const TetMesh& mesh, const std::vector<NamedSet>& sets) {
  return places(
      sets, [&](std::uint32_t f) { return boundary_triangle(mesh, mesh.boundary[f]); }, mesh.nodes);
}

auto face_places(const NamedSurface& surface) {
  return places(
      surface.face_sets, [&](std::uint32_t f) { return surface.mesh.triangles[f]; }, surface.mesh.vertices);
}

std::vector<NamedSet> only(std::vector<NamedSet> sets, bool between) {
  std::erase_if(sets, [&](const NamedSet& set) { return (set.name == interface) != between; });
  return sets;
}

auto node_places(const std::vector<NamedSet>& sets, const std::vector<Vec3>& nodes) {
  return places(
      sets, [](std::uint32_t n) { return std::array{n}; }, nodes);
}

// One letter for each thing that is as in the part, `-` for one that is not there; anything else fails the test.
std::string kept(const TetMesh& truth, const MeshFile& read, const std::string& what) {
  std::string letters;
  const auto add = [&](char letter, bool is_there, bool is_same, const char* name) {
    letters += is_there ? letter : '-';
    EXPECT_TRUE(!is_there || is_same) << what << ": " << name;
  };
  if (const auto* mesh = std::get_if<TetMesh>(&read.mesh)) {
    EXPECT_EQ(mesh->tetrahedra, truth.tetrahedra) << what;
    EXPECT_NEAR(total_volume(*mesh), total_volume(truth), 1e-9 * total_volume(truth)) << what;
    add('n', !mesh->node_sets.empty(),
        node_places(mesh->node_sets, mesh->nodes) == node_places(truth.node_sets, truth.nodes), "sets of nodes");
    const auto same_faces = [&](bool between) {
      return face_places(*mesh, only(mesh->face_sets, between)) == face_places(truth, only(truth.face_sets, between));
    };
    add('f', !only(mesh->face_sets, false).empty(), same_faces(false), "sets of faces");
    add('e', !mesh->element_sets.empty(), sorted(mesh->element_sets) == sorted(truth.element_sets), "sets of elements");
    add('u', !mesh->unit.empty(), mesh->unit == truth.unit, "unit");
    add('2', mesh->order() == 2, mesh->mid_edge_nodes == truth.mid_edge_nodes, "order");
    add('i', mesh->faces_between > 0, same_faces(true) && mesh->faces_between == truth.faces_between, "interface");
    EXPECT_EQ(mesh->outer_faces(), truth.outer_faces()) << what;
  } else {
    const auto& surface = std::get<NamedSurface>(read.mesh);
    EXPECT_EQ(surface.mesh.triangles.size(), truth.outer_faces()) << what;
    add('n', !surface.node_sets.empty(),
        node_places(surface.node_sets, surface.mesh.vertices) == node_places(truth.node_sets, truth.nodes),
        "sets of nodes");
    add('f', !surface.face_sets.empty(), face_places(surface) == face_places(truth, only(truth.face_sets, false)),
        "sets of faces");
    letters += '-';
    add('u', !surface.unit.empty(), surface.unit == truth.unit, "unit");
    letters += "--";
  }
  return letters;
}

std::string holdings(const FileFormat& format, bool as_volume) {
  const Holdings& holds = as_volume ? *format.volume : *format.surface;
  std::string letters;
  letters += holds.node_sets ? 'n' : '-';
  letters += holds.face_sets ? 'f' : '-';
  letters += as_volume && holds.element_sets ? 'e' : '-';
  letters += holds.unit ? 'u' : '-';
  letters += as_volume && holds.second_order ? '2' : '-';
  letters += as_volume && holds.faces_between ? 'i' : '-';
  return letters;
}

std::string both(std::string a, const std::string& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (b[i] == '-') a[i] = '-';
  return a;
}

std::string file_name(const FileFormat& format) {
  return format.extension == ".header" ? "mesh.header" : "part" + std::string(format.extension);
}

// In which elements keep their order.
std::string one_part(const FileFormat& format) {
  return format.parts == Parts::always ? " --parts 1" : "";
}

// The words of stderr that tell each loss.
const char* told(char letter) {
  switch (letter) {
    case 'n':
      return "PINS";
    case 'f':
      return "LOADED";
    case 'e':
      return "BRACKET, PIN";
    case 'u':
      return "left out mm";
    case 'i':
      return interface;
    default:
      return "second order";
  }
}

class Conversions : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Order, Conversions, testing::Values(1, 2));

TEST_P(Conversions, KeepWhatBothFormatsHoldAndTellTheRest) {
  const TetMesh truth = part(GetParam());
  std::string table = "| from \\ to |";
  for (const FileFormat& to : file_formats())
    if (to.write_volume != nullptr || to.write_surface != nullptr) table += " " + std::string(to.extension) + " |";
  table += "\n";
  for (const FileFormat& from : file_formats()) {
    if (from.write_volume == nullptr || from.read == nullptr) continue;
    const TemporaryFolder folder;
    const auto start = folder / file_name(from);
    write_volume(truth, start);
    const std::string first = kept(truth, read_mesh(start), std::string(from.extension));
    const std::string expected_first =
        both(holdings(from, true), GetParam() == 2 ? std::string("nfeu2i") : std::string("nfeu-i"));
    EXPECT_EQ(first, expected_first) << from.extension;
    table += "| " + std::string(from.extension) + " |";
    for (const FileFormat& to : file_formats()) {
      if (to.write_volume == nullptr && to.write_surface == nullptr) continue;
      const bool as_volume = to.write_volume != nullptr;
      const std::string what = std::string(from.extension) + " to " + std::string(to.extension);
      std::filesystem::create_directory(folder / "to");
      const auto target = folder / "to" / file_name(to);
      const CommandResult result =
          run_command("convert '" + start.string() + "' -o '" + target.string() + "' --force --quiet" + one_part(to));
      ASSERT_EQ(result.exit_code, 0) << what << ": " << result.standard_error;
      const std::string letters =
          to.read == nullptr ? both(first, holdings(to, as_volume)) : kept(truth, read_mesh(target), what);
      EXPECT_EQ(letters, both(first, holdings(to, as_volume))) << what;
      for (std::size_t i = 0; i < letters.size(); ++i)
        if (first[i] != '-' && letters[i] == '-' && (as_volume || first[i] != '2')) {
          EXPECT_THAT(result.standard_error, testing::HasSubstr(told(first[i]))) << what;
        }
      if (letters == first) {
        EXPECT_EQ(result.standard_error, "") << what;
      }
      table += " " + letters + " |";
    }
    table += "\n";
  }
  std::printf("n: sets of nodes, f: of faces, e: of elements, u: unit, 2: second order, i: faces between bodies\n%s",
              table.c_str());
}

}  // namespace
}  // namespace scan2fea
