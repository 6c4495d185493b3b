#include "quality/report_page/report_page.hpp"

#include "quality/picture/deflate.hpp"
#include "quality/report_page/html.hpp"
#include "quality/report_page/page_parts.hpp"
#include "quality/report_page/page_sections.hpp"
#include "quality/report_page/still_pictures.hpp"
#include "quality/report_page/view_data.hpp"

#include <map>

namespace scan2fea {
namespace {

// In a <script> no text may look like the end of one.
std::string for_script(std::string json) {
  for (std::size_t at = json.find('<'); at != std::string::npos; at = json.find('<', at))
    json.replace(at, 1, "\\u003c");
  return json;
}

std::string filled_in(std::string_view frame, const std::map<std::string_view, std::string>& parts) {
  std::string page;
  while (true) {
    const std::size_t open = frame.find("{{");
    page += frame.substr(0, open);
    if (open == std::string_view::npos) return page;
    const std::size_t close = frame.find("}}", open);
    page += parts.at(frame.substr(open + 2, close - open - 2));
    frame.remove_prefix(close + 2);
  }
}

std::optional<CloseUp> close_up(const Json& report) {
  const auto at = [&](const Json& place, const std::string& title) -> std::optional<CloseUp> {
    if (!place[0].is_number()) return {};
    return CloseUp{Vec3(place[0], place[1], place[2]), title + ", at " + html::place(place, report)};
  };
  if (const Json* farthest = find_figure(report, "deviation.farthest_point"))
    return at(*farthest, std::string("Where ") + (farthest_is_on_reference(report)
                                                      ? "a point of the reference is farthest from the mesh"
                                                      : "the mesh is farthest from the reference"));
  const Json* worst = find_figure(report, "worst_elements.elements");
  if (worst == nullptr || worst->empty()) return {};
  const bool is_volume = worst->front().contains("scaled_jacobian");
  return at(worst->front()["place"], (is_volume ? "The surface before the worst element, " : "The worst element, ") +
                                         worst->front()["element"].dump());
}

std::string legend_text(const MeasuredElements& measure, const Json& report) {
  std::string colours;
  constexpr int stops = 16;
  for (int i = 0; i <= stops; ++i) {
    const int last = measure.scale.bars * measure.scale.steps_per_bar() - 1;
    const Rgb c = colour_of_step(measure, static_cast<std::uint16_t>(last * i / stops));
    char colour[32];
    std::snprintf(colour, sizeof colour, "%srgb(%d,%d,%d)", i > 0 ? "," : "", c[0], c[1], c[2]);
    colours += colour;
  }
  std::string what = measure.measure == "deviation" ? "Deviation, " + unit_text(report) +
                                                          ", mean of each triangle; positive: outside of the reference"
                     : measure.measure == "scaled_jacobian" ? "Scaled Jacobian"
                                                            : "Edge ratio";
  if (measure.beyond > 0)
    what += "; of the " + measure.of + " " + html::counted(measure.beyond, "lies", "lie") +
            " beyond, in the colours of the ends";
  return "<figcaption class=\"scale\"><span>" + html::number(measure.scale.low) +
         "</span><span class=\"ramp\" style=\"background:linear-gradient(to right," + colours + ")\"></span><span>" +
         html::number(measure.scale.high) + "</span> <span>" + what + "</span></figcaption>\n";
}

std::string stills(const ReportPageInput& input) {
  if (input.histograms.empty()) return {};
  std::string text;
  for (const StillPicture& picture :
       still_pictures(input.measures, input.volume_mesh, input.histograms, close_up(input.report)))
    text += "<figure><img alt=\"" + html::escaped(picture.title) +
            "\" width=\"640\" height=\"480\" src=\"data:image/png;base64," + base64(picture.png) + "\"><figcaption>" +
            html::escaped(picture.title) + "</figcaption></figure>\n";
  return text.empty() ? text : legend_text(pictured_measure(input.histograms), input.report) + text;
}

}  // namespace

std::string report_page(const ReportPageInput& input) {
  const ViewData view = view_data({.measures = input.measures,
                                   .histograms = input.histograms,
                                   .volume_mesh = input.volume_mesh,
                                   .reference = input.reference,
                                   .face_sets = input.face_sets,
                                   .worst = input.worst,
                                   .first_element = input.first_element,
                                   .element_numbers = input.element_numbers});
  const Json& report = input.report;
  return filled_in(page_template(),
                   {{"TITLE", html::escaped(input.title)},
                    {"STYLE", std::string(page_style())},
                    {"VERDICT", verdict_section(report)},
                    {"COMPARISON", comparison_section(report)},
                    {"STILLS", stills(input)},
                    {"WORST", worst_section(report)},
                    {"ORIGIN", origin_section(report)},
                    {"STAGES", stages_section(report)},
                    {"CHANGES", changes_section(report)},
                    {"MEASURES", measures_section(report)},
                    {"SETS", sets_section(report)},
                    {"REPORT", for_script(report.dump(-1, ' ', false, Json::error_handler_t::replace))},
                    {"VIEW", for_script(view.description.dump())},
                    {"ARRAYS", view.arrays},
                    {"SCRIPT", std::string(page_script())}});
}

}  // namespace scan2fea
