#include "preproc/mesh/joined.hpp"
#include "quality/report_page/html.hpp"
#include "quality/report_page/page_sections.hpp"

#include <set>

namespace scan2fea {
namespace {

using namespace html;

struct Status {
  const char* tone;  // good, bad or plain: words tell it, too
  std::string text;
};

std::string second_name(const Json& report) {
  return "<code>" + escaped(report["compared"]["second"]["input"].get<std::string>()) + "</code>";
}

// What no mesher or solver takes.
std::vector<std::string> faults(const Json& report) {
  std::vector<std::string> list;
  const auto is = [&](const char* name, bool value) {
    const Json* found = find_figure(report, name);
    return found != nullptr && found->is_boolean() && found->get<bool>() == value;
  };
  const auto add_count = [&](const char* name, const char* one, const char* many) {
    const Json* found = find_figure(report, name);
    if (found == nullptr || !found->is_number() || !(found->get<double>() > 0)) return;
    list.push_back(figure(report, name) + (*found == 1 ? one : many));
  };
  if (is("surface.closed", false)) list.emplace_back("not closed");
  if (is("surface.manifold", false)) list.emplace_back("not manifold");
  add_count("surface.self_intersections", " pair of triangles crosses", " pairs of triangles cross");
  const Json* volume = find_figure(report, "surface.volume");
  if (volume != nullptr && volume->is_number() && volume->get<double>() < 0)
    list.emplace_back("inside out: its normals point inwards");
  add_count("volume_mesh.inverted", " element is inside out", " elements are inside out");
  return list;
}

Status status_of(const Json& report) {
  const Json& gates = report["gates"];
  std::size_t failed = 0;
  for (const Json& gate : gates) failed += gate["pass"].get<bool>() ? 0 : 1;
  const std::vector<std::string> wrong = faults(report);
  const bool is_volume = report.contains("volume_mesh");
  const std::string mesh = report.contains("compared") ? "The second mesh, " + second_name(report) + ","
                                                       : std::string(is_volume ? "The mesh" : "The surface");
  const std::string soundness =
      wrong.empty() ? mesh + " is closed, manifold and free of crossings" + (is_volume ? " and inverted elements" : "")
                    : mesh + " has faults: " + joined(wrong);
  if (failed > 0)
    return {"bad", std::to_string(failed) + " of " + std::to_string(gates.size()) + " gates failed. " + soundness};
  if (!gates.empty())
    return {wrong.empty() ? "good" : "bad", (gates.size() == 1 ? "The gate passed. "
                                                               : std::to_string(gates.size()) + " of " +
                                                                     std::to_string(gates.size()) + " gates passed. ") +
                                                soundness};
  return {wrong.empty() ? "plain" : "bad", soundness + ". No gates were asked for"};
}

std::string fact(const std::string& term, const std::string& value, const std::string& rest) {
  return "<div><dt>" + term + "</dt><dd class=\"lead\">" + value + "</dd><dd>" + rest + "</dd></div>\n";
}

std::string cloud_fact(const Json& report) {
  const Json &points = report["points"], &at = points["farthest_point"];
  std::string share;
  if (const Json* diagonal = find_figure(report, "reference.diagonal"); diagonal != nullptr && *diagonal > 0)
    share = " (" + number(100 * points["largest_distance"].get<double>() / diagonal->get<double>(), 3) +
            "\u00a0% of the diagonal)";
  return fact("Farthest of the cloud's points",
              figure(report, "points.largest_distance") + "\u00a0" + unit_text(report) + share,
              "from the mesh, at " + place(at, report) + " " + show_button("place", "Show", at.dump()) + "<br>RMS " +
                  figure(report, "points.rms_distance") + " " + unit_text(report) + " of " +
                  figure(report, "points.count") + " points");
}

std::string distance_fact(const Json& report) {
  if (!report.contains("deviation")) {
    if (report.contains("points")) return cloud_fact(report);
    return fact("Distance from a reference", "not measured", "no reference was given");
  }
  const Json& at = report["deviation"]["farthest_point"];
  const bool is_on_reference = farthest_is_on_reference(report);
  const bool is_of_two = report.contains("compared");
  const std::string own = is_of_two ? "second mesh" : "mesh", first = is_of_two ? "first mesh" : "reference";
  constexpr double rounding = 1e-10;  // % of the diagonal
  const Json& share = report["deviation"]["hausdorff_pct_diagonal"];
  if (share.is_number() && share.get<double>() < rounding)
    return fact("Farthest from the " + first, "0", "but for rounding: every point of either lies on the other");
  return fact(
      "Farthest from the " + first, "at least " + distance_text(report, "deviation.hausdorff_pct_diagonal"),
      "a point of the " + (is_on_reference ? first : own) +
          (report["deviation"].value("farthest_is_on_filling", false) ? ", where a hole of the scan was closed, at "
                                                                      : ", at ") +
          place(at, report) + " " +
          show_button(is_on_reference ? "farthest-of-reference" : "farthest-of-mesh", "Show", at.dump()) + "<br>RMS " +
          distance_text(report, "deviation.rms_pct_diagonal") + "<br>volume " +
          percent_figure(report, "deviation.volume_difference_pct") + ", area " +
          percent_figure(report, "deviation.area_difference_pct"));
}

std::string worst_fact(const Json& report) {
  const Json* list = find_figure(report, "worst_elements.elements");
  if (list == nullptr || list->empty()) return {};
  const Json& worst = list->front();
  const bool is_volume = worst.contains("scaled_jacobian");
  return fact("Worst element" + (report.contains("compared") ? " of " + second_name(report) : std::string()),
              "<span id=\"worst-number\">" + std::to_string(worst["element"].get<std::uint64_t>()) + "</span> " +
                  show_button("worst", "Show", "0"),
              (is_volume ? "scaled Jacobian " + number(worst["scaled_jacobian"])
                         : "smallest angle " + number(worst["min_angle_deg"]) + "\u00b0") +
                  " at " + place(worst["place"], report) + "<br>" + cause_of(worst));
}

std::string made_up_fact(const Json& report) {
  if (!report.contains("made_up")) return {};
  double area = 0;
  for (const Json& change : report["made_up"]) area += change.value("area", 0.0);
  if (report["made_up"].empty())
    return fact("Made up by repair", "nothing", "Every part of the surface follows what the scanner saw");
  std::string share;
  if (const Json* whole = find_figure(report, "surface.area"); whole != nullptr && whole->get<double>() > 0)
    share = " (" + number(100 * area / whole->get<double>(), 3) + "\u00a0% of the surface)";
  return fact("Made up by repair", number(area, 3) + " " + unit_text(report, 2) + share,
              "in " + std::to_string(report["made_up"].size()) +
                  (report["made_up"].size() == 1 ? " place" : " places") + ", listed below");
}

std::string size_fact(const Json& report) {
  const bool is_volume = report.contains("volume_mesh");
  std::string rest = is_volume ? figure(report, "surface.faces") + " triangles on the surface"
                               : figure(report, "surface.vertices") + " vertices";
  if (const Json* size = find_figure(report, "size.box"))
    rest += "<br>" + number((*size)[0]) + " \u00d7 " + number((*size)[1]) + " \u00d7 " + number((*size)[2]) + " " +
            unit_text(report);
  if (is_volume)
    return fact(
        "Mesh", figure(report, "volume_mesh.tetrahedra") + " tetrahedra",
        figure(report, "volume_mesh.nodes") + " nodes, order " + figure(report, "volume_mesh.order") + "<br>" + rest);
  return fact("Surface", figure(report, "surface.faces") + " triangles", rest);
}

std::string where_of(const Json& gate, const Json& report) {
  if (!gate.contains("place")) return gate.value("reason", "");
  return (gate.contains("element") ? "element " + gate["element"].dump() + " at " : std::string()) +
         place(gate["place"], report) + " " + show_button("place", "Show", gate["place"].dump());
}

std::string gate_table(const Json& report) {
  Table table("Gates", {"Result", "Figure", "#Value", "", "#Limit", "Where", "From"});
  std::set<std::string> sources;
  for (const Json& gate : report["gates"]) {
    const bool pass = gate["pass"].get<bool>();
    const std::string set = gate.value("set", "");
    if (gate.contains("source"))
      sources.insert("<li><b>" + escaped(set) + "</b> " + escaped(gate["source"].get<std::string>()) + "</li>\n");
    table.row({pass ? "<strong class=\"good\">passed</strong>" : "<strong class=\"bad\">failed</strong>",
               "<code>" + escaped(gate["name"].get<std::string>()) + "</code>",
               "<data value=\"" + gate["value"].dump() + "\">" + number(gate["value"], 6) + "</data>",
               escaped(gate["operator"].get<std::string>()), number(gate["limit"], 6), where_of(gate, report),
               set.empty() ? "asked for" : "<code>" + escaped(set) + "</code>"});
  }
  std::string list;
  for (const std::string& source : sources) list += source;
  return table.text() + (list.empty() ? list : "<ul class=\"sources\">\n" + list + "</ul>\n");
}

}  // namespace

std::string unit_text(const Json& report, int power) {
  if (!report.contains("unit"))
    return power == 1 ? "model units" : power == 2 ? "model units\u00b2" : "model units\u00b3";
  const std::string unit = escaped(report["unit"].get<std::string>());
  return unit + (power == 1 ? "" : power == 2 ? "\u00b2" : "\u00b3");
}

std::string cause_of(const Json& element) {
  std::string sets;
  for (const Json& set : element["sets"])
    sets += (sets.empty() ? "; in " : ", ") + ("<code>" + escaped(set.get<std::string>()) + "</code>");
  return escaped(element["cause"].get<std::string>()) + sets;
}

bool farthest_is_on_reference(const Json& report) {
  const Json& deviation = report["deviation"];
  const auto of = [&](const char* side) { return deviation[side]["hausdorff_pct_diagonal"]; };
  return of("from_reference") == deviation["hausdorff_pct_diagonal"] && of("from_mesh") != of("from_reference");
}

std::string distance_text(const Json& report, const std::string& name) {
  const Json *share = find_figure(report, name), *diagonal = find_figure(report, "reference.diagonal");
  if (share == nullptr || !share->is_number()) return "none";
  const std::string of_diagonal = figure(report, name, 3) + "\u00a0% of the diagonal";
  if (diagonal == nullptr) return of_diagonal;
  return number(share->get<double>() / 100 * diagonal->get<double>(), 3) + "\u00a0" + unit_text(report) + " (" +
         of_diagonal + ")";
}

std::string verdict_section(const Json& report) {
  if (!report.contains("surface")) return {};
  const Status status = status_of(report);
  return std::string("<h2 id=\"verdict\">Verdict</h2>\n<p class=\"status ") + status.tone + "\">" + status.text +
         ".</p>\n<dl class=\"facts\">\n" + distance_fact(report) + worst_fact(report) + made_up_fact(report) +
         size_fact(report) + "</dl>\n" + gate_table(report);
}

}  // namespace scan2fea
