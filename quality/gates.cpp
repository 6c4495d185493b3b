#include "quality/gates.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "quality/figure_names.hpp"
#include "quality/figure_path.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
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

std::string_view without_section(std::string_view name) {
  return name.substr(name.find('.') + 1);
}

WrongUsage wrong_name(std::string what, std::string_view name, std::string advice) {
  return WrongUsage({.what = std::move(what),
                     .where = "--require",
                     .value = std::string(name),
                     .limit = {},
                     .advice = std::move(advice)});
}

std::string full_name(std::string_view name) {
  if (find_figure_path(name)) return std::string(name);
  constexpr std::array<std::string_view, 4> sections{"surface", "deviation", "points", "volume_mesh"};
  std::vector<std::string> matches;
  bool is_group = false;  // edge_ratio is a figure of the volume mesh, but of the surface it is five
  for (const NamedFigure& figure : all_figures()) {
    if (std::ranges::count(sections, figure.section) == 0) continue;
    if (without_section(figure.name) == name) matches.push_back(figure.name);
    is_group = is_group || without_section(figure.name).starts_with(std::string(name) + ".");
  }
  if (matches.empty()) throw wrong_name("no figure has this name", name, nearest_figures(name));
  if (is_group) throw wrong_name("several figures have this name", name, nearest_figures(name));
  if (matches.size() > 1) throw wrong_name("several figures have this name", name, matches[0] + " or " + matches[1]);
  return matches[0];
}

void require_section(const Gate& gate, const Json& report) {
  const std::string section = gate.name.substr(0, gate.name.find('.'));
  if (report.contains(section)) return;
  throw WrongUsage({.what = "the report has no value for a required figure",
                    .where = gate.set.empty() ? "--require" : "--gates " + gate.set,
                    .value = gate.name,
                    .limit = {},
                    .advice = section == "deviation" ? "--reference, since a deviation is one from a reference"
                              : section == "points"  ? "a point cloud, as input or as --reference"
                                                     : "a figure that this input has: it has none of " + section});
}

bool bounds_above(const Gate& gate) {
  return gate.comparison != Comparison::at_least && gate.comparison != Comparison::above;
}

bool bounds_below(const Gate& gate) {
  return gate.comparison != Comparison::at_most && gate.comparison != Comparison::below;
}

bool replaces(const Gate& asked, const Gate& other) {
  return asked.name == other.name && (asked.of_magnitude || (bounds_above(asked) && bounds_above(other)) ||
                                      (bounds_below(asked) && bounds_below(other)));
}

bool are_the_same(const Gate& a, const Gate& b) {
  return a.shown_name() == b.shown_name() && a.comparison == b.comparison && a.limit == b.limit;
}

// Of abs(NAME) the name.
std::optional<std::string_view> name_in_magnitude(std::string_view text) {
  if (!text.starts_with("abs(") || !text.ends_with(")")) return std::nullopt;
  return trimmed(text.substr(4, text.size() - 5));
}

// A sign that was turned round, as in edge_ratio.mean=<1.2.
bool is_turned_sign(std::string_view text, std::size_t sign) {
  return sign > 0 && text[sign - 1] == '=' && (text[sign] == '<' || text[sign] == '>');
}

}  // namespace

std::string_view sign_of(Comparison comparison) {
  return std::find_if(operators.begin(), operators.end(), [&](const Operator& o) { return o.comparison == comparison; })
      ->sign;
}

Gate parse_gate(std::string_view text) {
  // The last one: a name may be that of a set, which may hold anything.
  std::size_t at = text.find_last_of("<>=");
  if (at != std::string_view::npos && at > 0 && text[at] == '=' && text.find_last_of("<>=", at - 1) == at - 1) --at;
  const auto sign = std::find_if(operators.begin(), operators.end(), [&](const Operator& o) {
    return at != std::string_view::npos && text.substr(at).starts_with(o.sign);
  });
  const auto limit = sign == operators.end() ? std::nullopt : parse_limit(trimmed(text.substr(at + sign->sign.size())));
  if (!limit || is_turned_sign(text, at))
    throw WrongUsage({.what = "not a limit on a figure",
                      .where = "--require",
                      .value = std::string(text),
                      .limit = "a name, one of <= >= < > ==, and a number",
                      .advice = "--require \"edge_ratio.mean<=1.2\""});
  const std::string_view name = trimmed(text.substr(0, at));
  const auto of_magnitude = name_in_magnitude(name);
  Gate gate{full_name(of_magnitude.value_or(name)), sign->comparison, *limit};
  gate.of_magnitude = of_magnitude.has_value();
  return gate;
}

bool leaves_a_side_open(const Gate& gate, const std::vector<Gate>& among) {
  const auto figure = find_figure_path(gate.name);
  if (gate.of_magnitude || !figure || figure->schema == nullptr || !figure->schema->value("x-signed", false))
    return false;
  const bool above = bounds_above(gate), below = bounds_below(gate);
  if (above == below || (above ? gate.limit < 0 : gate.limit > 0)) return false;
  return std::ranges::none_of(among, [&](const Gate& other) {
    return other.name == gate.name && (other.of_magnitude || (above ? bounds_below(other) : bounds_above(other)));
  });
}

void refuse_contradictions(const std::vector<Gate>& gates) {
  for (const Gate& low : gates)
    for (const Gate& high : gates) {
      if (low.shown_name() != high.shown_name() || !bounds_below(low) || !bounds_above(high)) continue;
      const bool is_met = holds(high.limit, low.comparison, low.limit) && holds(low.limit, high.comparison, high.limit);
      if (low.limit < high.limit || is_met) continue;
      throw WrongUsage({.what = "no value of a figure meets two gates on it",
                        .where = "--require",
                        .value = low.shown_name() + std::string(sign_of(low.comparison)) + error_text(low.limit),
                        .limit = high.shown_name() + std::string(sign_of(high.comparison)) + error_text(high.limit),
                        .advice = "one of the two"});
    }
}

std::vector<Gate> combined(std::vector<Gate> asked, const std::vector<Gate>& of_sets) {
  std::vector<Gate> gates;
  for (Gate& gate : asked)
    if (std::ranges::none_of(gates, [&](const Gate& other) { return are_the_same(gate, other); }))
      gates.push_back(std::move(gate));
  const std::size_t asked_for = gates.size();
  for (const Gate& gate : of_sets)
    if (std::none_of(gates.begin(), gates.begin() + static_cast<std::ptrdiff_t>(asked_for),
                     [&](const Gate& own) { return replaces(own, gate); }))
      gates.push_back(gate);
  return gates;
}

std::vector<GateResult> evaluate_gates(const std::vector<Gate>& gates, const Json& report) {
  std::vector<GateResult> results;
  for (const Gate& gate : gates) {
    require_section(gate, report);
    FigurePath figure = find_figure_path(gate.name, &report).value_or(FigurePath{});
    if (gate.of_magnitude && figure.value) figure.value = std::abs(*figure.value);
    GateResult result{gate, figure.value, figure.value && holds(*figure.value, gate.comparison, gate.limit)};
    if (!figure.value) result.reason = figure.missing.empty() ? "the format has no such figure" : figure.missing;
    if (figure.value && figure.place && figure.place->is_array() && (*figure.place)[0].is_number())
      result.place = figure.place->get<std::vector<double>>();
    if (figure.value) result.element = figure.element;
    results.push_back(std::move(result));
  }
  return results;
}

bool all_pass(const std::vector<GateResult>& results) {
  return std::all_of(results.begin(), results.end(), [](const GateResult& result) { return result.pass; });
}

Json to_json(const std::vector<GateResult>& results) {
  Json json = Json::array();
  for (const GateResult& result : results) {
    Json entry{{"name", result.gate.shown_name()},
               {"operator", sign_of(result.gate.comparison)},
               {"value", result.value ? Json(*result.value) : Json(nullptr)},
               {"limit", result.gate.limit},
               {"pass", result.pass}};
    if (!result.reason.empty()) entry["reason"] = result.reason;
    if (!result.gate.set.empty()) entry["set"] = result.gate.set;
    if (!result.gate.source.empty()) entry["source"] = result.gate.source;
    if (result.place) entry["place"] = *result.place;
    if (result.element) entry["element"] = *result.element;
    json.push_back(std::move(entry));
  }
  return json;
}

}  // namespace scan2fea
