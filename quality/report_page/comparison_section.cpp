#include "quality/report_page/html.hpp"
#include "quality/report_page/page_sections.hpp"

namespace scan2fea {
namespace {

using namespace html;

std::string difference(const Json& first, const Json& second) {
  if (!first.is_number() || !second.is_number()) return first == second ? "same" : "differs";
  if (first.is_number_integer() && second.is_number_integer())
    return number(Json(second.get<std::int64_t>() - first.get<std::int64_t>()));
  return number(Json(second.get<double>() - first.get<double>()), 3);
}

}  // namespace

std::string comparison_section(const Json& report) {
  if (!report.contains("compared")) return {};
  const Json &first = report["compared"]["first"], &second = report["compared"]["second"];
  const auto name = [](const Json& column) { return column["input"].get<std::string>(); };
  Table table("", {"Measure", "#" + name(first), "#" + name(second), "#Second less first"});
  const auto row = [&](std::string_view label, std::string_view figure) {
    const Json *a = find_figure(first, figure), *b = find_figure(second, figure);
    if (a == nullptr && b == nullptr) return;
    const auto cell = [](const Json* value) {
      return value == nullptr ? std::string("not measured")
                              : "<data value=\"" + escaped(value->dump()) + "\">" + number(*value, 5) + "</data>";
    };
    table.row({escaped(label), cell(a), cell(b), a != nullptr && b != nullptr ? difference(*a, *b) : std::string()},
              "data-figure=\"" + std::string(figure) + "\"");
  };
  row("Triangles of the surface", "surface.faces");
  row("Nodes", "volume_mesh.nodes");
  row("Tetrahedra", "volume_mesh.tetrahedra");
  row("Order", "volume_mesh.order");
  for (const NamedFigure& measure : shown_figures()) row(measure.label, measure.name);
  return "<h2 id=\"comparison\">Both meshes</h2>\n<p>Distances" +
         std::string(find_figure(first, "deviation") != nullptr ? " in this table are from the reference; those" : "") +
         " above and in the view are of the second mesh from the first.</p>\n" + table.text();
}

}  // namespace scan2fea
