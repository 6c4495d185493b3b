#include "quality/report_page/html.hpp"
#include "quality/report_page/measure_definitions.hpp"
#include "quality/report_page/page_sections.hpp"

#include <set>

namespace scan2fea {
namespace {

using namespace html;
using Unit = MeasureDefinition::Unit;

// Beside a share of the diagonal, what it is in model units.
std::string in_model_units(const Json& report, const MeasureDefinition& measure, const Json& value) {
  const Json* diagonal = find_figure(report, "reference.diagonal");
  if (measure.unit != Unit::percent_of_diagonal || diagonal == nullptr || !value.is_number()) return {};
  return number(value.get<double>() / 100 * diagonal->get<double>(), 4) + " " + unit_text(report);
}

std::string unit_of(const Json& report, Unit unit) {
  switch (unit) {
    case Unit::none:
      return {};
    case Unit::degrees:
      return "\u00b0";
    case Unit::percent:
      return "\u00a0%";
    case Unit::percent_of_diagonal:
      return "\u00a0% of the diagonal";
    case Unit::model:
      return "\u00a0" + unit_text(report);
    case Unit::model_squared:
      return "\u00a0" + unit_text(report, 2);
    case Unit::model_cubed:
      return "\u00a0" + unit_text(report, 3);
  }
  return {};
}

std::string sources(const std::set<char>& used) {
  std::string list;
  for (const LimitSource& source : limit_sources())
    if (used.contains(source.letter[0]))
      list += "<li><b>[" + std::string(source.letter) + "]</b> " + std::string(source.text) + "</li>\n";
  return list.empty() ? list : "<ul class=\"sources\">\n" + list + "</ul>\n";
}

std::string shape_cells(const Json& element, const char* key) {
  return element.contains(key) ? number(element[key]) : std::string();
}

}  // namespace

std::string measures_section(const Json& report) {
  Table table("", {"Measure", "#Value", "#In model units", "Meaning", "Limits"});
  std::set<char> used;
  for (const MeasureDefinition& measure : measure_definitions()) {
    const Json* value = find_figure(report, measure.figure);
    if (value == nullptr) continue;
    table.row({escaped(measure.label), figure(report, measure.figure, 5) + unit_of(report, measure.unit),
               in_model_units(report, measure, *value), escaped(measure.definition), escaped(measure.limits)});
    for (std::size_t i = 0; i < measure.limits.size(); ++i)
      if (measure.limits[i] >= 'A' && measure.limits[i] <= 'Z' &&
          (measure.limits[i - 1] == '[' || measure.limits[i - 1] == ' '))
        used.insert(measure.limits[i]);
  }
  return "<h2 id=\"measures\">Measures</h2>\n<div class=\"measures\">" + table.text() + "</div>" + sources(used);
}

std::string worst_section(const Json& report) {
  const Json* list = find_figure(report, "worst_elements.elements");
  if (list == nullptr || list->empty()) return {};
  const bool is_volume = list->front().contains("scaled_jacobian");
  Table table("", is_volume ? std::vector<std::string>{"#Element", "#Scaled Jacobian", "#Dihedral angles",
                                                       "#Edge ratio", "Place", "Likely cause", ""}
                            : std::vector<std::string>{"#Triangle", "#Smallest angle", "#Largest angle", "#Edge ratio",
                                                       "Place", "Likely cause", ""});
  for (std::size_t i = 0; i < list->size(); ++i) {
    const Json& element = (*list)[i];
    std::string cause = escaped(element["cause"].get<std::string>());
    for (const Json& set : element["sets"]) cause += " <code>" + escaped(set.get<std::string>()) + "</code>";
    const std::string element_number = "<data value=\"" + element["element"].dump() + "\">" +
                                       std::to_string(element["element"].get<std::uint64_t>()) + "</data>";
    const std::string index = std::to_string(i);
    table.row(
        {element_number, shape_cells(element, is_volume ? "scaled_jacobian" : "min_angle_deg"),
         is_volume ? number(element["min_dihedral_deg"]) + "\u00b0 to " + number(element["max_dihedral_deg"]) + "\u00b0"
                   : number(element["max_angle_deg"]) + "\u00b0",
         shape_cells(element, "edge_ratio"), place(element["place"], 5), cause, show_button("worst", "Show", index)},
        "data-worst=\"" + index + "\"");
  }
  return "<h2 id=\"worst\">Worst elements</h2>\n<p>The " + std::to_string(list->size()) + " of " +
         (is_volume ? "least scaled Jacobian" : "least smallest angle") +
         ". Numbers are those of the file, or from 0 where its format has none. Causes are guesses from what lies "
         "around an element.</p>\n" +
         table.text();
}

}  // namespace scan2fea
