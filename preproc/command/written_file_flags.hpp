// The flags of what is written for solvers, and how.
#pragma once

#include "export/deck.hpp"
#include "export/formats.hpp"

#include <CLI/App.hpp>

#include <optional>
#include <string>

namespace scan2fea::command {

// What lets several meshes go into one deck.
struct NumberFlags {
  std::string set_prefix;
  Numbering numbers;
};

// In how many parts a volume mesh is written; 0: it is not divided.
void add_parts_flag(CLI::App& command, std::size_t& parts);
// Orders the elements of the mesh by parts, if there are to be some, and sets the options to them. Returns what a
// person wants to know of them, one line; nothing where there are none.
std::string divide(TetMesh& mesh, std::size_t parts, FileOptions& options);

void add_deck_flag(CLI::App& command, std::optional<DeckKind>& deck);
void add_number_flags(CLI::App& command, NumberFlags& flags);
void add_msh_version_flag(CLI::App& command, MshVersion& version);

}  // namespace scan2fea::command
