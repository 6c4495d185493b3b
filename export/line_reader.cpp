#include "export/line_reader.hpp"

#include "export/number_text.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>

namespace scan2fea {

bool LineReader::next() {
  if (put_back_) {
    put_back_ = false;
    return true;
  }
  if (rest_.empty()) return false;
  const std::size_t end = std::min(rest_.find('\n'), rest_.size());
  line_ = rest_.substr(0, end);
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  return true;
}

void LineReader::fail(std::string what, std::string value, std::string limit, std::string advice) const {
  if (line_.data() == nullptr) file_.fail(std::move(what), std::move(value), std::move(limit), std::move(advice));
  file_.fail_at_line(line_.data(), std::move(what), std::move(value), std::move(limit), std::move(advice));
}

std::uint64_t LineReader::count(std::string_view field) const {
  field = without_blanks(field);
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
  if (error != std::errc() || end != field.data() + field.size())
    fail("not a whole number of 0 or more", std::string(field.substr(0, 40)));
  return number;
}

double LineReader::real(std::string_view field) const {
  field = without_blanks(field);
  if (field.empty()) return 0;
  if (field.front() == '+') field.remove_prefix(1);
  const std::optional<double> value = read_number(field);
  if (!value) fail("not a number", std::string(field.substr(0, 40)));
  return *value;
}

std::string_view LineReader::field(std::size_t column, std::size_t width) const {
  return column >= line_.size() ? std::string_view{} : line_.substr(column, width);
}

std::string_view without_blanks(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  for (std::size_t i = 0; i < line.size();) {
    if (is_blank(line[i])) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < line.size() && !is_blank(line[end])) ++end;
    words.push_back(line.substr(i, end - i));
    i = end;
  }
  return words;
}

std::string upper_case(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return result;
}

}  // namespace scan2fea
