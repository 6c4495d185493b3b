#include "quality/report_page/html.hpp"
#include "quality/report_page/page_sections.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

using namespace html;

std::string difference(const Json& first, const Json& second) {
  if (!first.is_number() || !second.is_number()) return first == second ? "same" : "differs";
  if (first.is_number_integer() && second.is_number_integer())
    return number(Json(second.get<std::int64_t>() - first.get<std::int64_t>()));
  const double a = first.get<double>(), b = second.get<double>();
  constexpr double rounding = 1e-9;
  return std::abs(b - a) <= rounding * std::max(std::abs(a), std::abs(b)) ? "0" : number(Json(b - a), 3);
}

// The file that both are measured from, too; empty where there is none.
std::string reference_of(const Json& report) {
  if (find_figure(report, "compared.first.deviation") == nullptr || !report.contains("inputs")) return {};
  for (const Json& input : report["inputs"])
    if (input["role"] == "reference") return escaped(input["file"].get<std::string>());
  return {};
}

}  // namespace

std::string comparison_section(const Json& report) {
  if (!report.contains("compared")) return {};
  const Json &first = report["compared"]["first"], &second = report["compared"]["second"];
  const auto name = [](const Json& column) { return column["input"].get<std::string>(); };
  Table table("", {"Measure", "#" + name(first), "#" + name(second), "#Second less first"});
  const auto row = [&](std::string_view label, std::string_view figure, const std::string& unit = {}) {
    const Json *a = find_figure(first, figure), *b = find_figure(second, figure);
    if (a == nullptr && b == nullptr) return;
    const auto with_unit = [&](const Json& value, const std::string& text) {
      return value.is_number() ? text + unit_behind(report, unit) : text;
    };
    const auto cell = [&](const Json* value) {
      if (value == nullptr) return std::string("not measured");
      return "<data value=\"" + escaped(value->dump()) + "\">" +
             (unit == "%" ? percent(*value, 5) : with_unit(*value, number(*value, 5))) + "</data>";
    };
    const auto difference_with_unit = [&](const Json& of_first, const Json& of_second) {
      if (unit == "%" && of_first.is_number() && of_second.is_number())
        return percent(Json(of_second.get<double>() - of_first.get<double>()));
      return with_unit(of_first, difference(of_first, of_second));
    };
    table.row(
        {escaped(label), cell(a), cell(b), a != nullptr && b != nullptr ? difference_with_unit(*a, *b) : std::string()},
        "data-figure=\"" + std::string(figure) + "\"");
  };
  row("Triangles of the surface", "surface.faces");
  row("Nodes", "volume_mesh.nodes");
  row("Tetrahedra", "volume_mesh.tetrahedra");
  row("Order", "volume_mesh.order");
  for (const NamedFigure& measure : shown_figures()) row(measure.label, measure.name, measure.unit);
  const std::string reference = reference_of(report);
  return "<h2 id=\"comparison\">Both meshes</h2>\n<p>" +
         (reference.empty() ? "Distances"
                            : "Distances and differences in this table are of each mesh from the reference, <code>" +
                                  reference + "</code>; those") +
         " in the verdict, in the view and under Measures are of the second mesh from the first.</p>\n" + table.text();
}

}  // namespace scan2fea
