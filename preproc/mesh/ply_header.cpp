#include "preproc/mesh/ply_header.hpp"

#include "preproc/mesh/text_scanner.hpp"
#include "preproc/mesh/truncated.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace scan2fea {
namespace {

// Both the names of the first PLY files and those that tell the size.
constexpr std::array<std::pair<std::string_view, PlyType>, 16> type_names{{
    {"char", PlyType::int8},
    {"uchar", PlyType::uint8},
    {"short", PlyType::int16},
    {"ushort", PlyType::uint16},
    {"int", PlyType::int32},
    {"uint", PlyType::uint32},
    {"float", PlyType::float32},
    {"double", PlyType::float64},
    {"int8", PlyType::int8},
    {"uint8", PlyType::uint8},
    {"int16", PlyType::int16},
    {"uint16", PlyType::uint16},
    {"int32", PlyType::int32},
    {"uint32", PlyType::uint32},
    {"float32", PlyType::float32},
    {"float64", PlyType::float64},
}};

constexpr std::array<std::pair<std::string_view, PlyFormat>, 3> format_names{{
    {"ascii", PlyFormat::ascii},
    {"binary_little_endian", PlyFormat::binary_little_endian},
    {"binary_big_endian", PlyFormat::binary_big_endian},
}};

std::string quotation(std::string_view word) {
  return std::string(word.substr(0, 40));
}

template <class Names>
auto named(TextScanner& line, const Names& names, const char* what) {
  line.skip_blanks();
  const char* start = line.position();
  const std::string_view word = line.word();
  const auto found = std::ranges::find(names, word, [](const auto& entry) { return entry.first; });
  if (found == names.end()) line.fail(start, what, quotation(word));
  return found->second;
}

PlyElement read_element(TextScanner& line) {
  PlyElement element;
  element.declared_at = line.position();
  element.name = line.word();
  line.skip_blanks();
  const char* start = line.position();
  const std::int64_t count = line.integer();
  if (count < 0) line.fail(start, "the number of elements is negative", std::to_string(count), "0");
  element.count = static_cast<std::uint64_t>(count);
  return element;
}

PlyProperty read_property(TextScanner& line) {
  constexpr const char* unknown_type = "not a type of PLY";
  PlyProperty property;
  TextScanner ahead = line;
  if (ahead.word() == "list") {
    line = ahead;
    line.skip_blanks();
    const char* start = line.position();
    property.count_type = named(line, type_names, unknown_type);
    if (!is_integer(*property.count_type)) line.fail(start, "the length of a list is not a whole number");
  }
  property.type = named(line, type_names, unknown_type);
  property.name = line.word();
  return property;
}

// Where the body begins, `at` being the line break of the header's last line. Where lines end with CR alone, an LF
// behind it is the body's first byte.
const char* body_after(const InputFile& file, const char* at) {
  const std::string_view bytes = file.bytes();
  const std::size_t first = bytes.find_first_of("\r\n");
  const bool cr_alone = bytes.substr(first, 1) == "\r" && bytes.substr(first, 2) != "\r\n";
  const std::string_view rest = bytes.substr(static_cast<std::size_t>(at - bytes.data()));
  const std::size_t line_break = rest.starts_with("\r\n") && !cr_alone ? 2 : 1;
  return at + std::min(line_break, rest.size());
}

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      return 8;
  }
  return 8;
}

PlyHeader read_ply_header(const InputFile& file) {
  TextScanner line(file);
  if (line.word() != "ply") file.fail_at_line(file.bytes().data(), "a PLY file begins with \"ply\"");
  PlyHeader header;
  bool has_format = false;
  for (line.skip_line(); line.skip_space(); line.skip_line()) {
    const char* start = line.position();
    const std::string_view keyword = line.word();
    if (keyword == "end_header") {
      if (!has_format) line.fail(start, "the header names no format");
      line.skip_blanks();
      header.body = body_after(file, line.position());
      return header;
    }
    if (keyword == "format") {
      header.format = named(line, format_names, "not a format of PLY");
      has_format = true;
    } else if (keyword == "element") {
      line.skip_blanks();
      header.elements.push_back(read_element(line));
    } else if (keyword == "property") {
      if (header.elements.empty()) line.fail(start, "a property stands before any element");
      header.elements.back().properties.push_back(read_property(line));
    } else if (keyword != "comment" && keyword != "obj_info") {
      line.fail(start, "not a keyword of a PLY header", quotation(keyword));
    }
  }
  line.fail(line.position(), "the file ends inside its header", {}, {}, truncated_advice);
}

}  // namespace scan2fea
