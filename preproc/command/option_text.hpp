// What the help, the manual page, the completions of shells, the configuration and the advice about mistyped names know
// of the options: all of it is what was declared once, on CLI11's tree.
#pragma once

#include <CLI/App.hpp>

#include <string>
#include <vector>

namespace scan2fea::command {

struct OptionText {
  const CLI::Option* option = nullptr;
  std::vector<std::string> names;  // "-o", "--output"; of what has no dashes its name
  bool is_positional = false;
  std::string value;                 // "FILE", "low|normal|high"; empty of a flag
  std::vector<std::string> choices;  // words that it takes: the parts of `value` in lower case
  std::string text;
  std::string default_value;  // empty where there is none, or where the text tells it
  std::string group;
  bool is_repeatable = false;

  bool takes_file() const { return value.find("FILE") != std::string::npos; }
  bool takes_folder() const { return value == "DIR"; }
  std::string signature() const;  // "-o, --output FILE"
};

// Ordered by group, as a reader looks for them, and in each as they were declared; what has no dashes first.
std::vector<OptionText> options_of(const CLI::App& command);

// Those that are shown, in the order in which they were declared.
std::vector<const CLI::App*> sub_commands_of(const CLI::App& root);
std::vector<std::string> names_of(const std::vector<const CLI::App*>& commands);

// Those of `names` that a mistyped one may have meant, the nearest first; empty where none is near.
std::vector<std::string> similar_names(const std::string& mistyped, const std::vector<std::string>& names);

// "; did you mean --faces?", or nothing.
std::string did_you_mean(const std::string& mistyped, const std::vector<std::string>& names);

// The options of a group that were given, by their names: {"--scanner"}.
std::vector<std::string> given_in_group(const CLI::App& command, const std::string& group);

// All options that are declared while it lives, and have no group yet, belong to this one.
class OptionGroup {
 public:
  OptionGroup(CLI::App& command, std::string name);
  ~OptionGroup();
  OptionGroup(const OptionGroup&) = delete;
  OptionGroup& operator=(const OptionGroup&) = delete;

 private:
  CLI::App& command_;
  std::string name_;
  std::size_t before_;
};

}  // namespace scan2fea::command
