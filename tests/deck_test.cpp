// What decks say: units, sets by the names that the files have, a section for each body; and that those of Code_Aster
// are Python.
#include "export/deck.hpp"

#include "export/formats.hpp"
#include "preproc/mesh/error.hpp"
#include "tests/error_from.hpp"
#include "tests/part_with_sets.hpp"
#include "tests/run_command.hpp"
#include "tests/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>
#include <sstream>

namespace scan2fea {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr auto static_analysis = DeckKind::static_analysis;

std::string after(const std::string& text, const std::string& mark) {
  const std::size_t at = text.find(mark);
  return at == std::string::npos ? "" : text.substr(at + mark.size());
}

template <class Call>
std::string refused(const Call& call) {
  return error_from<WrongUsage>(call).what();
}

double number_after(const std::string& text, const std::string& mark) {
  return std::strtod(after(text, mark).c_str(), nullptr);
}

TEST(Deck, StandsBesideTheMesh) {
  EXPECT_EQ(deck_file("a/part.inp", static_analysis), "a/part_static.inp");
  EXPECT_EQ(deck_file("a/part.MED", DeckKind::modal), "a/part_modal.comm");
  EXPECT_EQ(deck_file("part.v2.mail", static_analysis), "part.v2_static.comm");
  EXPECT_THAT(refused([] { deck_file("part.vtu", static_analysis); }), HasSubstr("CalculiX"));
  EXPECT_THAT(refused([] { deck_file("my part.inp", static_analysis); }), HasSubstr("blank"));
  EXPECT_EQ(deck_file("my part.med", static_analysis), "my part_static.comm");
}

// Whatever the unit, it is the same steel: the speed of sound in metres per second, a pressure of a 210,000th of
// Young's modulus, and g as this many lengths per square second.
TEST(Deck, ValuesAreConsistentInEveryUnit) {
  const double speed = std::sqrt(210e9 / 7850);
  for (const auto& [unit, in_metres] :
       {std::pair("um", 1e-6), {"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}, {"in", 0.0254}, {"ft", 0.3048}}) {
    TetMesh mesh = analytic::part_with_sets(1);
    mesh.unit = unit;
    const std::string deck = deck_text(mesh, "part.inp", static_analysis);
    const double young = number_after(deck, "*ELASTIC\n"), density = number_after(deck, "*DENSITY\n");
    EXPECT_NEAR(std::sqrt(young / density) * in_metres / speed, 1, 1e-5) << unit;
    EXPECT_NEAR(number_after(deck, "LOADED, P, ") / young * 210000, 1, 1e-5) << unit;
    EXPECT_NEAR(number_after(deck, "GRAV, ") * in_metres, 9.80665, 1e-4) << unit;
    EXPECT_THAT(deck, HasSubstr("** unit of length: " + std::string(unit) + "\n"));
  }
  TetMesh mesh = analytic::part_with_sets(1);
  EXPECT_THAT(deck_text(mesh, "part.inp", static_analysis), HasSubstr("210000.0, 0.3\n*DENSITY\n7.85e-09\n"));
  mesh.unit = "in";
  EXPECT_NEAR(number_after(deck_text(mesh, "part.inp", static_analysis), "*ELASTIC\n"), 30.4579e6, 100) << "psi";
  mesh.unit.clear();
  EXPECT_THAT(refused([&] { deck_text(mesh, "part.inp", static_analysis); }), HasSubstr("--unit mm"));
}

TEST(Deck, NamesSetsAsTheFileDoes) {
  TetMesh mesh = analytic::part_with_sets(1);
  mesh.face_sets[0].name = "fixed";
  mesh.face_sets[1].name = "Loaded";
  const std::string inp = deck_text(mesh, "part.inp", static_analysis);
  EXPECT_THAT(inp, HasSubstr("FIXED_NODES, 1, 3"));
  EXPECT_THAT(inp, HasSubstr("*DSLOAD\nLOADED, P"));
  const std::string comm = deck_text(mesh, "part.med", static_analysis);
  EXPECT_THAT(comm, HasSubstr("GROUP_MA=\"fixed\", DX"));
  EXPECT_THAT(comm, HasSubstr("GROUP_MA=\"Loaded\", PRES"));
  mesh.node_sets[0].name = "fixed";
  mesh.face_sets.erase(mesh.face_sets.begin());
  EXPECT_THAT(deck_text(mesh, "part.inp", static_analysis), HasSubstr("*BOUNDARY\nFIXED, 1, 3"));
  EXPECT_THAT(deck_text(mesh, "part.mail", static_analysis), HasSubstr("GROUP_NO=\"fixed\", DX"));
}

TEST(Deck, HasASectionForEachBody) {
  TetMesh mesh = analytic::part_with_sets(1);
  EXPECT_THAT(deck_text(mesh, "part.inp", static_analysis),
              HasSubstr("ELSET=BRACKET, MATERIAL=STEEL\n*SOLID SECTION, ELSET=PIN, MATERIAL=STEEL\n"));
  EXPECT_THAT(deck_text(mesh, "part.med", static_analysis), HasSubstr("_F(GROUP_MA=\"PIN\", MATER=steel)"));
  mesh.element_sets.push_back(named_set("ROOM", {0, 1}));  // in the bracket
  EXPECT_THAT(deck_text(mesh, "part.inp", static_analysis), Not(HasSubstr("ELSET=ROOM")));
  mesh.element_sets = {named_set("other", {0, 1})};
  const std::string rest = deck_text(mesh, "part.inp", static_analysis);
  EXPECT_THAT(rest, HasSubstr("*ELSET, ELSET=OTHER_2\n3, 4"));
  EXPECT_THAT(rest, HasSubstr("*SOLID SECTION, ELSET=OTHER, MATERIAL=STEEL\n*SOLID SECTION, ELSET=OTHER_2"));
  mesh.element_sets.clear();
  EXPECT_THAT(deck_text(mesh, "part.inp", static_analysis), HasSubstr("*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL"));
}

// So that two parts go into one deck: names and numbers are those that the mesh's file has.
TEST(Deck, HasThePrefixAndTheNumbersOfTheMesh) {
  TetMesh mesh = analytic::part_with_sets(1);
  FileOptions options;
  options.set_prefix = "PIN_";
  options.numbers = {.first_node = 1000, .first_element = 5000};
  const std::string inp = deck_text(mesh, "part.inp", static_analysis, options);
  EXPECT_THAT(inp, HasSubstr("PIN_FIXED_NODES, 1, 3"));
  EXPECT_THAT(inp, HasSubstr("*DSLOAD\nPIN_LOADED, P"));
  EXPECT_THAT(inp, HasSubstr("*SOLID SECTION, ELSET=PIN_BRACKET"));
  EXPECT_THAT(deck_text(mesh, "part.med", static_analysis, options), HasSubstr("GROUP_MA=\"PIN_LOADED\", PRES"));
  mesh.element_sets = {named_set("HALF", {0, 1})};
  EXPECT_THAT(deck_text(mesh, "part.inp", static_analysis, options), HasSubstr("ELSET=PIN_OTHER\n5002, 5003"));
  mesh.element_sets.clear();
  EXPECT_THAT(deck_text(mesh, "part.inp", static_analysis, options), HasSubstr("ELSET=PIN_EALL, MATERIAL"));
}

TEST(Deck, NeedsItsSets) {
  TetMesh mesh = analytic::part_with_sets(1);
  mesh.face_sets.pop_back();
  EXPECT_NO_THROW(deck_text(mesh, "part.inp", DeckKind::modal));
  EXPECT_THAT(refused([&] { deck_text(mesh, "part.inp", static_analysis); }), HasSubstr("loaded"));
  mesh.node_sets[0].name = "LOADED";
  EXPECT_THAT(refused([&] { deck_text(mesh, "part.inp", static_analysis); }), HasSubstr("of nodes"));
  mesh.face_sets[0].members.clear();
  EXPECT_THAT(refused([&] { deck_text(mesh, "part.inp", DeckKind::modal); }), HasSubstr("fixed"));
}

// Commands and their keywords, from the deck as it was written.
std::vector<std::pair<std::string, nlohmann::json>> calls_of(const std::filesystem::path& deck) {
  const std::string printed = deck.string() + ".calls";
  const std::string command =
      "/usr/bin/python3 '" SCAN2FEA_TESTS_FOLDER "/run_aster_deck.py' '" + deck.string() + "' > '" + printed + "' 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << contents(printed);
  std::vector<std::pair<std::string, nlohmann::json>> calls;
  std::istringstream lines(contents(printed));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t blank = line.find(' ');
    calls.emplace_back(line.substr(0, blank), nlohmann::json::parse(line.substr(blank)));
  }
  return calls;
}

void add_values(const nlohmann::json& value, const std::string& key, std::vector<std::string>& found) {
  for (const auto& [k, v] : value.items()) {
    if (value.is_object() && k == key && v.is_string()) found.push_back(v);
    if (v.is_structured()) add_values(v, key, found);
  }
}

// CalculiX gives a free part displacements of 1e10 and no word.
TEST(Deck, OfAPartThatNothingHoldsIsRefused) {
  TetMesh mesh = analytic::part_with_sets(1);
  mesh.unit = "mm";
  deck_text(mesh, "part.inp", static_analysis);
  const auto first = static_cast<std::uint32_t>(mesh.nodes.size());
  mesh.nodes.insert(mesh.nodes.end(), {{90, 0, 0}, {91, 0, 0}, {90, 1, 0}, {90, 0, 1}});
  mesh.tetrahedra.push_back({first, first + 1, first + 2, first + 3});
  EXPECT_THAT(refused([&] { deck_text(mesh, "part.inp", static_analysis); }), HasSubstr("not held"));
  deck_text(mesh, "part.inp", DeckKind::modal);
}

TEST(Deck, OfCodeAsterIsPythonAndItsGroupsAreInTheMesh) {
  const TemporaryFolder folder;
  write_volume(analytic::part_with_sets(2), folder / "part.inp");
  for (const std::string kind : {"static", "modal"})
    for (const std::string extension : {"med", "mail"}) {
      const std::filesystem::path file = folder / (kind + extension + "." + extension);
      const CommandResult result = run_command("convert '" + (folder / "part.inp").string() + "' -o '" + file.string() +
                                               "' --quiet --deck " + kind);
      ASSERT_EQ(result.exit_code, 0) << result.standard_error;
      const TetMesh mesh = read_volume(file);
      std::vector<std::string> commands, of_cells, of_nodes, made;
      for (const auto& [command, keywords] : calls_of(folder / (kind + extension + "_" + kind + ".comm"))) {
        commands.push_back(command);
        add_values(keywords, "GROUP_MA", of_cells);
        add_values(keywords, "GROUP_NO", of_nodes);
        add_values(keywords, "NOM", made);
      }
      EXPECT_EQ(commands.front(), "DEBUT");
      EXPECT_EQ(commands.back(), "FIN");
      EXPECT_THAT(commands, testing::Contains(kind == "modal" ? "CALC_MODES" : "MECA_STATIQUE"));
      EXPECT_GE(of_cells.size(), 4U);  // the clamp, its nodes, two bodies
      for (const std::string& name : of_cells)
        EXPECT_TRUE(std::any_of(mesh.face_sets.begin(), mesh.face_sets.end(),
                                [&](const NamedSet& set) { return set.name == name; }) ||
                    std::any_of(mesh.element_sets.begin(), mesh.element_sets.end(),
                                [&](const NamedSet& set) { return set.name == name; }))
            << name << " in " << file;
      for (const std::string& name : of_nodes) EXPECT_THAT(made, testing::Contains(name));
    }
}

class DeckOfCommand : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  CommandResult convert(const std::string& flags) const {
    return run_command("convert '" + path("part.inp") + "' -o '" + path("out.inp") + "' " + flags);
  }
  TemporaryFolder folder_;
};

TEST_F(DeckOfCommand, TellsWhichSetIsMissingAndWhatWouldWork) {
  TetMesh mesh = analytic::part_with_sets(1);
  mesh.face_sets[0].name = "CLAMP";
  write_volume(mesh, path("part.inp"));
  const CommandResult missing = convert("--deck static");
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.standard_error, HasSubstr("not there: fixed; try: --set 'fixed=CLAMP'"));
  EXPECT_FALSE(std::filesystem::exists(path("out.inp")));
  EXPECT_FALSE(std::filesystem::exists(path("out_static.inp")));
  EXPECT_EQ(convert("--deck static --set 'fixed=CLAMP'").exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(path("out_static.inp")));
  EXPECT_EQ(find_set(read_volume(path("out.inp")).face_sets, "CLAMP"), 0U) << "it keeps its own name, too";
  EXPECT_EQ(convert("--deck static --set fixed=CLAMP").exit_code, 6) << "both exist by now";
  EXPECT_EQ(convert("--force --set fixed=CLAMPS").exit_code, 2);
  EXPECT_EQ(convert("--force --set CLAMP=LOADED").exit_code, 2);
}

TEST_F(DeckOfCommand, OfARunIsAdvisedWithPlacesThatThereAre) {
  write_surface(
      {.mesh = boundary_surface(analytic::part_with_sets(1, {8, 4, 2})), .node_sets = {}, .face_sets = {}, .unit = {}},
      path("box.ply"));
  std::string flags =
      "run '" + path("box.ply") + "' -o '" + path("box.med") + "' --edge-length 0.5 --quiet --deck static";
  const CommandResult no_unit = run_command(flags);
  EXPECT_EQ(no_unit.exit_code, 2);
  EXPECT_THAT(no_unit.standard_error, HasSubstr("--unit mm"));
  flags += " --unit mm";
  for (const std::string name : {"fixed", "loaded"}) {
    const CommandResult missing = run_command(flags);
    EXPECT_EQ(missing.exit_code, 2);
    const std::string advice = after(missing.standard_error, "not there: " + name + "; try: ");
    ASSERT_FALSE(advice.empty()) << missing.standard_error;
    flags += " " + advice.substr(0, advice.find(", or"));
  }
  const CommandResult done = run_command(flags);
  EXPECT_EQ(done.exit_code, 0) << flags << done.standard_error;
  EXPECT_TRUE(std::filesystem::exists(path("box_static.comm")));
}

}  // namespace
}  // namespace scan2fea
