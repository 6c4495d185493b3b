// The names of all figures of a report, with what they mean, from report.schema.json.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace scan2fea {

struct NamedFigure {
  std::string name;   // see figure_path.hpp; NAME and N stand for an entry's name or number
  std::string label;  // for people; empty for some
  std::string meaning;
  std::string unit;  // empty, degrees, %, % of the diagonal, length, area, volume (model units), seconds, bytes
  bool is_yes_or_no = false;
  std::string section;  // the part of the report that it is in
};

// In the order of the format.
std::vector<NamedFigure> all_figures();

// Those that meshes are looked at and compared by, in the order of the tables of a report.
std::vector<NamedFigure> shown_figures();

// What a report's sections hold, in words; empty where the format does not say.
std::string meaning_of_section(std::string_view section);

// "surface.edge_ratio.mean, ... or ...": the three whose names are nearest to one that no figure has.
std::string nearest_figures(std::string_view name);

}  // namespace scan2fea
