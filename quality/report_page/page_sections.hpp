// The sections of the page that are text, made of a report's JSON alone, so that the page says what the JSON says.
// Each is HTML from its heading on, or empty where the report has nothing for it.
#pragma once

#include "quality/figure_names.hpp"
#include "quality/report.hpp"

#include <string>

namespace scan2fea {

std::string verdict_section(const Json& report);  // gates, distance from the reference, worst element, what was made up
std::string comparison_section(const Json& report);  // of two meshes
std::string worst_section(const Json& report);       // the worst elements
std::string measures_section(const Json& report);    // all figures, with their meaning and limits
std::string changes_section(const Json& report);     // what was lost and made up
std::string sets_section(const Json& report);        // named faces and sets, bodies, contacts
std::string stages_section(const Json& report);
std::string origin_section(const Json& report);  // files, command, versions

// "mm", "mm\u00b2"; where the unit is not known, "model units".
std::string unit_text(const Json& report, int power = 1);

// Of the schema's unit "length", "degrees", ...: what is set behind a number. Empty where there is none.
std::string unit_behind(const Json& report, const std::string& unit);

// Of one of the worst elements: its likely cause, and the sets that it is in.
std::string cause_of(const Json& element);

// Whether the farthest of all measured points is one of the reference, from which the mesh is far, or one of the mesh.
bool farthest_is_on_reference(const Json& report);

// "0.0123 mm (0.18 % of the diagonal)", of a figure in per cent of the reference's diagonal.
std::string distance_text(const Json& report, const std::string& figure);

}  // namespace scan2fea
