#include "quality/report_page/html.hpp"

#include <cmath>
#include <cstdio>

namespace scan2fea::html {

namespace {

std::string data_of(std::string_view name, const Json& value, const std::string& text) {
  return "<data data-figure=\"" + escaped(name) + "\" value=\"" + escaped(value.dump()) + "\">" + text + "</data>";
}

}  // namespace

std::string number(const Json& value, int digits) {
  if (value.is_null()) return "none";
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_integer()) {
    std::string text = value.dump();  // in groups of three
    for (auto i = static_cast<std::ptrdiff_t>(text.size()) - 3; i > (text[0] == '-' ? 1 : 0); i -= 3)
      text.insert(static_cast<std::size_t>(i), "\u2009");
    return text;
  }
  if (!value.is_number()) return value.is_string() ? escaped(value.get<std::string>()) : escaped(value.dump());
  char text[40];
  const double x = value.get<double>();
  // A count that came as a double, or more digits before the point than asked for.
  if (std::abs(x) >= std::pow(10.0, digits) && std::abs(x) < 1e9)
    std::snprintf(text, sizeof text, "%.0f", x);
  else
    std::snprintf(text, sizeof text, "%.*g", digits, x);
  return text;
}

std::string figure(const Json& report, std::string_view name, int digits) {
  const Json* value = find_figure(report, name);
  if (value == nullptr) return {};
  return data_of(name, *value, number(*value, digits));
}

std::string percent_figure(const Json& report, std::string_view name, int digits) {
  const Json* value = find_figure(report, name);
  return value == nullptr ? std::string() : data_of(name, *value, percent(*value, digits));
}

std::string percent(const Json& value, int digits) {
  constexpr double rounding = 1e-6;
  if (value.is_null()) return "not known";
  return (std::abs(value.get<double>()) < rounding ? "0" : number(value, digits)) + "\u00a0%";
}

std::string counted(const Json& count, std::string_view one, std::string_view many) {
  return number(count) + " " + std::string(count == 1 ? one : many);
}

std::string place(const Json& point, const Json& report) {
  if (!point.is_array() || point.size() != 3) return "none";
  int digits = 5;
  const Json* size = find_figure(report, "size.diagonal");
  if (size != nullptr && size->get<double>() > 0) {
    double farthest = size->get<double>();
    for (const Json& x : point)
      if (x.is_number()) farthest = std::max(farthest, std::abs(x.get<double>()));
    digits += static_cast<int>(std::ceil(std::log10(farthest / size->get<double>())));
  }
  return "(" + number(point[0], digits) + ", " + number(point[1], digits) + ", " + number(point[2], digits) + ")";
}

std::string show_button(std::string_view what, std::string_view label, std::string_view data) {
  return "<button type=\"button\" class=\"show\" data-show=\"" + escaped(what) + "\" data-at=\"" + escaped(data) +
         "\">" + escaped(label) + "</button>";
}

Table::Table(std::string_view caption, std::vector<std::string> columns) : columns_(std::move(columns)) {
  head_ = "<div class=\"scroll\"><table>";
  if (!caption.empty()) head_ += "<caption>" + escaped(caption) + "</caption>";
  head_ += "<thead><tr>";
  for (const std::string& column : columns_) {
    const bool is_number = column.starts_with('#');
    head_ += std::string("<th scope=\"col\"") + (is_number ? " class=\"number\">" : ">") +
             escaped(std::string_view(column).substr(is_number ? 1 : 0)) + "</th>";
  }
  head_ += "</tr></thead><tbody>\n";
}

void Table::row(const std::vector<std::string>& cells, std::string_view attributes) {
  body_ += "<tr" + (attributes.empty() ? std::string() : " " + std::string(attributes)) + ">";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool is_number = columns_[i].starts_with('#');
    body_ += "<td data-column=\"" + escaped(std::string_view(columns_[i]).substr(is_number ? 1 : 0)) + "\"" +
             (is_number ? " class=\"number\">" : ">") + cells[i] + "</td>";
  }
  body_ += "</tr>\n";
}

std::string Table::text() const {
  return body_.empty() ? std::string() : head_ + body_ + "</tbody></table></div>\n";
}

}  // namespace scan2fea::html
