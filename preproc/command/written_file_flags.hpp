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

void add_deck_flag(CLI::App& command, std::optional<DeckKind>& deck);
void add_number_flags(CLI::App& command, NumberFlags& flags);
void add_msh_version_flag(CLI::App& command, MshVersion& version);

}  // namespace scan2fea::command
