#include "preproc/command/gates_asked.hpp"

#include "preproc/command/console.hpp"
#include "preproc/command/element_figures.hpp"
#include "preproc/command/piped_files.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "quality/extreme_elements.hpp"
#include "quality/limits.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>

namespace scan2fea::command {
namespace {

bool is_in(const Gate& gate, std::string_view section) {
  return gate.name.starts_with(section) && gate.name.substr(section.size(), 1) == ".";
}

void find_place(const Subject& subject, GateResult& result) {
  if (result.place || !result.value) return;
  const auto note = [&](const ExtremeElement& found, bool has_number) {
    result.place = {found.place.x(), found.place.y(), found.place.z()};
    if (has_number) result.element = element_number(found.index, subject);
  };
  if (subject.volume_mesh != nullptr)
    if (const auto found = extreme_tetrahedron(*subject.volume_mesh, result.gate.name)) note(*found, true);
  // The triangles of a volume mesh's boundary are no elements.
  if (subject.surface != nullptr)
    if (const auto found = extreme_triangle(*subject.surface, result.gate.name))
      note(*found, subject.volume_mesh == nullptr);
}

std::string describe(const GateResult& result) {
  const Gate& gate = result.gate;
  std::string text = "gate failed: " + gate.shown_name();
  if (result.value)
    text += " is " + error_text(*result.value);
  else
    text += " has no value, " + result.reason;
  text += " (limit: " + std::string(sign_of(gate.comparison)) + " " + error_text(gate.limit);
  if (!gate.set.empty()) text += " of " + gate.set;
  text += ")";
  if (result.element) text += ", element " + std::to_string(*result.element);
  if (result.place) text += " at " + error_text(Vec3((*result.place)[0], (*result.place)[1], (*result.place)[2]));
  return text;
}

}  // namespace

AskedGates parse_gates(const CommonFlags& flags) {
  AskedGates asked;
  for (const std::string& text : flags.require) asked.gates.push_back(parse_gate(text));
  refuse_contradictions(asked.gates);
  for (const Gate& gate : asked.gates)
    if (leaves_a_side_open(gate, asked.gates) && !flags.quiet)
      warn("--require " + gate.name + std::string(sign_of(gate.comparison)) + error_text(gate.limit) +
           ": the figure has a sign, and the other side is not bounded; abs(" + gate.name + ") bounds both");
  for (const std::string& set : flags.gates)
    if (std::ranges::find(asked.sets, set) == asked.sets.end()) asked.sets.push_back(set);
  if (flags.junit && asked.gates.empty() && asked.sets.empty())
    throw WrongUsage({.what = "there are no gates to tell of",
                      .where = "--junit",
                      .value = flags.junit->string(),
                      .limit = {},
                      .advice = "--gates nastran, or --require \"edge_ratio.mean<=1.2\""});
  return asked;
}

std::vector<Gate> gates_for(const AskedGates& asked, bool is_volume_mesh) {
  std::vector<Gate> of_sets;
  for (const std::string& set : asked.sets)
    for (Gate& gate : gates_of_set(set, is_volume_mesh)) of_sets.push_back(std::move(gate));
  std::vector<Gate> gates = combined(asked.gates, of_sets);
  for (const Gate& gate : gates)
    if (!is_volume_mesh && is_in(gate, "volume_mesh"))
      throw WrongUsage({.what = "a figure of volume meshes is required of a surface",
                        .where = "--require",
                        .value = gate.name,
                        .limit = {},
                        .advice = "a figure of surface, or scan2fea run"});
  return gates;
}

bool has_gate_on(const std::vector<Gate>& gates, std::initializer_list<std::string_view> sections) {
  return std::ranges::any_of(gates, [&](const Gate& gate) {
    return std::ranges::any_of(sections, [&](std::string_view section) { return is_in(gate, section); });
  });
}

std::vector<GateResult> judge(const std::vector<Gate>& gates, const Subject& subject, Json& report) {
  std::vector<GateResult> results = evaluate_gates(gates, report);
  for (GateResult& result : results) find_place(subject, result);
  report["gates"] = scan2fea::to_json(results);
  return results;
}

void tell_failures(const std::vector<GateResult>& results, const std::filesystem::path& input) {
  for (const GateResult& result : results)
    if (!result.pass) say(LineKind::error, shown_name(input) + ": " + describe(result));
}

}  // namespace scan2fea::command
