#include "preproc/command/deck_needs.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh/length_unit.hpp"

#include <algorithm>

namespace scan2fea::command {
namespace {

bool holds(const std::vector<std::string>& names, std::string_view name) {
  std::vector<NamedSet> sets;
  for (const std::string& n : names) sets.push_back({n, {}});
  return find_set(sets, name) < sets.size();
}

std::string joined(const std::vector<std::string>& names) {
  constexpr std::size_t most = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) text += (i == 0 ? "" : ", ") + names[i];
  return names.size() > most ? text + ", ..." : text;
}

// The first or the last twentieth of the longest side: it is never empty, shows how a place is written, and its border
// asks for the least small triangles.
std::string place_of(std::string_view set, const std::vector<Vec3>& points) {
  const BoundingBox box = bounding_box(points);
  Eigen::Index longest = 0;
  const double twentieth = (box.high - box.low).maxCoeff(&longest) / 20;
  const std::string axis(1, "xyz"[longest]);
  return set == "fixed" ? axis + "<" + error_text(box.low[longest] + twentieth)
                        : axis + ">" + error_text(box.high[longest] - twentieth);
}

}  // namespace

void require_for_deck(DeckKind kind, const DeckSubject& subject) {
  if (!length_unit(subject.unit))
    throw WrongUsage({.what = "a deck needs the unit of length, by which its material is given",
                      .where = subject.input,
                      .value = {},
                      .limit = {},
                      .advice = "--unit mm, or another of " + std::string(known_length_units)});
  for (const std::string_view name : sets_of_deck(kind)) {
    if (holds(subject.sets, name)) continue;
    const std::string flag = "--set '" + std::string(name) + "=";
    throw WrongUsage({.what = "a deck needs a set that is not there",
                      .where = subject.input,
                      .value = std::string(name),
                      .limit = {},
                      .advice = subject.offered.empty()
                                    ? flag + place_of(name, *subject.points) + "', or a face that scan2fea faces lists"
                                    : flag + subject.offered.front() + "', or another of " + joined(subject.offered)});
  }
}

void add_named_again(const std::vector<std::string>& texts, std::vector<NamedSet>& nodes, std::vector<NamedSet>& faces,
                     std::vector<NamedSet>* elements) {
  std::vector<std::vector<NamedSet>*> kinds{&faces, &nodes};
  if (elements != nullptr) kinds.push_back(elements);
  for (const std::string& text : texts) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const std::string name = text.substr(0, equals), known = text.substr(std::min(equals + 1, text.size()));
    std::vector<std::string> all;
    bool found = false;
    for (std::vector<NamedSet>* sets : kinds) {
      for (const NamedSet& set : *sets) all.push_back(set.name);
      const std::size_t s = find_set(*sets, known);
      if (s == sets->size()) continue;
      found = true;
      NamedSet again = (*sets)[s];
      again.name = name;
      if (find_set(*sets, name) < sets->size())
        throw WrongUsage({"there is a set of this name already", "--set", name, {}, "another name"});
      sets->push_back(std::move(again));
    }
    if (!found || name.empty())
      throw WrongUsage({.what = "convert names sets that there are: NEW=OLD",
                        .where = "--set",
                        .value = text,
                        .limit = all.empty() ? "the file has none" : joined(all),
                        .advice = "scan2fea run for other places"});
  }
}

}  // namespace scan2fea::command
