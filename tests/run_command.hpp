// Runs the built command as a user's script would.
#pragma once

#include <string>

namespace scan2fea {

struct CommandResult {
  int exit_code;
  std::string standard_output;
  std::string standard_error;
};

// `arguments` is what a shell would be given after the command's name. What is written to stdout goes to the file, if
// one is given. `environment`: what a shell would be given before it, "COLUMNS=60".
CommandResult run_command(const std::string& arguments, const std::string& standard_output = {},
                          const std::string& environment = {}, const std::string& standard_input = "/dev/null");

}  // namespace scan2fea
