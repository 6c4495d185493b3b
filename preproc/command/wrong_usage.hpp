// What a person is told who has mistyped something: one line, with what may have been meant.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Error.hpp>

#include <string>

namespace scan2fea::command {

// Of a first argument that is no command; empty where it is one.
std::string unknown_command(const CLI::App& root, const std::string& argument);

// Of what CLI11 found wrong.
std::string told(const CLI::App& root, const CLI::ParseError& error);

// Takes the note "required" off the options of the sub-commands, since a configuration may hold what flags do not, and
// puts it back for the help. What is missing after both is told by `require_all`, which throws WrongUsage.
class RequiredLater {
 public:
  explicit RequiredLater(CLI::App& root);
  void put_back() const;
  void require_all(const CLI::App& command) const;

 private:
  std::vector<CLI::Option*> options_;
};

}  // namespace scan2fea::command
