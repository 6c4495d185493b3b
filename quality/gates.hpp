// Limits that a mesh must keep, as in --require "edge_ratio.mean<=1.2". A gate is never passed for want of a figure.
#pragma once

#include "quality/report.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace scan2fea {

enum class Comparison { at_most, at_least, below, above, equal };

struct Gate {
  std::string name;  // of the figure, in full: "surface.edge_ratio.mean"
  Comparison comparison;
  double limit;
};

struct GateResult {
  Gate gate;
  double value;  // yes is 1 and no is 0
  bool pass;
};

// Of the form NAME OP LIMIT: a figure of the report's sections surface, deviation and volume_mesh, with or without the
// section's name where one section alone has it, or of a stage, as in stages.simplify.feature_edges_unsupported; one of
// <= >= < > ==; a number, or true or false. Throws WrongUsage if it is not that, naming the nearest figures where there
// is none of the name.
Gate parse_gate(std::string_view text);

// Throws WrongUsage where the report has no such figure, or the figure is null: deviation without a reference, the
// genus of an open surface.
std::vector<GateResult> evaluate_gates(const std::vector<Gate>& gates, const Json& report);

bool all_pass(const std::vector<GateResult>& results);

// For the report's `gates`.
Json to_json(const std::vector<GateResult>& results);

}  // namespace scan2fea
