// `--print-config`: what the flags and the configuration say together, as TOML that `--config` reads.
#pragma once

#include <CLI/App.hpp>

#include <string>

namespace scan2fea::command {

void add_print_configuration_flag(CLI::App& command);
bool asks_for_configuration(const CLI::App& command);

// In a table of the command's name: all that was given, and as comments what was not, with its default. The command
// with it and no flags makes the same bytes.
std::string configuration_text(const CLI::App& command);
void print_configuration(const CLI::App& command);

}  // namespace scan2fea::command
