#include "tests/run_command.hpp"

#include "tests/temporary_folder.hpp"

#include <cstdlib>
#include <functional>
#include <sys/wait.h>

namespace scan2fea {
namespace {

// Keeps what the command told in JSON, for the test that holds all of it against the schema (check_report_format.py).
void keep_figures(const std::string& arguments, const std::filesystem::path& standard_output) {
  if (arguments.find("--list-gates") != std::string::npos) return;  // not figures, but their names
  const std::size_t flag = arguments.find("--json ");
  if (flag == std::string::npos) return;
  std::string file = arguments.substr(flag + std::string("--json ").size());
  file = file.starts_with('\'') ? file.substr(1, file.find('\'', 1) - 1) : file.substr(0, file.find(' '));
  const std::filesystem::path figures = file == "-" ? standard_output : std::filesystem::path(file);
  if (!std::filesystem::is_regular_file(figures)) return;
  std::filesystem::create_directories(SCAN2FEA_FIGURES);
  write_text(std::filesystem::path(SCAN2FEA_FIGURES) /
                 (std::to_string(std::hash<std::string>{}(arguments + standard_output.string())) + ".json"),
             contents(figures));
}

}  // namespace

CommandResult run_command(const std::string& arguments, const std::string& standard_output,
                          const std::string& environment, const std::string& standard_input) {
  const TemporaryFolder folder;
  const auto err = folder / "stderr";
  const std::filesystem::path out =
      standard_output.empty() ? folder / "stdout" : std::filesystem::path(standard_output);
  const std::string line = environment + " '" + SCAN2FEA_COMMAND + "' " + arguments + " >'" + out.string() + "' 2>'" +
                           err.string() + "' <'" + standard_input + "'";
  const int status = std::system(line.c_str());
  if (WIFEXITED(status) && WEXITSTATUS(status) <= 1) keep_figures(arguments, out);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
          standard_output.empty() ? contents(out) : "", contents(err)};
}

}  // namespace scan2fea
