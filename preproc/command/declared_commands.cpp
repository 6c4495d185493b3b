#include "preproc/command/declared_commands.hpp"

#include "preproc/command/gate_flags.hpp"
#include "preproc/command/help.hpp"
#include "preproc/command/program_version.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace scan2fea::command {

std::vector<SubCommand> declare_commands(CLI::App& root) {
  root.formatter(std::make_shared<HelpFormatter>());
  root.set_help_flag("-h,--help", "This text; scan2fea COMMAND --help for the options of a command");
  root.set_version_flag(
      "--version", [] { return version_text(); }, "Versions of the program, its libraries and its figures' format");
  add_gate_list_flag(root);
  for (CLI::Option* option : root.get_options(nullptr)) option->group("Flags");
  root.require_subcommand(1);
  root.footer(
      "Exit codes: 0 done, 1 a gate failed, 2 wrong usage, 3 input unreadable, 4 no valid mesh can be made,\n"
      "5 the tetrahedral mesher failed, 6 output cannot be written, 130 interrupted.\n\n"
      "Examples:\n"
      "  scan2fea check scan.ply\n"
      "  scan2fea run scan.ply -o part.inp --unit mm\n"
      "  scan2fea run scan.ply -o part.inp --faces 12000 --order 2 --report part-report\n"
      "The manual: man scan2fea, or scan2fea manual | man -l -");
  std::vector<SubCommand> commands{add_run(root),         add_surface(root),  add_repair(root),
                                   add_enrich(root),      add_simplify(root), add_tetrahedralize(root),
                                   add_reconstruct(root), add_faces(root),    add_check(root),
                                   add_compare(root),     add_convert(root),  add_picture(root),
                                   add_completion(root),  add_manual(root)};
  for (const SubCommand& command : commands) {
    command.app->set_help_flag("-h,--help", "This text");
    command.app->get_help_ptr()->group("Running");
  }
  return commands;
}

}  // namespace scan2fea::command
