#include "preproc/command/element_figures.hpp"

#include "preproc/mesh/error_text.hpp"
#include "quality/extreme_elements.hpp"
#include "quality/report.hpp"
#include "quality/report_page/report_page.hpp"
#include "quality/worst_elements.hpp"

#include <nlohmann/json.hpp>

namespace scan2fea::command {
namespace {

constexpr std::size_t worst_listed = 10;

Json tetrahedra_json(const std::vector<WorstTetrahedron>& worst, const Subject& subject) {
  Json list = Json::array();
  for (const WorstTetrahedron& element : worst) {
    const TetShape& shape = element.shape;
    const Json edge_ratio = shape.edge_ratio ? Json(*shape.edge_ratio) : Json(nullptr);
    list.push_back({{"element", element_number(element.index, subject)},
                    {"place", point_json(element.place)},
                    {"scaled_jacobian", shape.scaled_jacobian},
                    {"min_dihedral_deg", shape.min_dihedral_deg},
                    {"max_dihedral_deg", shape.max_dihedral_deg},
                    {"edge_ratio", edge_ratio},
                    {"sets", sets_with(face_sets_of(subject), outer_faces_of(*subject.volume_mesh, element.index))},
                    {"cause", element.cause}});
  }
  return {{"by", "scaled_jacobian"}, {"elements", std::move(list)}};
}

Json triangles_json(const std::vector<WorstTriangle>& worst, const Subject& subject) {
  Json list = Json::array();
  for (const WorstTriangle& element : worst)
    list.push_back({{"element", element_number(element.index, subject)},
                    {"place", point_json(element.place)},
                    {"min_angle_deg", element.shape.min_angle_deg},
                    {"max_angle_deg", element.shape.max_angle_deg},
                    {"edge_ratio", element.shape.edge_ratio},
                    {"sets", sets_with(face_sets_of(subject), std::span(&element.index, 1))},
                    {"cause", element.cause}});
  return {{"by", "min_angle_deg"}, {"elements", std::move(list)}};
}

std::string title_of(const Json& report, const Subject& subject) {
  const auto name = [](const std::filesystem::path& file) { return file.filename().string(); };
  const std::string own = name(subject.output.value_or(report["input"].get<std::string>()));
  if (!report.contains("compared")) return own + ": mesh report";
  return name(report["compared"]["first"]["input"].get<std::string>()) + " and " + own + ": meshes compared";
}

}  // namespace

const std::vector<NamedSet>& face_sets_of(const Subject& subject) {
  static const std::vector<NamedSet> none;
  if (subject.volume_mesh != nullptr) return subject.volume_mesh->face_sets;
  return subject.face_sets != nullptr ? *subject.face_sets : none;
}

std::uint64_t element_number(std::uint32_t element, const Subject& subject) {
  const std::vector<std::uint32_t>& numbers = subject.element_numbers;
  return element < numbers.size() ? numbers[element] : subject.first_element + element;
}

std::string worst_element_row(const Subject& subject, const Json& report) {
  const bool is_volume = subject.volume_mesh != nullptr;
  if (!is_volume && subject.surface == nullptr) return {};
  const auto found = is_volume ? extreme_tetrahedron(*subject.volume_mesh, "volume_mesh.scaled_jacobian.min")
                               : extreme_triangle(*subject.surface, "surface.min_angle_deg.min");
  if (!found) return {};
  const double figure = is_volume ? report["volume_mesh"]["scaled_jacobian"]["min"].get<double>()
                                  : report["surface"]["min_angle_deg"]["min"].get<double>();
  return table_row("worst element", std::to_string(element_number(found->index, subject)) +
                                        (is_volume ? ": scaled Jacobian " : ": smallest angle ") +
                                        error_text(figure, 4) + (is_volume ? "" : " deg") + ", at " +
                                        error_text(found->place));
}

ElementFigures measure_elements(const Subject& subject) {
  ElementFigures elements;
  const std::vector<Vec3>* points = subject.cloud != nullptr ? &subject.cloud->points : nullptr;
  elements.measures = subject.volume_mesh != nullptr
                          ? scan2fea::measure_elements(*subject.volume_mesh, subject.reference, points)
                          : scan2fea::measure_elements(*subject.surface, subject.reference, points);
  elements.histograms = histograms_of(elements.measures);
  return elements;
}

void add_to_json(ElementFigures& elements, const Subject& subject, Json& report) {
  report["histograms"] = Json::array();
  for (const MeasuredElements& m : elements.histograms)
    report["histograms"].push_back(
        {{"measure", m.measure}, {"of", m.of}, {"low", m.scale.low}, {"high", m.scale.high}, {"counts", m.counts}});
  if (subject.volume_mesh != nullptr) {
    const auto worst = worst_tetrahedra(*subject.volume_mesh, elements.measures, worst_listed);
    for (const WorstTetrahedron& element : worst) elements.worst.push_back(element.index);
    report["worst_elements"] = tetrahedra_json(worst, subject);
  } else {
    const auto worst = worst_triangles(elements.measures, worst_listed);
    for (const WorstTriangle& element : worst) elements.worst.push_back(element.index);
    report["worst_elements"] = triangles_json(worst, subject);
  }
}

std::string page_of(const Json& report, const ElementFigures& elements, const Subject& subject) {
  return report_page({.title = title_of(report, subject),
                      .report = report,
                      .measures = elements.measures,
                      .histograms = elements.histograms,
                      .volume_mesh = subject.volume_mesh,
                      .reference = subject.reference,
                      .face_sets = face_sets_of(subject),
                      .worst = elements.worst,
                      .first_element = subject.first_element,
                      .element_numbers = subject.element_numbers});
}

}  // namespace scan2fea::command
