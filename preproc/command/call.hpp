// A sub-command called by a program: its options under the names that they have there, its work on meshes in memory.
#pragma once

#include "preproc/command/caller.hpp"
#include "preproc/command/configuration.hpp"
#include "preproc/command/option_text.hpp"

#include <string>
#include <vector>

namespace scan2fea::command {

// Options are those that the sub-command declares, checked as on a command line, but for those that are about a
// terminal; none is required. Where the inputs are in memory, `input`, `more` and `reference` name them all the same.
// Without an `output` nothing is written but reports, and options of files are refused. Warnings and failed gates come
// to who hears the thread's lines (console.hpp).
// Returns 0, or 1 where a gate failed. Throws what the command tells by its exit codes: all of error.hpp.
// Safe to call from several threads at once.
int call(const std::string& command, const std::vector<Keyword>& keywords, Caller& caller);

// What may be a keyword of it, in the order of its help; the inputs are left out.
struct CallOption {
  std::string name;  // "edge_length"
  std::string value, text, default_value, group;
  std::vector<std::string> choices;
  bool is_repeatable = false;
  int at_a_time = 1;
};
std::vector<CallOption> options_of_call(const std::string& command);

// A surface, a volume mesh or a cloud, as the sub-commands read it: `unit` as --unit, empty where none is told.
SharedMesh read_into_memory(const std::filesystem::path& file, const std::string& unit);

}  // namespace scan2fea::command
