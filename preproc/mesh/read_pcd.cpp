#include "preproc/mesh/byte_order.hpp"
#include "preproc/mesh/cloud_formats.hpp"
#include "preproc/mesh/lzf.hpp"
#include "preproc/mesh/text_scanner.hpp"
#include "preproc/mesh/truncated.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace scan2fea {
namespace {

struct Field {
  std::string name;
  std::size_t size = 4;
  char type = 'F';
  std::size_t count = 1;
  std::size_t bytes() const { return size * count; }
};

enum class PcdData { ascii, binary, binary_compressed };

struct PcdHeader {
  std::vector<Field> fields;
  std::uint64_t points = 0;
  std::optional<Vec3> scanner;
  PcdData data = PcdData::ascii;
  const char* counted_at = nullptr;
  const char* body = nullptr;
};

class HeaderReader {
 public:
  explicit HeaderReader(const InputFile& file) : line_(file) {}

  PcdHeader run() {
    for (; line_.skip_space(); line_.skip_line()) {
      start_ = line_.position();
      const std::string_view keyword = line_.word();
      if (keyword == "DATA") return finish();
      if (keyword == "FIELDS" || keyword == "COLUMNS") {
        while (line_.skip_blanks()) header_.fields.push_back({.name = std::string(line_.word())});
      } else if (keyword == "SIZE" || keyword == "COUNT" || keyword == "TYPE") {
        for (Field& field : header_.fields) read_of_field(keyword, field);
      } else if (keyword == "WIDTH" || keyword == "HEIGHT" || keyword == "POINTS") {
        read_number_of_points(keyword);
      } else if (keyword == "VIEWPOINT") {
        header_.scanner = line_.point();
      } else if (keyword != "VERSION") {
        line_.fail(start_, "not a keyword of a PCD header", std::string(keyword.substr(0, 40)));
      }
    }
    line_.fail(line_.position(), "the file ends inside its header", {}, {}, truncated_advice);
  }

 private:
  void read_of_field(std::string_view keyword, Field& field) {
    line_.skip_blanks();
    const char* at = line_.position();
    if (keyword == "TYPE") {
      const std::string_view type = line_.word();
      if (type != "F" && type != "I" && type != "U")
        line_.fail(at, "not a type of PCD", std::string(type.substr(0, 40)), "F, I, U");
      field.type = type[0];
      return;
    }
    const std::int64_t value = line_.integer();
    const bool is_size = keyword == "SIZE";
    const bool is_known = is_size ? value == 1 || value == 2 || value == 4 || value == 8 : value >= 0 && value < 65536;
    if (!is_known)
      line_.fail(at, is_size ? "not a size of a PCD field" : "not a count of PCD values", std::to_string(value),
                 is_size ? "1, 2, 4, 8" : "0 to 65535");
    (is_size ? field.size : field.count) = static_cast<std::size_t>(value);
  }

  void read_number_of_points(std::string_view keyword) {
    line_.skip_blanks();
    const char* at = line_.position();
    const std::int64_t value = line_.integer();
    constexpr std::int64_t most = std::numeric_limits<std::uint32_t>::max();
    if (value < 0 || value > most)
      line_.fail(at, "the header promises more points than the file can hold", std::to_string(value),
                 std::to_string(most), truncated_advice);
    header_.counted_at = at;
    const auto count = static_cast<std::uint64_t>(value);
    if (keyword == "POINTS")
      points_ = count;
    else
      (keyword == "WIDTH" ? width_ : height_) = count;
  }

  PcdHeader finish() {
    line_.skip_blanks();
    const char* at = line_.position();
    const std::string_view data = line_.word();
    if (data == "binary")
      header_.data = PcdData::binary;
    else if (data == "binary_compressed")
      header_.data = PcdData::binary_compressed;
    else if (data != "ascii")
      line_.fail(at, "not a kind of PCD data", std::string(data.substr(0, 40)), "ascii, binary, binary_compressed");
    if (header_.counted_at == nullptr) line_.fail(start_, "the header tells no number of points");
    header_.points = points_ ? *points_ : width_ * height_;
    line_.skip_line();
    header_.body = line_.position();
    for (const char* axis : {"x", "y", "z"}) {
      const auto field = std::ranges::find(header_.fields, axis, &Field::name);
      if (field == header_.fields.end() || field->count != 1) line_.fail(start_, "the points lack a coordinate", axis);
    }
    return std::move(header_);
  }

  TextScanner line_;
  PcdHeader header_;
  const char* start_ = nullptr;
  std::uint64_t width_ = 0, height_ = 1;
  std::optional<std::uint64_t> points_;
};

// The six fields that matter: x, y, z and the normal's.
constexpr std::array<std::string_view, 6> wanted{"x", "y", "z", "normal_x", "normal_y", "normal_z"};

double value_at(const char* at, const Field& field) {
  constexpr std::endian little = std::endian::little;
  const auto whole = [&]<class Signed, class Unsigned>(Signed, Unsigned) {
    return field.type == 'I' ? static_cast<double>(load<Signed>(at, little))
                             : static_cast<double>(load<Unsigned>(at, little));
  };
  if (field.type == 'F' && field.size == 8) return load<double>(at, little);
  if (field.type == 'F' && field.size == 4) return static_cast<double>(load<float>(at, little));
  switch (field.size) {
    case 1:
      return whole(std::int8_t{}, std::uint8_t{});
    case 2:
      return whole(std::int16_t{}, std::uint16_t{});
    case 4:
      return whole(std::int32_t{}, std::uint32_t{});
    default:
      return whole(std::int64_t{}, std::uint64_t{});
  }
}

class PcdReader {
 public:
  PcdReader(const InputFile& file, PcdHeader header) : file_(file), header_(std::move(header)) {
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      const auto found = std::ranges::find(header_.fields, wanted[k], &Field::name);
      if (found != header_.fields.end() && found->count > 0)
        field_[k] = static_cast<std::size_t>(found - header_.fields.begin());
    }
    has_normals_ = field_[3] && field_[4] && field_[5];
    for (const Field& field : header_.fields) row_bytes_ += field.bytes();
  }

  PointCloud run() {
    switch (header_.data) {
      case PcdData::ascii:
        read_text();
        break;
      case PcdData::binary:
        check_promise(static_cast<std::uint64_t>(end() - header_.body) / row_bytes_);
        read_binary(header_.body, true);
        break;
      case PcdData::binary_compressed:
        read_compressed();
    }
    if (header_.scanner && !cloud_.points.empty()) cloud_.scanners = {*header_.scanner};
    return std::move(cloud_);
  }

 private:
  const char* end() const { return file_.bytes().data() + file_.bytes().size(); }

  void check_promise(std::uint64_t most) const {
    if (header_.points > most)
      file_.fail_at_line(header_.counted_at, "the header promises more points than the file can hold",
                         std::to_string(header_.points), std::to_string(most), truncated_advice);
  }

  void add(const std::array<double, 6>& value) {
    const Vec3 p(value[0], value[1], value[2]);
    if (!p.allFinite()) {
      ++cloud_.left_out;
      return;
    }
    cloud_.points.push_back(p);
    if (has_normals_) cloud_.normals.push_back(direction({value[3], value[4], value[5]}));
  }

  void read_text() {
    TextScanner scanner(file_, header_.body);
    std::size_t values = 0;
    for (const Field& field : header_.fields) values += field.count;
    check_promise((scanner.bytes_left() + 1) / (2 * values));  // a digit and a blank
    for (std::uint64_t i = 0; i < header_.points; ++i, scanner.skip_line()) {
      if (!scanner.skip_space())
        scanner.fail(scanner.position(), "points are missing that the header promises", std::to_string(i),
                     std::to_string(header_.points), truncated_advice);
      std::array<double, 6> value{};
      for (std::size_t f = 0; f < header_.fields.size(); ++f)
        for (std::size_t c = 0; c < header_.fields[f].count; ++c) {
          TextScanner ahead = scanner;
          const std::string_view word = ahead.word();
          const auto k = std::ranges::find(field_, std::optional(f));
          const bool is_no_return = is_keyword(word, "nan") || is_keyword(word, "-nan");
          if (k == field_.end() || is_no_return) {
            if (k != field_.end()) value[static_cast<std::size_t>(k - field_.begin())] = std::nan("");
            scanner = ahead;
          } else {
            value[static_cast<std::size_t>(k - field_.begin())] = scanner.number();
          }
        }
      add(value);
    }
  }

  // Point by point, or field by field.
  void read_binary(const char* data, bool by_points) {
    std::vector<std::size_t> offset;
    std::size_t sum = 0;
    for (const Field& field : header_.fields) {
      offset.push_back(by_points ? sum : sum * header_.points);
      sum += field.bytes();
    }
    for (std::uint64_t i = 0; i < header_.points; ++i) {
      std::array<double, 6> value{};
      for (std::size_t k = 0; k < wanted.size(); ++k) {
        if (!field_[k]) continue;
        const Field& field = header_.fields[*field_[k]];
        value[k] = value_at(data + offset[*field_[k]] + i * (by_points ? row_bytes_ : field.bytes()), field);
      }
      add(value);
    }
  }

  void read_compressed() {
    const auto left = static_cast<std::size_t>(end() - header_.body);
    if (left < 8) file_.fail_at_byte(header_.body, "the file ends before its data", {}, {}, truncated_advice);
    const std::size_t compressed = load<std::uint32_t>(header_.body, std::endian::little),
                      size = load<std::uint32_t>(header_.body + 4, std::endian::little);
    if (compressed > left - 8)
      file_.fail_at_byte(header_.body, "the file ends inside its data", std::to_string(left - 8),
                         std::to_string(compressed), truncated_advice);
    check_promise(size / row_bytes_);
    const auto data = lzf_decompressed({header_.body + 8, compressed}, size);
    if (!data) file_.fail_at_byte(header_.body + 8, "the compressed data are damaged", {}, {}, truncated_advice);
    read_binary(data->data(), false);
  }

  const InputFile& file_;
  PcdHeader header_;
  std::array<std::optional<std::size_t>, 6> field_;
  bool has_normals_ = false;
  std::size_t row_bytes_ = 0;
  PointCloud cloud_;
};

}  // namespace

bool is_pcd(const InputFile& file) {
  TextScanner scanner(file);
  if (!scanner.skip_space()) return false;
  const std::string_view first = scanner.word();
  return first == "VERSION" && scanner.skip_space() && !scanner.word().empty() && scanner.skip_space() &&
         (scanner.word() == "FIELDS");
}

PointCloud read_pcd(const InputFile& file) {
  return PcdReader(file, HeaderReader(file).run()).run();
}

}  // namespace scan2fea
