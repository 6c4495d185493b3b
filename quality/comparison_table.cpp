#include "quality/comparison_table.hpp"

#include "quality/figure_names.hpp"
#include "quality/figure_path.hpp"

#include <nlohmann/json.hpp>

#include <cstdio>

namespace scan2fea {
namespace {

std::string text_of(const Json* value, const std::string& unit) {
  if (value == nullptr) return "not measured";
  if (value->is_null()) return "none";
  if (value->is_boolean()) return value->get<bool>() ? "yes" : "no";
  if (value->is_number_integer()) return value->dump();
  char text[48];
  std::snprintf(text, sizeof text, "%.6g%s", value->get<double>(), unit.starts_with('%') ? " %" : "");
  return text;
}

}  // namespace

std::string comparison_table(const Json& compared) {
  const Json &first = compared["first"], &second = compared["second"];
  std::string table;
  const auto row = [&](const std::string& name, const std::string& a, const std::string& b) {
    char text[160];
    std::snprintf(text, sizeof text, "  %-44s %20s %20s\n", name.c_str(), a.c_str(), b.c_str());
    table += text;
  };
  const auto figure = [&](const std::string& label, const std::string& name, const std::string& unit = {}) {
    const Json *a = find_figure(first, name), *b = find_figure(second, name);
    if (a != nullptr || b != nullptr) row(label, text_of(a, unit), text_of(b, unit));
  };
  row("", "first", "second");
  figure("Triangles", "surface.faces");
  figure("Tetrahedra", "volume_mesh.tetrahedra");
  figure("Order", "volume_mesh.order");
  for (const NamedFigure& shown : shown_figures()) figure(shown.label, shown.name, shown.unit);
  return table;
}

}  // namespace scan2fea
