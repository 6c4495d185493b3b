// What a deck needs of a scan or a mesh, told before any work is done, with flags that would give it.
#pragma once

#include "export/deck.hpp"
#include "preproc/mesh/named_sets.hpp"

#include <string>
#include <vector>

namespace scan2fea::command {

struct DeckSubject {
  std::string input;                 // the file
  std::vector<std::string> sets;     // that there will be
  std::vector<std::string> offered;  // that --set could name so; none: places are offered
  const std::vector<Vec3>* points;   // of the scan or mesh
  std::string unit;
};

// Throws WrongUsage.
void require_for_deck(DeckKind kind, const DeckSubject& subject);

// "fixed=CLAMP" of `convert`: the sets CLAMP of all kinds, under the name fixed, too. `elements`: null for a surface.
// Throws WrongUsage where there is none, or where the new name is taken.
void add_named_again(const std::vector<std::string>& texts, std::vector<NamedSet>& nodes, std::vector<NamedSet>& faces,
                     std::vector<NamedSet>* elements);

}  // namespace scan2fea::command
