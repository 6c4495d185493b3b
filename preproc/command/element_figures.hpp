// What a report tells of single elements, in figures and for its page.
#pragma once

#include "preproc/command/figures.hpp"
#include "quality/element_measures.hpp"
#include "quality/histogram.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea::command {

struct ElementFigures {
  ElementMeasures measures;
  std::vector<MeasuredElements> histograms;
  std::vector<std::uint32_t> worst;  // elements, the worst first; found by add_to_json
};

// By which a user knows the element.
std::uint64_t element_number(std::uint32_t element, const Subject& subject);

// The worst element with its number, figure and place, a row for the table of figures; empty where there is none.
std::string worst_element_row(const Subject& subject, const Json& report);

// Precondition: the subject has a surface.
// Of the surface, or of a volume mesh its boundary.
const std::vector<NamedSet>& face_sets_of(const Subject& subject);

ElementFigures measure_elements(const Subject& subject);

// Adds `histograms` and `worst_elements`.
void add_to_json(ElementFigures& elements, const Subject& subject, Json& report);

// report.html: of a report that has all its figures.
std::string page_of(const Json& report, const ElementFigures& elements, const Subject& subject);

}  // namespace scan2fea::command
