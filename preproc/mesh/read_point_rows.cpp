#include "preproc/mesh/cloud_formats.hpp"
#include "preproc/mesh/truncated.hpp"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace scan2fea {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t shortest_row = std::string_view("0 0 0\n").size();

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

std::string quotation(std::string_view text) {
  return std::string(text.substr(0, 40));
}

// The lines of a file without their ends and the blanks about them; LF, CR LF or CR alone.
class Lines {
 public:
  explicit Lines(std::string_view bytes) : rest_(bytes) {
    if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
    const std::size_t first = rest_.find_first_of("\r\n");
    end_ = first != std::string_view::npos && rest_[first] == '\r' && rest_.substr(first, 2) != "\r\n" ? '\r' : '\n';
  }

  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    const std::size_t at = rest_.find(end_);
    line = rest_.substr(0, at);
    rest_.remove_prefix(at == std::string_view::npos ? rest_.size() : at + 1);
    while (!line.empty() && (is_blank(line.back()) || line.back() == '\r' || line.back() == '\0'))
      line.remove_suffix(1);
    while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
    return true;
  }
  std::size_t bytes_left() const { return rest_.size(); }

 private:
  std::string_view rest_;
  char end_;
};

bool is_comment(std::string_view line) {
  return line.empty() || line.front() == '#' || line.front() == '%' || line.front() == '!' || line.starts_with("//");
}

// The words of a line, `separator` being ' ' where blanks alone part them.
template <class Visit>
void for_each_word(std::string_view line, char separator, const Visit& visit) {
  const auto trimmed = [](std::string_view word) {
    while (!word.empty() && (is_blank(word.front()) || word.front() == '"')) word.remove_prefix(1);
    while (!word.empty() && (is_blank(word.back()) || word.back() == '"')) word.remove_suffix(1);
    return word;
  };
  for (std::size_t at = 0; at < line.size();) {
    std::size_t end = at;
    if (separator == ' ') {
      while (at < line.size() && is_blank(line[at])) ++at;
      for (end = at; end < line.size() && !is_blank(line[end]);) ++end;
    } else {
      end = std::min(line.find(separator, at), line.size());
    }
    if (!visit(trimmed(line.substr(at, end - at)))) return;
    at = end + 1;
  }
}

std::optional<double> number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [last, error] = fast_float::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || last != word.data() + word.size()) return std::nullopt;
  return value;
}

// Which column holds what. More than these are passed over.
constexpr std::size_t most_columns = 16;
using Row = std::array<double, most_columns>;
struct Columns {
  std::array<std::size_t, 3> place{0, 1, 2};
  std::optional<std::array<std::size_t, 3>> normal, scanner;
  bool named = false;
};

// "x", "//X", "Points:0", "nx", "Normal_X", "X [mm]", "scanner_x": which axis of what is meant.
enum class Vector : char { place, normal, scanner };
struct Meaning {
  Vector of;
  std::size_t axis = 0;
};
std::optional<Meaning> meaning(std::string_view word) {
  std::string name;
  for (const char c : word.substr(0, word.find_first_of("[(")))
    if ((c >= 'a' && c <= 'z') || is_digit(c))
      name += c;
    else if (c >= 'A' && c <= 'Z')
      name += static_cast<char>(c - 'A' + 'a');
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string letter(1, static_cast<char>('x' + axis)), digit(1, static_cast<char>('0' + axis));
    if (name == letter || name == "points" + digit || name == "coord" + letter) return Meaning{Vector::place, axis};
    if (name == "n" + letter || name == "normal" + letter || name == "normals" + digit)
      return Meaning{Vector::normal, axis};
    if (name == "scanner" + letter || name == "viewpoint" + letter || name == "vp" + letter)
      return Meaning{Vector::scanner, axis};
  }
  return std::nullopt;
}

class RowReader {
 public:
  explicit RowReader(const InputFile& file) : file_(file), lines_(file.bytes()) {}

  PointCloud run() {
    std::string_view line;
    while (lines_.next(line)) {
      if (!is_comment(line))
        take(line);
      else if (!take_scanner(line) && cloud_.points.empty() && !columns_.named)
        take_names(line, true);
    }
    end_block(file_.bytes().data() + file_.bytes().size());
    if (!columns_.named) columns_.normal = normal_columns();
    take_normals();
    return std::move(cloud_);
  }

 private:
  void take(std::string_view line) {
    if (separator_ == '\0') {
      if (take_count(line)) return;
      separator_ = separator_of(line);
      if (cloud_.points.empty() && !columns_.named && !titled_ && take_names(line, false)) return;
    } else if (take_count(line)) {
      return;
    }
    Row row;
    row.fill(no_number);
    std::size_t column = 0;
    for_each_word(line, separator_, [&](std::string_view word) {
      const std::optional<double> value = number(word);
      if (value) row[column] = *value;
      if (is_place(column) && !(value && std::isfinite(*value))) fail_number(word);
      return ++column < most_columns;
    });
    if (column <= *std::ranges::max_element(columns_.place))
      file_.fail_at_line(line.data(), "a coordinate is missing", quotation(line), "x y z");
    if (cloud_.points.size() == std::numeric_limits<std::uint32_t>::max())
      file_.fail_at_line(line.data(), "too many points", {}, std::to_string(cloud_.points.size()));
    cloud_.points.emplace_back(row[columns_.place[0]], row[columns_.place[1]], row[columns_.place[2]]);
    if (cloud_.points.size() == 1) width_ = std::min(column, most_columns);
    for (std::size_t k = 3; k < width_ && !columns_.named; ++k) others_.push_back(static_cast<float>(row[k]));
    const auto vector = [&](const std::array<std::size_t, 3>& at) { return Vec3(row[at[0]], row[at[1]], row[at[2]]); };
    if (columns_.named && columns_.normal) cloud_.normals.push_back(direction(vector(*columns_.normal)));
    if (!columns_.scanner && !scanner_) return;
    cloud_.scanners.resize(cloud_.points.size() - 1, Vec3::Constant(no_number));
    cloud_.scanners.push_back(columns_.scanner ? vector(*columns_.scanner) : *scanner_);
  }

  // "# scanner x y z": of the points that follow.
  bool take_scanner(std::string_view line) {
    line.remove_prefix(std::min(line.find_first_not_of("#/%! \t"), line.size()));
    constexpr std::string_view name = "scanner";
    if (!line.starts_with(name)) return false;
    line.remove_prefix(std::min(line.find_first_not_of(": \t", name.size()), line.size()));
    std::vector<double> values;
    for_each_word(line, separator_of(line), [&](std::string_view word) {
      values.push_back(number(word).value_or(no_number));
      return true;
    });
    if (values.size() != 3 || !std::ranges::all_of(values, [](double v) { return std::isfinite(v); })) return false;
    scanner_ = Vec3(values[0], values[1], values[2]);
    return true;
  }

  bool is_place(std::size_t column) const { return std::ranges::find(columns_.place, column) != columns_.place.end(); }

  // A number alone on its line.
  bool take_count(std::string_view line) {
    if (line.find_first_of(" \t,;") != std::string_view::npos) return false;
    const std::optional<double> count = number(line);
    if (!count) return false;
    const double most = static_cast<double>((lines_.bytes_left() + 1) / shortest_row);
    if (!(*count >= 0 && *count <= most && *count == std::floor(*count)))
      file_.fail_at_line(line.data(), "the header promises more points than the file can hold", quotation(line),
                         std::to_string(static_cast<std::size_t>(most)), truncated_advice);
    end_block(line.data());
    promised_ = cloud_.points.size() + static_cast<std::size_t>(*count);
    return true;
  }

  void end_block(const char* at) {
    if (promised_ && *promised_ > cloud_.points.size())
      file_.fail_at_line(at, "points are missing that the header promises", std::to_string(cloud_.points.size()),
                         std::to_string(*promised_), truncated_advice);
  }

  // A comma between digits that blanks or semicolons part from the next number is a decimal comma.
  char separator_of(std::string_view line) const {
    if (line.find(';') != std::string_view::npos) return ';';
    if (line.find(',') == std::string_view::npos) return ' ';
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
      if (!is_blank(line[i]) || is_blank(line[i - 1])) continue;
      std::size_t next = i;
      while (is_blank(line[next])) ++next;
      if (line[i - 1] != ',' && line[next] != ',' && is_digit(line[i - 1])) return ' ';
    }
    return ',';
  }

  // Of a first line whose words are no numbers, or of a comment. What names no axis is a title.
  bool take_names(std::string_view line, bool is_comment) {
    line.remove_prefix(is_comment ? std::min(line.find_first_not_of("#/%! \t"), line.size()) : 0);
    std::size_t column = 0, names = 0;
    std::array<std::size_t, 3> count{};
    std::array<std::array<std::size_t, 3>, 3> at{};
    for_each_word(line, separator_of(line), [&](std::string_view word) {
      names += column < 3 && !word.empty() && !number(word) && is_letter(word.front());
      if (const auto what = meaning(word)) {
        const auto of = static_cast<std::size_t>(what->of);
        at[of][what->axis] = column;
        ++count[of];
      }
      return ++column < most_columns;
    });
    const std::size_t places = count[0];
    if (is_comment ? places != 3 : names == 0 || names < std::min<std::size_t>(3, column)) return false;
    if (places != 0 && places != 3)
      file_.fail_at_line(line.data(), "the header names no columns x, y and z, once each", quotation(line));
    (places == 3 ? columns_.named : titled_) = true;
    if (places == 3) {
      columns_.place = at[0];
      if (count[1] == 3) columns_.normal = at[1];
      if (count[2] == 3) columns_.scanner = at[2];
    }
    separator_ = '\0';  // the rows tell theirs
    return true;
  }

  // The first three neighbouring columns behind the place that are of unit length in all rows but a few, which may lack
  // a normal. Colours in [0, 1] are that by chance in single rows only.
  std::optional<std::array<std::size_t, 3>> normal_columns() const {
    constexpr double tolerance = 0.02, largest_share_of_others = 0.05;
    if (width_ < 6 || cloud_.points.size() * (width_ - 3) != others_.size()) return std::nullopt;
    const std::size_t rows = cloud_.points.size();
    for (std::size_t first = 0; first + 3 <= width_ - 3; ++first) {
      std::size_t others = 0;
      for (std::size_t r = 0; r < rows; ++r) {
        const float* v = &others_[r * (width_ - 3) + first];
        const double length = std::sqrt(double(v[0]) * v[0] + double(v[1]) * v[1] + double(v[2]) * v[2]);
        others += !(std::abs(length - 1) < tolerance);
      }
      if (static_cast<double>(others) <= largest_share_of_others * static_cast<double>(rows))
        return std::array{first, first + 1, first + 2};
    }
    return std::nullopt;
  }

  void take_normals() {
    if (columns_.named || !columns_.normal) return;
    for (std::size_t r = 0; r < cloud_.points.size(); ++r) {
      const float* v = &others_[r * (width_ - 3) + (*columns_.normal)[0]];
      cloud_.normals.push_back(direction({v[0], v[1], v[2]}));
    }
  }

  [[noreturn]] void fail_number(std::string_view word) const {
    const std::size_t comma = word.find(',');
    if (comma != std::string_view::npos && comma > 0 && comma + 1 < word.size() && is_digit(word[comma - 1]) &&
        is_digit(word[comma + 1]))
      file_.fail_at_line(word.data(), "not a finite number", quotation(word), "a decimal point, not a decimal comma",
                         "an export under a locale with decimal points, LC_NUMERIC=C");
    file_.fail_at_line(word.data(), word.empty() ? "a finite number is missing" : "not a finite number",
                       quotation(word));
  }

  const InputFile& file_;
  Lines lines_;
  PointCloud cloud_;
  Columns columns_;
  bool titled_ = false;
  char separator_ = '\0';  // not known yet
  std::optional<std::size_t> promised_;
  std::optional<Vec3> scanner_;  // that a comment told
  std::size_t width_ = 0;        // columns of the first row
  std::vector<float> others_;    // of each row, the columns behind the place: enough to tell normals by
};

}  // namespace

PointCloud read_point_rows(const InputFile& file) {
  return RowReader(file).run();
}

}  // namespace scan2fea
