#include "quality/gates.hpp"

#include "preproc/mesh/error.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

namespace scan2fea {
namespace {

struct Operator {
  std::string_view sign;
  Comparison comparison;
};
// Longer signs first, so that "<=" is not read as "<".
constexpr std::array<Operator, 5> operators{{{"<=", Comparison::at_most},
                                             {">=", Comparison::at_least},
                                             {"==", Comparison::equal},
                                             {"<", Comparison::below},
                                             {">", Comparison::above}}};

std::string_view sign_of(Comparison comparison) {
  return std::find_if(operators.begin(), operators.end(), [&](const Operator& o) { return o.comparison == comparison; })
      ->sign;
}

bool holds(double value, Comparison comparison, double limit) {
  switch (comparison) {
    case Comparison::at_most:
      return value <= limit;
    case Comparison::at_least:
      return value >= limit;
    case Comparison::below:
      return value < limit;
    case Comparison::above:
      return value > limit;
    case Comparison::equal:
      return value == limit;
  }
  return false;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::optional<double> parse_limit(std::string_view text) {
  if (text == "true") return 1;
  if (text == "false") return 0;
  double limit;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), limit);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(limit)) return std::nullopt;
  return limit;
}

void add_names(const Json& json, const std::string& prefix, std::vector<std::string>& names) {
  for (const auto& [key, value] : json.items()) {
    if (value.is_object())
      add_names(value, prefix + key + ".", names);
    else if (!value.is_array())
      names.push_back(prefix + key);
  }
}

// The names of all figures, those of a report with every section.
std::vector<std::string> all_names() {
  Report full;
  full.surface.emplace();
  full.deviation.emplace();
  full.points.emplace();
  full.volume_mesh.emplace();
  const Json json = to_json(full);
  std::vector<std::string> names;
  for (const char* section : {"surface", "deviation", "points", "volume_mesh"})
    add_names(json[section], std::string(section) + ".", names);
  return names;
}

std::string_view without_section(std::string_view name) {
  return name.substr(name.find('.') + 1);
}

// Levenshtein's: insertions, deletions and replacements.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] != b[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

std::string nearest_names(std::string_view name, std::vector<std::string> names) {
  const auto distance = [&](const std::string& candidate) {
    // What was typed in full and is only incomplete, as edge_ratio for edge_ratio.mean, is nearest of all.
    if (candidate.find(name) != std::string::npos) return std::size_t{0};
    return std::min(edit_distance(name, candidate), edit_distance(name, without_section(candidate)));
  };
  std::stable_sort(names.begin(), names.end(),
                   [&](const std::string& a, const std::string& b) { return distance(a) < distance(b); });
  return names[0] + ", " + names[1] + " or " + names[2];
}

WrongUsage wrong_name(std::string what, std::string_view name, std::string advice) {
  return WrongUsage({.what = std::move(what),
                     .where = "--require",
                     .value = std::string(name),
                     .limit = {},
                     .advice = std::move(advice)});
}

std::string full_name(std::string_view name) {
  if (name.starts_with("stages.")) return std::string(name);  // which figures a stage has is known when it has run
  const std::vector<std::string> names = all_names();
  std::vector<std::string> matches;
  bool is_group = false;  // edge_ratio is a figure of the volume mesh, but of the surface it is five
  for (const std::string& candidate : names) {
    if (candidate == name) return candidate;
    if (without_section(candidate) == name) matches.push_back(candidate);
    is_group = is_group || without_section(candidate).starts_with(std::string(name) + ".");
  }
  if (matches.empty()) throw wrong_name("no figure has this name", name, nearest_names(name, names));
  if (is_group) throw wrong_name("several figures have this name", name, nearest_names(name, names));
  if (matches.size() > 1) throw wrong_name("several figures have this name", name, matches[0] + " or " + matches[1]);
  return matches[0];
}

// Null where there is none. Stages are a list of objects with a name.
const Json* member(const Json& json, const std::string& name) {
  if (json.is_array()) {
    const auto stage =
        std::find_if(json.begin(), json.end(), [&](const Json& s) { return s.value("name", "") == name; });
    return stage == json.end() ? nullptr : &*stage;
  }
  const auto found = json.find(name);
  return found == json.end() ? nullptr : &*found;
}

// Null where the report has no figure of this name.
Json figure_of(const Gate& gate, const Json& report) {
  const Json* json = &report;
  for (std::size_t begin = 0; begin <= gate.name.size();) {
    const std::size_t end = std::min(gate.name.find('.', begin), gate.name.size());
    json = member(*json, gate.name.substr(begin, end - begin));
    if (json == nullptr) return nullptr;
    begin = end + 1;
  }
  return *json;
}

double value_of(const Gate& gate, const Json& report) {
  const Json figure = figure_of(gate, report);
  if (figure.is_boolean()) return figure.get<bool>() ? 1 : 0;
  if (figure.is_number() && std::isfinite(figure.get<double>())) return figure.get<double>();
  const std::string section = gate.name.substr(0, gate.name.find('.'));
  std::string advice = "another figure: this one has no meaning for this input";
  if (!report.contains(section))
    advice = section == "deviation" ? "--reference, since a deviation is one from a reference"
             : section == "points"  ? "a point cloud, as input or as --reference"
                                    : "a figure that this input has: it has none of " + section;
  throw WrongUsage({.what = "the report has no value for a required figure",
                    .where = "--require",
                    .value = gate.name,
                    .limit = {},
                    .advice = advice});
}

}  // namespace

Gate parse_gate(std::string_view text) {
  const std::size_t at = text.find_first_of("<>=");
  const auto sign = std::find_if(operators.begin(), operators.end(), [&](const Operator& o) {
    return at != std::string_view::npos && text.substr(at).starts_with(o.sign);
  });
  const auto limit = sign == operators.end() ? std::nullopt : parse_limit(trimmed(text.substr(at + sign->sign.size())));
  if (!limit)
    throw WrongUsage({.what = "not a limit on a figure",
                      .where = "--require",
                      .value = std::string(text),
                      .limit = "a name, one of <= >= < > ==, and a number",
                      .advice = "--require \"edge_ratio.mean<=1.2\""});
  return {full_name(trimmed(text.substr(0, at))), sign->comparison, *limit};
}

std::vector<GateResult> evaluate_gates(const std::vector<Gate>& gates, const Json& report) {
  std::vector<GateResult> results;
  for (const Gate& gate : gates) {
    const double value = value_of(gate, report);
    results.push_back({gate, value, holds(value, gate.comparison, gate.limit)});
  }
  return results;
}

bool all_pass(const std::vector<GateResult>& results) {
  return std::all_of(results.begin(), results.end(), [](const GateResult& result) { return result.pass; });
}

Json to_json(const std::vector<GateResult>& results) {
  Json json = Json::array();
  for (const auto& [gate, value, pass] : results)
    json.push_back({{"name", gate.name},
                    {"operator", sign_of(gate.comparison)},
                    {"value", value},
                    {"limit", gate.limit},
                    {"pass", pass}});
  return json;
}

}  // namespace scan2fea
