// All sub-commands with all their options: what the command line, its help and the calls of programs go by.
#pragma once

#include "preproc/command/sub_commands.hpp"

#include <vector>

namespace scan2fea::command {

std::vector<SubCommand> declare_commands(CLI::App& root);

}  // namespace scan2fea::command
