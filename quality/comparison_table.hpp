// Two meshes side by side, as a terminal shows them.
#pragma once

#include "quality/report.hpp"

#include <string>

namespace scan2fea {

// `compared`: the section of a report. A line for each figure that either mesh has, in columns.
std::string comparison_table(const Json& compared);

}  // namespace scan2fea
