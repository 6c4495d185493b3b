#include "quality/figure_names.hpp"
#include "quality/limits.hpp"
#include "quality/report_page/html.hpp"
#include "quality/report_page/page_sections.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace scan2fea {
namespace {

using namespace html;
using Beyond = MeasureLimit::Beyond;

// Beside a share of the diagonal, what it is in model units.
std::string in_model_units(const Json& report, const NamedFigure& measure, const Json& value) {
  const Json* diagonal = find_figure(report, "reference.diagonal");
  if (measure.unit != "% of the diagonal" || diagonal == nullptr || !value.is_number()) return {};
  return number(value.get<double>() / 100 * diagonal->get<double>(), 4) + " " + unit_text(report);
}

// The paper's limits of differences are the same in either direction.
bool is_either_way(const MeasureLimit& limit) {
  return limit.value != 0 && std::ranges::any_of(measure_limits(), [&](const MeasureLimit& other) {
           return other.figure == limit.figure && other.source == limit.source && other.value == -limit.value;
         });
}

// "above 165 warning": where a mesh is not as the limit wants it.
std::string phrase(const MeasureLimit& limit) {
  if (limit.beyond == Beyond::worse_than_paper && is_either_way(limit))
    return "\u00b1" + number(std::abs(limit.value), 6) + " reached by the paper";
  const std::string value = number(limit.value, 6);
  const bool is_from_above = limit.comparison == Comparison::at_most || limit.comparison == Comparison::below;
  if (limit.beyond == Beyond::is_unusual) return (is_from_above ? "up to " : "from ") + value + " acceptable";
  if (limit.beyond == Beyond::worse_than_paper) return value + " reached by the paper";
  const std::string what = limit.beyond == Beyond::warning ? " warning" : " error";
  switch (limit.comparison) {
    case Comparison::at_most:
      return "above " + value + what;
    case Comparison::at_least:
      return "below " + value + what;
    case Comparison::below:
      return value + " or more" + what;
    case Comparison::above:
      return value + " or less" + what;
    case Comparison::equal:
      break;
  }
  return "other than " + value + what;
}

// "above 165 warning [A, O], above 177 error [O]"; notes the sources.
std::string limits_of(std::string_view figure, std::set<char>& used) {
  std::vector<std::pair<std::string, std::string>> phrases;  // with the letters of their sources
  for (const MeasureLimit& limit : measure_limits()) {
    if (limit.figure != figure) continue;
    used.insert(limit.source);
    const auto same = std::ranges::find(phrases, phrase(limit), &std::pair<std::string, std::string>::first);
    if (same == phrases.end())
      phrases.emplace_back(phrase(limit), std::string(1, limit.source));
    else if (same->second.find(limit.source) == std::string::npos)
      same->second += std::string(", ") + limit.source;
  }
  std::string text;
  for (const auto& [words, letters] : phrases) text += (text.empty() ? "" : ", ") + words + " [" + letters + "]";
  return text;
}

std::string sources(const std::set<char>& used) {
  std::string list;
  for (const LimitSource& source : limit_sources())
    if (used.contains(source.letter))
      list += std::string("<li><b>[") + source.letter + "]</b> " + std::string(source.text) + "</li>\n";
  return list.empty() ? list : "<ul class=\"sources\">\n" + list + "</ul>\n";
}

std::string shape_cells(const Json& element, const char* key) {
  return element.contains(key) ? number(element[key]) : std::string();
}

}  // namespace

std::string unit_behind(const Json& report, const std::string& unit) {
  if (unit.empty()) return {};
  if (unit == "degrees") return "\u00b0";
  const int power = unit == "length" ? 1 : unit == "area" ? 2 : unit == "volume" ? 3 : 0;
  return "\u00a0" + (power > 0 ? unit_text(report, power) : escaped(unit));
}

std::string measures_section(const Json& report) {
  Table table("", {"Measure", "#Value", "#In model units", "Meaning", "Limits"});
  std::set<char> used;
  for (const NamedFigure& measure : shown_figures()) {
    const Json* value = find_figure(report, measure.name);
    if (value == nullptr) continue;
    const std::string text = measure.unit == "%" ? percent_figure(report, measure.name, 5)
                             : value->is_null()  ? figure(report, measure.name)
                                                 : figure(report, measure.name, 5) + unit_behind(report, measure.unit);
    table.row({escaped(measure.label), text, in_model_units(report, measure, *value), escaped(measure.meaning),
               escaped(limits_of(measure.name, used))});
  }
  const std::string whose =
      report.contains("compared")
          ? "<p>Of the second mesh, <code>" + escaped(report["compared"]["second"]["input"].get<std::string>()) +
                "</code>; distances and differences are from the first, <code>" +
                escaped(report["compared"]["first"]["input"].get<std::string>()) + "</code>.</p>\n"
          : std::string();
  if (table.text().empty()) return {};
  return "<h2 id=\"measures\">Measures</h2>\n" + whose + "<div class=\"measures\">" + table.text() + "</div>" +
         sources(used);
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
    const std::string element_number = "<data value=\"" + element["element"].dump() + "\">" +
                                       std::to_string(element["element"].get<std::uint64_t>()) + "</data>";
    const std::string index = std::to_string(i);
    table.row(
        {element_number, shape_cells(element, is_volume ? "scaled_jacobian" : "min_angle_deg"),
         is_volume ? number(element["min_dihedral_deg"]) + "\u00b0 to " + number(element["max_dihedral_deg"]) + "\u00b0"
                   : number(element["max_angle_deg"]) + "\u00b0",
         shape_cells(element, "edge_ratio"), place(element["place"], report), cause_of(element),
         show_button("worst", "Show", index)},
        "data-worst=\"" + index + "\"");
  }
  return "<h2 id=\"worst\">Worst elements</h2>\n<p>The " + std::to_string(list->size()) + " of " +
         (is_volume ? "least scaled Jacobian" : "least smallest angle") +
         ". Numbers are those of the file, or from 0 where its format has none. Causes are guesses from what lies "
         "around an element.</p>\n" +
         table.text();
}

}  // namespace scan2fea
