// The flags of gates, and what --list-gates prints.
#pragma once

#include "preproc/command/flags.hpp"

namespace scan2fea::command {

// After all other flags that are in common: --list-gates goes where they say, and ends the command.
void add_gate_flags(CLI::App& command, CommonFlags& flags);

// Of the command itself: the table on stdout.
void add_gate_list_flag(CLI::App& root);

}  // namespace scan2fea::command
