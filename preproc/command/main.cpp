// scan2fea: from a scanned surface to a finite-element mesh.
#include "preproc/command/configuration.hpp"
#include "preproc/command/console.hpp"
#include "preproc/command/declared_commands.hpp"
#include "preproc/command/early_end.hpp"
#include "preproc/command/piped_files.hpp"
#include "preproc/command/print_configuration.hpp"
#include "preproc/command/restart.hpp"
#include "preproc/command/wrong_usage.hpp"
#include "preproc/mesh/error.hpp"

#include <CLI/CLI.hpp>
#include <tbb/global_control.h>

#include <exception>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scan2fea::command {
namespace {

constexpr int wrong_usage = 2;
constexpr int no_mesh = 4;

// Known before all else, since what is wrong with the other arguments is told in it, too.
bool asks_for_json_lines(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--progress=json") return true;
    if (argument == "--progress" && i + 1 < argc && std::string_view(argv[i + 1]) == "json") return true;
  }
  return false;
}

int execute(CLI::App& root, const SubCommand& command, const RequiredLater& required) {
  const CLI::Option* config = command.app->get_option_no_throw("--config");
  if (config != nullptr && config->count() > 0) apply_configuration(root, *command.app, config->as<std::string>());
  if (asks_for_configuration(*command.app)) {
    print_configuration(*command.app);
    return 0;
  }
  required.require_all(*command.app);
  required.put_back();  // for the manual
  const CLI::Option* threads = command.app->get_option_no_throw("--threads");
  const int count = threads != nullptr && threads->count() > 0 ? threads->as<int>() : 0;
  std::optional<tbb::global_control> limit;
  if (count > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
  return command.execute();
}

int run_command(int argc, char** argv) {
  CLI::App root("From a scanned surface to a mesh that a finite-element solver accepts.", "scan2fea");
  const std::vector<SubCommand> commands = declare_commands(root);
  const RequiredLater required(root);
  if (argc > 1 && argv[1][0] != '-') {
    const std::string unknown = unknown_command(root, argv[1]);
    if (!unknown.empty()) {
      say(LineKind::error, unknown);
      return wrong_usage;
    }
  }
  try {
    root.parse(argc, argv);
  } catch (const CLI::Success& e) {
    required.put_back();
    return root.exit(e);
  } catch (const CLI::ParseError& e) {
    say(LineKind::error, told(root, e));
    return wrong_usage;
  }
  for (const SubCommand& command : commands)
    if (command.app->parsed()) return execute(root, command, required);
  return wrong_usage;
}

int told(const std::string& error, int exit_code) {
  say(LineKind::error, with_names_of_pipes(error));
  return exit_code;
}

}  // namespace
}  // namespace scan2fea::command

int main(int argc, char** argv) {
  using namespace scan2fea::command;
  restart_with_huge_pages(argv);
  if (asks_for_json_lines(argc, argv)) say_in_json();
  end_on_interrupts();
  try {
    return run_command(argc, argv);
  } catch (const scan2fea::Error& e) {
    return told(e.what(), e.exit_code());
  } catch (const std::bad_alloc&) {
    return told(
        "out of memory; try: larger triangles (--edge-length, --faces) or tetrahedra (--interior-size, --max-volume)",
        no_mesh);
  } catch (const std::exception& e) {  // of a library: no thread can be started, say
    return told("no mesh could be made: " + std::string(e.what()) + "; try: more memory, or --threads 1", no_mesh);
  }
}
