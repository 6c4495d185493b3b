// Gates as JUnit XML, for what shows the results of tests: Jenkins, GitLab and others. One test case for each gate.
#pragma once

#include "quality/report.hpp"

#include <string>

namespace scan2fea {

// Of a report that has its gates: a test suite named after `file`, the mesh that they are of, whose cases have the
// names "surface.edge_ratio.mean <= 1.2", with the set in brackets where they are from one. A failure tells the value,
// the limit, the element and the place. Always well-formed: what XML cannot hold is put as "?".
std::string junit_text(const Json& report, const std::string& file);

}  // namespace scan2fea
