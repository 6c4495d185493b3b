// The figures of a report by name: keys joined by points, as in "surface.edge_ratio.mean".
//
// In a list stands the name of one of its entries (of a contact its set, of a histogram its measure),
// "faces.FACE_3.area", or its number from 0, "lost.0.size"; and after a figure of its entries "max", "min", "sum" or
// "mean" of all that have it, "bodies.volume_difference_pct.max"; "lost.count" is how many there are. Of an empty list
// the count, the largest and the sum are 0. Of three numbers x, y and z, "size.box.x". An underscore stands for a
// blank, too: "stages.second_order.nodes".
#pragma once

#include "quality/report.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <string_view>

namespace scan2fea {

struct FigurePath {
  const Json* schema = nullptr;          // what report.schema.json says of it
  std::optional<double> value;           // yes is 1 and no is 0
  std::optional<Json> place;             // [x, y, z], where it has one
  std::optional<std::uint64_t> element;  // that it is of
  std::string missing;                   // why there is no value
};

// Nothing where the format has no such figure. Which names the entries of a list have is known when there is a report;
// without one any will do, and there is no value.
std::optional<FigurePath> find_figure_path(std::string_view name, const Json* report = nullptr);

// What stands under these keys, whatever it is, without names and numbers of entries; null where the report has
// nothing.
const Json* find_figure(const Json& report, std::string_view name);

// What the format says of the figure: an empty text where it does not.
std::string description_of(const Json& schema, const char* keyword);

// A schema, or the one that it refers to.
const Json& referred(const Json& schema);

bool is_figure(const Json& schema);  // a number, or yes and no
bool is_point(const Json& schema);   // [x, y, z]

// The key by whose text the entries of a list are known; nothing where they are known by their number.
std::optional<std::string> name_key(const Json& list_schema);

}  // namespace scan2fea
