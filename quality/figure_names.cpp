#include "quality/figure_names.hpp"

#include "quality/figure_path.hpp"
#include "quality/report_schema.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>

namespace scan2fea {
namespace {

constexpr std::string_view any_name = "NAME", any_number = "N";

// As a shell likes a name, and as figure_path.hpp reads it, too.
std::string without_blanks(std::string name) {
  std::ranges::replace(name, ' ', '_');
  return name;
}

// What people look for first comes first.
constexpr auto shown = std::to_array<std::string_view>({
    "deviation.hausdorff_pct_diagonal",
    "deviation.rms_pct_diagonal",
    "deviation.from_mesh.hausdorff_pct_diagonal",
    "deviation.from_reference.hausdorff_pct_diagonal",
    "deviation.volume_difference_pct",
    "deviation.area_difference_pct",
    "points.largest_distance",
    "points.rms_distance",
    "surface.edge_ratio.mean",
    "surface.edge_ratio.p95",
    "surface.edge_ratio.max",
    "surface.min_angle_deg.mean",
    "surface.min_angle_deg.min",
    "surface.max_angle_deg",
    "surface.radius_ratio.mean",
    "surface.self_intersections",
    "surface.closed",
    "surface.manifold",
    "surface.components",
    "surface.genus",
    "surface.volume",
    "surface.area",
    "volume_mesh.scaled_jacobian.min",
    "volume_mesh.scaled_jacobian.mean",
    "volume_mesh.min_dihedral_deg",
    "volume_mesh.max_dihedral_deg",
    "volume_mesh.min_face_angle_deg",
    "volume_mesh.max_face_angle_deg",
    "volume_mesh.edge_ratio",
    "volume_mesh.radius_edge_ratio",
    "volume_mesh.inverted",
    "volume_mesh.volume",
});

class Listing {
 public:
  void add(const Json& schema_or_reference, const std::string& name) {
    const Json& schema = referred(schema_or_reference);
    if (is_point(schema)) {
      for (const char* axis : {".x", ".y", ".z"}) add_figure(schema_or_reference, name + axis);
    } else if (is_figure(schema)) {
      add_figure(schema, name);
    } else if (schema.contains("properties")) {
      for (const auto& [key, value] : schema["properties"].items()) add(value, name + "." + without_blanks(key));
    } else if (schema.contains("items")) {
      add_list(schema, name);
    }
  }

  std::vector<NamedFigure> take() { return std::move(figures_); }

 private:
  void add_figure(const Json& schema, std::string name) {
    NamedFigure figure;
    figure.section = name.substr(0, name.find('.'));
    figure.name = std::move(name);
    figure.label = description_of(schema, "title");
    figure.meaning = description_of(schema, "description");
    if (figure.meaning.empty()) figure.meaning = description_of(referred(schema), "description");
    figure.unit = description_of(schema, "x-unit");
    figure.is_yes_or_no = schema.contains("type") && schema["type"] == "boolean";
    figures_.push_back(std::move(figure));
  }

  void add_list(const Json& list, const std::string& name) {
    const Json& items = list["items"];
    if (is_figure(items)) return add_figure(list, name + "." + std::string(any_number));
    if (!items.contains("properties") && !items.contains("oneOf")) return;  // of texts
    NamedFigure count;
    count.section = name.substr(0, name.find('.'));
    count.name = name + ".count";
    count.meaning = "How many there are";
    figures_.push_back(std::move(count));
    if (!items.contains("oneOf")) return add(items, name + "." + std::string(name_key(list) ? any_name : any_number));
    for (const Json& kind : items["oneOf"]) {
      add(kind, name + "." + without_blanks(kind["properties"]["name"]["const"].get<std::string>()));
    }
  }

  std::vector<NamedFigure> figures_;
};

// Levenshtein's: insertions, deletions and replacements.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] != b[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

std::string without_section(const std::string& name) {
  return name.substr(name.find('.') + 1);
}

std::vector<std::string> parts_of(std::string_view name) {
  std::vector<std::string> parts(1);
  for (const char c : name)
    if (c == '.')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

// With the entries of lists that were asked for: faces.FACE_3.area for faces.FACE_3.aera.
std::string filled_in(const std::string& candidate, std::string_view name) {
  std::vector<std::string> parts = parts_of(candidate);
  const std::vector<std::string> own = parts_of(name);
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const bool is_open = (parts[i] == any_name || parts[i] == any_number) && parts.size() == own.size();
    text += (i > 0 ? "." : "") + (is_open ? own[i] : parts[i]);
  }
  return text;
}

std::size_t distance(std::string_view name, const std::string& candidate) {
  // What was typed in full and is only incomplete, as edge_ratio for edge_ratio.mean, is nearest of all.
  if (candidate.find(name) != std::string::npos) return 0;
  return std::min(edit_distance(name, filled_in(candidate, name)), edit_distance(name, without_section(candidate)));
}

}  // namespace

std::vector<NamedFigure> all_figures() {
  Listing listing;
  for (const auto& [section, schema] : report_schema_json()["properties"].items())
    if (section != "gates" && section != "compared") listing.add(schema, section);
  std::vector<NamedFigure> figures = listing.take();
  for (const char* mesh : {"first", "second"}) {
    const std::string name = std::string("compared.") + mesh + ".FIGURE";
    figures.push_back({name, {}, std::string("Of compare: a figure of the ") + mesh + " mesh", {}, false, "compared"});
  }
  return figures;
}

std::vector<NamedFigure> shown_figures() {
  const std::vector<NamedFigure> all = all_figures();
  std::vector<NamedFigure> figures;
  for (const std::string_view name : shown) figures.push_back(*std::ranges::find(all, name, &NamedFigure::name));
  return figures;
}

std::string meaning_of_section(std::string_view section) {
  return description_of(report_schema_json()["properties"].value(std::string(section), Json::object()), "description");
}

std::string nearest_figures(std::string_view name) {
  std::vector<std::pair<std::size_t, std::string>> names;
  for (const NamedFigure& figure : all_figures()) names.emplace_back(distance(name, figure.name), figure.name);
  std::ranges::stable_sort(names, {}, &std::pair<std::size_t, std::string>::first);
  const auto text = [&](std::size_t i) { return filled_in(names[i].second, name); };
  return text(0) + ", " + text(1) + " or " + text(2);
}

}  // namespace scan2fea
