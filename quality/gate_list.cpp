#include "quality/gate_list.hpp"

#include "preproc/mesh/error_text.hpp"
#include "quality/figure_names.hpp"
#include "quality/limits.hpp"

#include <nlohmann/json.hpp>

#include <set>

namespace scan2fea {
namespace {

constexpr const char* introduction =
    "Figures that --require can name: \"NAME<=LIMIT\", or with >= < > ==; yes is true or 1, no false or 0.\n"
    "The names of surface, deviation, points and volume_mesh go without it where one of them alone has them.\n"
    "Lengths, areas and volumes are in model units.\n"
    "NAME is that of an entry (a contact's set, a histogram's measure), N its number from 0. A figure of entries has\n"
    "max, min, sum and mean of all: \"bodies.volume_difference_pct.max<=0.1\", \"stages.seconds.sum<60\".\n";

// Titles say what a name says, too, where there is no more to say.
std::string meaning_of(const NamedFigure& figure) {
  if (figure.label.empty()) return figure.meaning;
  return figure.meaning.empty() ? figure.label : figure.label + ". " + figure.meaning;
}

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.resize(width, ' ');
  return text;
}

std::string of(const MeasureLimit& limit) {
  if (limit.of == MeasureLimit::Of::either) return "any mesh";
  return limit.of == MeasureLimit::Of::triangles ? "surfaces" : "volume meshes";
}

std::string sets_table() {
  std::string table = "\nSets of --gates\n";
  std::set<char> used;
  for (const std::string_view set : gate_sets())
    for (const MeasureLimit& limit : measure_limits()) {
      if (limit.set != set) continue;
      used.insert(limit.source);
      table += "  " + padded(std::string(set), 10) +
               padded(std::string(limit.figure) + " " + std::string(sign_of(limit.comparison)) + " " +
                          error_text(limit.value),
                      46) +
               " " + padded(of(limit), 14) + "[" + limit.source + "]\n";
    }
  for (const LimitSource& source : limit_sources())
    if (used.contains(source.letter))
      table += std::string("  [") + source.letter + "] " + std::string(source.text) + "\n";
  return table;
}

}  // namespace

std::string gate_list_table() {
  std::string table = introduction, section;
  for (const NamedFigure& figure : all_figures()) {
    if (figure.section != section) {
      section = figure.section;
      const std::string meaning = figure.name == section ? std::string() : meaning_of_section(section);
      table += "\n" + section + (meaning.empty() ? "" : ": " + meaning) + "\n";
    }
    table += "  " + padded(figure.name, 52) + " " + padded(figure.is_yes_or_no ? "yes or no" : figure.unit, 18) + " " +
             meaning_of(figure);
    table.erase(table.find_last_not_of(' ') + 1);
    table += "\n";
  }
  return table + sets_table();
}

Json gate_list_json() {
  Json list{{"format", report_schema}, {"figures", Json::array()}, {"sets", Json::array()}};
  for (const NamedFigure& figure : all_figures()) {
    Json entry{{"name", figure.name}, {"meaning", meaning_of(figure)}};
    if (!figure.unit.empty()) entry["unit"] = figure.unit;
    entry["yes_or_no"] = figure.is_yes_or_no;
    list["figures"].push_back(std::move(entry));
  }
  for (const std::string_view set : gate_sets()) {
    Json entry{{"name", set}, {"gates", Json::array()}};
    for (const MeasureLimit& limit : measure_limits())
      if (limit.set == set)
        entry["gates"].push_back({{"name", limit.figure},
                                  {"operator", sign_of(limit.comparison)},
                                  {"limit", limit.value},
                                  {"of", of(limit)},
                                  {"source", text_of_source(limit.source)}});
    list["sets"].push_back(std::move(entry));
  }
  return list;
}

}  // namespace scan2fea
