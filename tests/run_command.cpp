#include "tests/run_command.hpp"

#include "tests/temporary_folder.hpp"

#include <cstdlib>
#include <sys/wait.h>

namespace scan2fea {

CommandResult run_command(const std::string& arguments, const std::string& standard_output) {
  const TemporaryFolder folder;
  const auto err = folder / "stderr";
  const std::filesystem::path out =
      standard_output.empty() ? folder / "stdout" : std::filesystem::path(standard_output);
  const std::string line = std::string("'") + SCAN2FEA_COMMAND + "' " + arguments + " >'" + out.string() + "' 2>'" +
                           err.string() + "' </dev/null";
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
          standard_output.empty() ? contents(out) : "", contents(err)};
}

}  // namespace scan2fea
