#include "quality/figure_path.hpp"

#include "quality/report_schema.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>
#include <vector>

namespace scan2fea {
namespace {

using Found = std::optional<FigurePath>;

// The rest of a name after a key, or nothing where it does not begin with it.
std::optional<std::string_view> after(std::string_view name, std::string_view key) {
  if (key.empty() || name.size() < key.size()) return std::nullopt;
  for (std::size_t i = 0; i < key.size(); ++i)
    if (name[i] != key[i] && !(name[i] == '_' && key[i] == ' ')) return std::nullopt;
  if (name.size() == key.size()) return std::string_view();
  if (name[key.size()] != '.') return std::nullopt;
  return name.substr(key.size() + 1);
}

const Json* child(const Json* report, const std::string& key) {
  if (report == nullptr || !report->is_object()) return nullptr;
  const auto found = report->find(key);
  return found == report->end() ? nullptr : &*found;
}

std::optional<double> number_of(const Json& json) {
  if (json.is_boolean()) return json.get<bool>() ? 1 : 0;
  if (json.is_number() && std::isfinite(json.get<double>())) return json.get<double>();
  return std::nullopt;
}

void note_origin(const Json* entry, FigurePath& figure) {
  if (const Json* place = child(entry, "place"); place != nullptr && !figure.place) figure.place = *place;
  if (const Json* element = child(entry, "element"); element != nullptr && !figure.element)
    figure.element = element->get<std::uint64_t>();
}

Found find(const Json& schema, const Json* report, std::string_view name);

Found figure(const Json& schema, const Json* report) {
  if (!is_figure(schema)) return std::nullopt;
  FigurePath found;
  found.schema = &schema;
  if (report != nullptr) found.value = number_of(*report);
  if (!found.value) found.missing = "this mesh has none";
  return found;
}

Found find_in_object(const Json& schema, const Json* report, std::string_view name) {
  for (const auto& [key, value] : schema["properties"].items()) {
    const auto rest = after(name, key);
    if (!rest) continue;
    const Json* below = child(report, key);
    Found found = find(value, below, *rest);
    if (!found) continue;
    if (report != nullptr && below == nullptr && value.contains("default")) found->value = number_of(value["default"]);
    if (const std::string place = description_of(value, "x-place"); !place.empty() && child(report, place) != nullptr)
      found->place = *child(report, place);
    return found;
  }
  return std::nullopt;
}

// What an entry of the list may be: of one kind, or of several that a name tells apart.
std::vector<const Json*> kinds_of_entries(const Json& list) {
  const Json& items = list["items"];
  if (!items.contains("oneOf")) return {&referred(items)};
  std::vector<const Json*> kinds;
  for (const Json& kind : items["oneOf"]) kinds.push_back(&kind);
  return kinds;
}

// That all entries of a kind have; empty where they have names of their own.
std::string only_name_of(const Json& kind, const std::string& key) {
  return kind.contains("properties") ? description_of(kind["properties"].value(key, Json::object()), "const")
                                     : std::string();
}

// Entries of one kind have any name; it may hold points, so that the longest that leaves a figure is not known before.
Found find_by_any_name(const Json& kind, std::string_view name) {
  for (std::size_t at = name.find('.'); at != std::string_view::npos; at = name.find('.', at + 1))
    if (Found found = find(kind, nullptr, name.substr(at + 1))) {
      found->missing = "there is no " + std::string(name.substr(0, at));
      return found;
    }
  return std::nullopt;
}

// "; there are FACE_1, FACE_2, ...".
std::string names_of_entries(const Json& entries, const std::string& key) {
  constexpr std::size_t most = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, entries.size()); ++i)
    text += (i > 0 ? ", " : "; there are ") + entries[i].value(key, "");
  return text + (entries.size() > most ? ", ..." : "");
}

Found find_by_name(const Json& list, const Json* report, std::string_view name) {
  const auto key = name_key(list);
  if (!key) return std::nullopt;
  for (const Json* kind : kinds_of_entries(list)) {
    const std::string only = only_name_of(*kind, *key);
    if (report != nullptr)
      for (const Json& entry : *report) {
        const std::string own = entry.value(*key, "");
        const auto rest = only.empty() || own == only ? after(name, own) : std::nullopt;
        Found found = rest ? find(*kind, &entry, *rest) : std::nullopt;
        if (!found) continue;
        note_origin(&entry, *found);
        return found;
      }
    const auto rest = after(name, only);
    Found found = !only.empty() ? (rest ? find(*kind, nullptr, *rest) : std::nullopt) : find_by_any_name(*kind, name);
    if (!found) continue;
    if (!only.empty())
      found->missing = "there was no stage " + only;
    else if (report != nullptr)
      found->missing += names_of_entries(*report, *key);
    return found;
  }
  return std::nullopt;
}

Found find_by_number(const Json& list, const Json* report, std::string_view name) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), index);
  const auto digits = static_cast<std::size_t>(end - name.data());
  if (error != std::errc() || (digits < name.size() && name[digits] != '.')) return std::nullopt;
  const std::string_view rest = name.substr(std::min(digits + 1, name.size()));
  const Json* entry = report != nullptr && index < report->size() ? &(*report)[index] : nullptr;
  for (const Json* kind : kinds_of_entries(list))
    if (Found found = find(*kind, entry, rest)) {
      note_origin(entry, *found);
      if (entry == nullptr) found->missing = "there are not so many";
      return found;
    }
  return std::nullopt;
}

// Over all entries that have the figure.
Found summarised(const Json& list, const Json* report, std::string_view inner, std::string_view how) {
  FigurePath summary;
  for (const Json* kind : kinds_of_entries(list))
    if (const Found found = find(*kind, nullptr, inner); found && !summary.schema) summary.schema = found->schema;
  if (summary.schema == nullptr) return std::nullopt;
  summary.missing = "no entry has it";
  double sum = 0;
  std::size_t count = 0;
  if (report != nullptr)
    for (const Json& entry : *report)
      for (const Json* kind : kinds_of_entries(list)) {
        if (const std::string only = only_name_of(*kind, "name"); !only.empty() && only != entry.value("name", ""))
          continue;
        Found found = find(*kind, &entry, inner);
        if (!found || !found->value) continue;
        sum += *found->value;
        ++count;
        const bool is_first = count == 1;
        if (is_first || (how == "max" && *found->value > *summary.value) ||
            (how == "min" && *found->value < *summary.value)) {
          summary.value = found->value;
          summary.place.reset(), summary.element.reset();
          if (how == "max" || how == "min") note_origin(&entry, summary);
        }
      }
  if (count > 0 && how == "sum") summary.value = sum;
  if (count > 0 && how == "mean") summary.value = sum / static_cast<double>(count);
  if (report != nullptr && report->empty() && (how == "sum" || how == "max")) summary.value = 0;
  return summary;
}

Found find_in_list(const Json& schema, const Json* report, std::string_view name) {
  if (report != nullptr && !report->is_array()) report = nullptr;
  if (name == "count") {
    FigurePath count;
    count.schema = &schema;
    if (report != nullptr) count.value = static_cast<double>(report->size());
    return count;
  }
  constexpr std::array<std::string_view, 4> summaries{"max", "min", "sum", "mean"};
  const std::size_t last = name.rfind('.');
  const std::string_view inner = last == std::string_view::npos ? std::string_view() : name.substr(0, last);
  const std::string_view how = name.substr(last == std::string_view::npos ? 0 : last + 1);
  if (std::ranges::count(summaries, how) > 0)
    if (Found found = summarised(schema, report, inner, how)) return found;
  if (Found found = find_by_number(schema, report, name)) return found;
  return find_by_name(schema, report, name);
}

Found find(const Json& schema_or_reference, const Json* report, std::string_view name) {
  const Json& schema = referred(schema_or_reference);
  if (name.empty()) return figure(schema, report);
  if (is_point(schema)) {
    if (name.size() != 1 || name[0] < 'x' || name[0] > 'z') return std::nullopt;
    FigurePath found;
    found.schema = &schema_or_reference;
    if (report != nullptr && report->is_array())
      found.value = number_of((*report)[static_cast<std::size_t>(name[0] - 'x')]);
    return found;
  }
  if (schema.contains("properties")) return find_in_object(schema, report, name);
  if (schema.contains("items")) return find_in_list(schema, report, name);
  return std::nullopt;
}

}  // namespace

const Json& referred(const Json& schema) {
  if (!schema.contains("$ref")) return schema;
  return report_schema_json().at(Json::json_pointer(schema["$ref"].get<std::string>().substr(1)));
}

bool is_figure(const Json& schema) {
  if (!schema.contains("type")) return false;
  const Json& type = schema["type"];
  return std::ranges::any_of(std::array{"number", "integer", "boolean"}, [&](const char* name) {
    return type == name || (type.is_array() && std::ranges::find(type, Json(name)) != type.end());
  });
}

bool is_point(const Json& schema) {
  return &referred(schema) == &report_schema_json()["$defs"]["vector"];
}

const Json* find_figure(const Json& report, std::string_view name) {
  const Json* at = &report;
  while (!name.empty()) {
    const std::size_t point = name.find('.');
    const std::string key(name.substr(0, point));
    if (!at->is_object() || !at->contains(key)) return nullptr;
    at = &(*at)[key];
    name = point == std::string_view::npos ? std::string_view{} : name.substr(point + 1);
  }
  return at;
}

std::string description_of(const Json& schema, const char* keyword) {
  return schema.is_object() ? schema.value(keyword, "") : std::string();
}

std::optional<std::string> name_key(const Json& list_schema) {
  std::string key = list_schema.value("x-name", "name");
  const Json& items = list_schema["items"];
  const Json& entry = items.contains("oneOf") ? items["oneOf"][0] : items;
  return entry.contains("properties") && entry["properties"].contains(key) ? std::optional(std::move(key))
                                                                           : std::nullopt;
}

std::optional<FigurePath> find_figure_path(std::string_view name, const Json* report) {
  return name.empty() || name.starts_with("gates.") ? std::nullopt : find(report_schema_json(), report, name);
}

}  // namespace scan2fea
