// `--help`: options in groups, with their values and defaults, as wide as the terminal; examples below.
#pragma once

#include <CLI/App.hpp>

#include <string>
#include <vector>

namespace scan2fea::command {

class HelpFormatter : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
};

// Lines of at most `columns` characters, where words allow it; those that the text has already are kept.
std::vector<std::string> wrapped(const std::string& text, std::size_t columns);

}  // namespace scan2fea::command
