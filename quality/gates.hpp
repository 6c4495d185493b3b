// Limits that a mesh must keep, as in --require "edge_ratio.mean<=1.2". A gate is never passed for want of a figure.
#pragma once

#include "quality/report.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scan2fea {

enum class Comparison { at_most, at_least, below, above, equal };

struct Gate {
  std::string name;  // of the figure, in full: "surface.edge_ratio.mean"
  Comparison comparison;
  double limit;
  std::string set = {};       // of --gates, that it is from; empty where it was asked for by itself
  std::string source = {};    // of a set's limit
  bool of_magnitude = false;  // abs(NAME): of the figure without its sign

  std::string shown_name() const { return of_magnitude ? "abs(" + name + ")" : name; }
};

struct GateResult {
  Gate gate;
  std::optional<double> value;  // yes is 1 and no is 0
  bool pass;
  std::string reason = {};                        // why there is no value
  std::optional<std::vector<double>> place = {};  // of the value, three coordinates, where it has one
  std::optional<std::uint64_t> element = {};      // that has the value, by its number in the file
};

// Of the form NAME OP LIMIT, or abs(NAME) OP LIMIT: any figure of the report by its name (figure_path.hpp), of the
// sections surface, deviation, points and volume_mesh with or without the section's name where one of them alone has
// it; one of <= >= < >
// ==; a number, or true or false. Throws WrongUsage if it is not that, naming the nearest figures where there is none
// of the name.
Gate parse_gate(std::string_view text);

// Whether the gate bounds one side of a figure that may be on either side of 0, as a difference, and no other bounds
// the other side: then a loss passes that is larger than the gain that does not.
bool leaves_a_side_open(const Gate& gate, const std::vector<Gate>& among);

// Throws WrongUsage where no value meets both of two gates on one figure.
void refuse_contradictions(const std::vector<Gate>& gates);

// Those that were asked for by themselves, and of the sets those whose figure has no such gate on the same side: a
// limit from above replaces one from above, == either. Which gates a set has is told by limits.hpp.
std::vector<Gate> combined(std::vector<Gate> asked, const std::vector<Gate>& of_sets);

// A figure that has no value, as the genus of an open surface, fails. Throws WrongUsage where the report has not even
// the figure's section: deviation without a reference.
std::vector<GateResult> evaluate_gates(const std::vector<Gate>& gates, const Json& report);

bool all_pass(const std::vector<GateResult>& results);

// For the report's `gates`.
Json to_json(const std::vector<GateResult>& results);

// "<=".
std::string_view sign_of(Comparison comparison);

}  // namespace scan2fea
