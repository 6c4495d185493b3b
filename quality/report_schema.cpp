#include "quality/report_schema.hpp"

#include "quality/taken_in.hpp"

#include <nlohmann/json.hpp>

SCAN2FEA_TAKE_IN(report_schema, SCAN2FEA_REPORT_SCHEMA);

namespace scan2fea {

const nlohmann::ordered_json& report_schema_json() {
  static const auto schema = nlohmann::ordered_json::parse(scan2fea_report_schema, scan2fea_report_schema_end);
  return schema;
}

}  // namespace scan2fea
