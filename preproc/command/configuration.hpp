// `--config FILE`: options from a TOML file, under the same names as the flags.
#pragma once

#include <CLI/App.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace scan2fea::command {

// Gives `command` the file's values for options that were not given as flags. A key at the top holds for every
// sub-command that knows it; a table of a sub-command's name ([run]) holds for that one alone and goes before the top.
// A flag of the same group (the sizes, of which one may be given) keeps the file's value out.
// Throws InvalidInput for a file that cannot be read or parsed (with its line), WrongUsage for a key or value that no
// sub-command knows.
void apply_configuration(CLI::App& root, CLI::App& command, const std::filesystem::path& file);

// The same of a program: each value is a list of what the option takes at a time, true or false of a flag.
struct Keyword {
  std::string name;  // of the option, with _ for -
  std::vector<std::vector<std::string>> values;
};
bool is_keyword(const CLI::Option& option);  // not of a terminal, which a program has none of
void apply_keywords(CLI::App& command, const std::vector<Keyword>& keywords);

}  // namespace scan2fea::command
