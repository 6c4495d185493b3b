#include "tests/run_command.hpp"

#include "tests/temporary_folder.hpp"

#include <cstdlib>
#include <sys/wait.h>

namespace scan2fea {

CommandResult run_command(const std::string& arguments) {
  const TemporaryFolder folder;
  const auto out = folder / "stdout", err = folder / "stderr";
  const std::string line = std::string("'") + SCAN2FEA_COMMAND + "' " + arguments + " >'" + out.string() + "' 2>'" +
                           err.string() + "' </dev/null";
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), contents(out), contents(err)};
}

}  // namespace scan2fea
