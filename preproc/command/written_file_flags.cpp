#include "preproc/command/written_file_flags.hpp"

#include "export/partition.hpp"
#include "preproc/command/choice_flag.hpp"
#include "preproc/command/option_values.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <limits>

namespace scan2fea::command {

void add_parts_flag(CLI::App& command, std::size_t& parts) {
  const OptionGroup group(command, "What files hold");
  command
      .add_option(
          "--parts", parts,
          "In N parts, one for each process of a parallel solver, divided by METIS: of " + known_formats_of_parts())
      ->transform(whole_between(1, std::numeric_limits<std::int32_t>::max(), "4"))
      ->type_name("N");
}

std::string divide(TetMesh& mesh, std::size_t parts, FileOptions& options) {
  if (parts == 0) return {};
  options.part_sizes = order_by_parts(mesh, parts);
  const auto [least, most] = std::ranges::minmax(options.part_sizes);
  const std::size_t shared = shared_nodes(mesh.nodes.size(), parts_of(mesh, options.part_sizes));
  return std::to_string(parts) + " parts of " + std::to_string(least) + " to " + std::to_string(most) +
         " tetrahedra; " + std::to_string(shared) + " of " + std::to_string(mesh.nodes.size()) +
         " nodes are in several";
}

void add_deck_flag(CLI::App& command, std::optional<DeckKind>& deck) {
  const OptionGroup group(command, "What files hold");
  add_choice<DeckKind>(
      command, "--deck", deck, {{"static", DeckKind::static_analysis}, {"modal", DeckKind::modal}},
      "Also write a deck that runs, beside an .inp for CalculiX, beside a .med or .mail for Code_Aster; "
      "for sets named fixed and loaded");
}

void add_number_flags(CLI::App& command, NumberFlags& flags) {
  const OptionGroup group(command, "What files hold");
  const auto is_start_of_name = [](const std::string& text) {
    const bool fits = !text.empty() && text.size() <= 20 && std::isalpha(static_cast<unsigned char>(text.front())) &&
                      std::ranges::all_of(text, [](unsigned char c) { return std::isalnum(c) || c == '_'; });
    return fits ? std::string()
                : "'" + text + "' is no start of a name: a letter, then letters, digits and _, up to 20";
  };
  command.add_option("--set-prefix", flags.set_prefix, "Put before the names of all sets, as PIN_")
      ->check(CLI::Validator(is_start_of_name, ""))
      ->type_name("NAME");
  const CLI::Validator numbers = whole_between(1, std::uint64_t{1} << 40, "1");
  command
      .add_option("--first-node", flags.numbers.first_node, "Number of the first node, where the format has numbers")
      ->transform(numbers)
      ->type_name("N");
  command
      .add_option("--first-element", flags.numbers.first_element, "The same of elements; properties and sets follow")
      ->transform(numbers)
      ->type_name("N");
}

void add_msh_version_flag(CLI::App& command, MshVersion& version) {
  const OptionGroup group(command, "What files hold");
  add_choice<MshVersion>(command, "--msh-version", version, {{"2.2", MshVersion::v2_2}, {"4.1", MshVersion::v4_1}},
                         "Of Gmsh's format, if that is what is written");
}

}  // namespace scan2fea::command
