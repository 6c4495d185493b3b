// Pieces of HTML, of texts and numbers that may be anything.
#pragma once

#include "quality/escaped.hpp"
#include "quality/figure_path.hpp"
#include "quality/report.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace scan2fea::html {

using scan2fea::escaped;

// A number with so many significant digits, its exponent in words that people read: "1.2e-07", "12604", "none" for
// null, "yes" and "no".
std::string number(const Json& value, int digits = 4);

// The figure of this name ("surface.edge_ratio.mean") as a <data> that holds the whole of it, so that a script, and a
// test, finds what the text rounds. An empty text where the report has no such figure.
std::string figure(const Json& report, std::string_view name, int digits = 4);
std::string percent_figure(const Json& report, std::string_view name, int digits = 3);  // with the sign, see percent

// "0.3 %"; what is nothing but rounding is 0, and a null, of what has no volume, is "not known".
std::string percent(const Json& value, int digits = 3);

// "1 element is", "2 elements are": the count and the words of one, or of many.
std::string counted(const Json& count, std::string_view one, std::string_view many);

// "(1.5, 0, -2)", for a list of three numbers, of so many digits that of the report's mesh a ten-thousandth is told.
std::string place(const Json& point, const Json& report);

// A button that shows a place in the view: what the script looks for.
std::string show_button(std::string_view what, std::string_view label, std::string_view data);

// A table of these columns, a name's first letter telling how it is set: "#Area" to the right, as numbers are. Each
// cell knows its column's name, which stands beside it where a screen is too narrow for a table.
class Table {
 public:
  Table(std::string_view caption, std::vector<std::string> columns);
  void row(const std::vector<std::string>& cells, std::string_view attributes = {});  // cells are HTML
  std::string text() const;                                                           // empty where there are no rows
 private:
  std::vector<std::string> columns_;
  std::string head_, body_;
};

}  // namespace scan2fea::html
