#include "quality/report_page/html.hpp"
#include "quality/report_page/page_sections.hpp"

#include <algorithm>

namespace scan2fea {
namespace {

using namespace html;

constexpr std::size_t most_rows = 40;

// A name of the JSON as words: "feature_edges_before" -> "feature edges before".
std::string words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return escaped(name);
}

std::string left_out(std::size_t all) {
  return all <= most_rows ? std::string() : "<p>" + std::to_string(all - most_rows) + " more are in report.json.</p>\n";
}

std::string change_table(const Json& report, const char* key, const char* caption) {
  if (!report.contains(key) || report[key].empty()) return {};
  std::vector<const Json*> changes;
  for (const Json& change : report[key]) changes.push_back(&change);
  std::stable_sort(changes.begin(), changes.end(),
                   [](const Json* a, const Json* b) { return a->value("area", 0.0) > b->value("area", 0.0); });
  Table table(caption, {"What", "#Size, " + unit_text(report), "#Area, " + unit_text(report, 2), "Place", ""});
  for (std::size_t i = 0; i < std::min(changes.size(), most_rows); ++i) {
    const Json& change = *changes[i];
    table.row({words(change["what"].get<std::string>()), number(change["size"]),
               change.contains("area") ? number(change["area"]) : std::string(), place(change["place"], report),
               show_button("place", "Show", change["place"].dump())});
  }
  return table.text() + left_out(changes.size());
}

std::string amount_of(const Json& set, const Json& report) {
  if (set.contains("volume")) return number(set["volume"], 5) + " " + unit_text(report, 3);
  if (set.contains("area")) return number(set["area"], 5) + " " + unit_text(report, 2);
  return {};
}

std::string members_of(const Json& set) {
  for (const auto& [kind, one] : {std::pair("triangles", "triangle"), {"tetrahedra", "tetrahedron"}, {"nodes", "node"}})
    if (set.contains(kind)) return counted(set[kind], one, kind);
  return {};
}

std::string set_table(const Json& report) {
  Table table("Sets of the mesh", {"Name", "Of", "#Area or volume", "#On the scan", "#Difference", "#Members", ""});
  if (!report.contains("sets")) return {};
  for (const Json& set : report["sets"]) {
    const std::string name = set["name"].get<std::string>();
    const bool of_scan = set.contains("area_of_scan");
    table.row({"<code>" + escaped(name) + "</code>", escaped(set["kind"].get<std::string>()), amount_of(set, report),
               of_scan ? number(set["area_of_scan"], 5) + " " + unit_text(report, 2) : std::string(),
               of_scan ? percent(set["area_difference_pct"]) : std::string(), members_of(set),
               set["kind"] == "faces" ? show_button("set", "Show", name) : std::string()});
  }
  return table.text();
}

std::string face_table(const Json& report) {
  if (!report.contains("faces") || report["faces"].empty()) return {};
  Table table("Faces of the scan", {"Name", "Kind", "#Area, " + unit_text(report, 2), "Place", ""});
  for (std::size_t i = 0; i < std::min(report["faces"].size(), most_rows); ++i) {
    const Json& face = report["faces"][i];
    table.row({"<code>" + escaped(face["name"].get<std::string>()) + "</code>",
               escaped(face["kind"].get<std::string>()) +
                   (face.contains("radius") ? ", radius " + number(face["radius"]) : std::string()),
               number(face["area"], 5), place(face["place"], report),
               show_button("place", "Show", face["place"].dump())});
  }
  return table.text() + left_out(report["faces"].size());
}

std::string body_table(const Json& report) {
  if (!report.contains("bodies")) return {};
  Table table("Bodies", {"Name", "#Volume, " + unit_text(report, 3), "#Difference from the scan", "#Tetrahedra"});
  for (const Json& body : report["bodies"])
    table.row({"<code>" + escaped(body["name"].get<std::string>()) + "</code>", number(body["volume"], 6),
               percent(body["volume_difference_pct"]), number(body["tetrahedra"])});
  return table.text();
}

std::string contact_table(const Json& report) {
  if (!report.contains("contacts")) return {};
  const std::string unit = unit_text(report);
  Table table("Contacts", {"Bodies", "Set", "#Largest gap, " + unit, "#Largest overlap, " + unit, "Place", ""});
  for (const Json& contact : report["contacts"])
    table.row(
        {escaped(contact["bodies"][0].get<std::string>()) + ", " + escaped(contact["bodies"][1].get<std::string>()),
         "<code>" + escaped(contact["set"].get<std::string>()) + "</code>", number(contact["largest_gap"]),
         number(contact["largest_overlap"]), place(contact["place"], report),
         show_button("place", "Show", contact["place"].dump())});
  return table.text();
}

std::string figure_of_stage(const Json& stage, const std::string& key) {
  std::string name = stage["name"].get<std::string>();
  std::ranges::replace(name, ' ', '_');
  return "stages." + name + "." + key;
}

std::string stage_changes(const Json& stage, const Json& report, const std::vector<NamedFigure>& figures) {
  std::string text;
  for (const auto& [key, value] : stage.items()) {
    if (!value.is_number() || key == "seconds" || key == "peak_bytes") continue;
    const auto figure = std::ranges::find(figures, figure_of_stage(stage, key), &NamedFigure::name);
    const bool is_known = figure != figures.end();
    const std::string label = is_known && !figure->label.empty() ? escaped(figure->label) : words(key);
    const std::string unit = is_known ? unit_behind(report, figure->unit) : std::string();
    // A count, or what is measured.
    text += (text.empty() ? "" : "; ") + label + "\u00a0" + number(value, unit.empty() ? 6 : 4) + unit;
  }
  if (stage.contains("remarks"))
    for (std::size_t i = 0; i < std::min(stage["remarks"].size(), most_rows); ++i)
      text += "<br>" + escaped(stage["remarks"][i].get<std::string>());
  return text;
}

}  // namespace

std::string changes_section(const Json& report) {
  if (!report.contains("made_up")) return {};
  const std::string tables = change_table(report, "made_up", "Made up: closed, joined or added") +
                             change_table(report, "lost", "Lost: left out of what was scanned");
  return "<h2 id=\"made-up\">What was measured, and what was made up</h2>\n" +
         (tables.empty() ? "<p>Repair made nothing up and left nothing out: the surface is that of the scan.</p>\n"
                         : tables);
}

std::string sets_section(const Json& report) {
  const std::string tables = set_table(report) + face_table(report) + body_table(report) + contact_table(report);
  return tables.empty() ? tables : "<h2 id=\"sets\">Named faces and sets</h2>\n" + tables;
}

std::string stages_section(const Json& report) {
  if (!report.contains("stages")) return {};
  Table table("", {"Stage", "#Time, s", "#Memory, MB", "What it changed, and where"});
  const std::vector<NamedFigure> figures = all_figures();
  for (const Json& stage : report["stages"])
    table.row({words(stage["name"].get<std::string>()), number(stage["seconds"], 3),
               number(stage["peak_bytes"].get<double>() / 1e6, 4), stage_changes(stage, report, figures)});
  return "<h2 id=\"stages\">Stages</h2>\n" + table.text();
}

}  // namespace scan2fea
