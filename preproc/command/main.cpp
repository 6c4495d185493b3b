// scan2fea: from a scanned surface to a finite-element mesh.
#include "preproc/command/configuration.hpp"
#include "preproc/command/early_end.hpp"
#include "preproc/command/gate_flags.hpp"
#include "preproc/command/restart.hpp"
#include "preproc/command/sub_commands.hpp"
#include "preproc/mesh/error.hpp"

#include <CLI/CLI.hpp>
#include <scan2fea/version.hpp>
#include <tbb/global_control.h>

#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <vector>

namespace scan2fea::command {
namespace {

constexpr int wrong_usage = 2;
constexpr int no_mesh = 4;

// CLI11 would only say that a command is missing.
bool is_known(const CLI::App& root, const std::string& command) {
  if (command.starts_with("-")) return true;
  std::string names;
  for (const CLI::App* known : root.get_subcommands({})) {
    if (known->get_name() == command) return true;
    names += (names.empty() ? "" : ", ") + known->get_name();
  }
  std::fprintf(stderr, "scan2fea: there is no command '%s'; there are: %s\n", command.c_str(), names.c_str());
  return false;
}

int run_command(int argc, char** argv) {
  CLI::App root("From a scanned surface to a mesh that a finite-element solver accepts.", "scan2fea");
  root.set_version_flag("--version", library_version);
  add_gate_list_flag(root);
  root.require_subcommand(1);
  root.footer(
      "Exit codes: 0 done, 1 a gate failed, 2 wrong usage, 3 input unreadable, 4 no valid mesh can be made,\n"
      "5 the tetrahedral mesher failed, 6 output cannot be written, 130 interrupted.");
  const std::vector<SubCommand> commands{add_run(root),         add_surface(root),  add_repair(root),
                                         add_enrich(root),      add_simplify(root), add_tetrahedralize(root),
                                         add_reconstruct(root), add_faces(root),    add_check(root),
                                         add_compare(root),     add_convert(root),  add_picture(root)};
  if (argc > 1 && !is_known(root, argv[1])) return wrong_usage;
  try {
    root.parse(argc, argv);
  } catch (const CLI::Success& e) {
    return root.exit(e);
  } catch (const CLI::ParseError& e) {
    std::fprintf(stderr, "scan2fea: %s; try: scan2fea --help\n", e.what());
    return wrong_usage;
  }
  for (const SubCommand& command : commands) {
    if (!command.app->parsed()) continue;
    const CLI::Option* config = command.app->get_option_no_throw("--config");
    if (config != nullptr && config->count() > 0) apply_configuration(root, *command.app, config->as<std::string>());
    const CLI::Option* threads = command.app->get_option_no_throw("--threads");
    const int count = threads != nullptr && threads->count() > 0 ? threads->as<int>() : 0;
    std::optional<tbb::global_control> limit;
    if (count > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
    return command.execute();
  }
  return wrong_usage;
}

}  // namespace
}  // namespace scan2fea::command

int main(int argc, char** argv) {
  scan2fea::command::restart_with_huge_pages(argv);
  scan2fea::command::end_on_interrupts();
  try {
    return scan2fea::command::run_command(argc, argv);
  } catch (const scan2fea::Error& e) {
    std::fprintf(stderr, "scan2fea: %s\n", e.what());
    return e.exit_code();
  } catch (const std::bad_alloc&) {
    std::fprintf(
        stderr,
        "scan2fea: out of memory; try: larger triangles (--edge-length, --faces) or tetrahedra (--interior-size, "
        "--max-volume)\n");
    return scan2fea::command::no_mesh;
  } catch (const std::exception& e) {  // of a library: no thread can be started, say
    std::fprintf(stderr, "scan2fea: no mesh could be made: %s; try: more memory, or --threads 1\n", e.what());
    return scan2fea::command::no_mesh;
  }
}
