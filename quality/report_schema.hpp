// report.schema.json, which says of every figure of a report what it is and what it is in: the one place where that is
// written, for the report's page, for gates and for their list.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace scan2fea {

const nlohmann::ordered_json& report_schema_json();

}  // namespace scan2fea
