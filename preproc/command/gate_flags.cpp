#include "preproc/command/gate_flags.hpp"

#include "preproc/command/option_text.hpp"
#include "preproc/command/option_values.hpp"
#include "preproc/command/output_files.hpp"
#include "preproc/mesh/joined.hpp"
#include "quality/gate_list.hpp"
#include "quality/limits.hpp"

#include <CLI/Error.hpp>

namespace scan2fea::command {
namespace {

constexpr const char* list_help = "List all figures that a gate can name, and the sets of --gates, and end";

std::vector<std::string> names_of_sets() {
  return {gate_sets().begin(), gate_sets().end()};
}

std::string words_of_sets() {
  return joined(names_of_sets(), "|");
}

void list_gates(const CommonFlags& flags) {
  if (!flags.json) {
    write_to_stdout(gate_list_table());
    return;
  }
  if (*flags.json != "-") require_writable({{*flags.json}}, {}, flags.force);
  OutputFiles outputs;
  add_json(gate_list_json(), *flags.json, outputs);
  outputs.commit();
}

}  // namespace

void add_gate_flags(CLI::App& command, CommonFlags& flags) {
  const OptionGroup group(command, "Figures, gates and reports");
  command.add_option("--require", flags.require, "Gate, e.g. \"edge_ratio.mean<=1.2\"; exit 1 where it fails")
      ->type_name("GATE")
      ->allow_extra_args(false);
  command
      .add_option("--gates", flags.gates,
                  "A solver's own limits, or those of the paper, as gates; --require replaces them")
      ->transform(one_of(names_of_sets()))
      ->type_name(words_of_sets())
      ->allow_extra_args(false);
  command.add_option("--junit", flags.junit, "Write the gates as JUnit XML, a test case each (- for stdout)")
      ->type_name("FILE");
  command
      .add_flag_callback(
          "--list-gates",
          [&flags] {
            list_gates(flags);
            throw CLI::Success();
          },
          std::string(list_help) + "; with --json as JSON")
      ->configurable(false);
}

void add_gate_list_flag(CLI::App& root) {
  root.add_flag_callback(
      "--list-gates",
      [&root] {
        if (root.remaining_size() > 0) throw CLI::ExtrasError("scan2fea --list-gates", root.remaining());
        write_to_stdout(gate_list_table());
        throw CLI::Success();
      },
      list_help);
}

}  // namespace scan2fea::command
