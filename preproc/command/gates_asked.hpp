// --require, --gates, --junit and --list-gates: the gates that were asked for, and what became of them.
#pragma once

#include "preproc/command/figures.hpp"
#include "quality/gates.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace scan2fea::command {

struct AskedGates {
  std::vector<Gate> gates;        // each by itself
  std::vector<std::string> sets;  // see limits.hpp
};

// Before any work is done. Throws WrongUsage, also where --junit has no gates to tell of.
AskedGates parse_gates(const CommonFlags& flags);

// All of them, of a mesh of this kind. Throws WrongUsage where a set has none, or a gate is on tetrahedra of a surface.
std::vector<Gate> gates_for(const AskedGates& asked, bool is_volume_mesh);

bool has_gate_on(const std::vector<Gate>& gates, std::initializer_list<std::string_view> sections);

// Evaluates them on a report that is complete but for its gates, finds the elements that have the values, and adds
// `gates` to it.
std::vector<GateResult> judge(const std::vector<Gate>& gates, const Subject& subject, Json& report);

// On stderr, a line for each that failed.
void tell_failures(const std::vector<GateResult>& results, const std::filesystem::path& input);

}  // namespace scan2fea::command
