#include "export/inp.hpp"
#include "export/raw_mesh.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/input_file.hpp"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <optional>

namespace scan2fea {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

std::string upper_without_spaces(std::string_view text) {
  std::string upper;
  for (const char c : text)
    if (c != ' ' && c != '\t' && c != '\r') upper += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return upper;
}

// Gives the lines of a deck that are not comments, and the fields of a line.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  bool next() {
    while (!rest_.empty()) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      line_ = trimmed(rest_.substr(0, end));
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++number_;
      if (!line_.empty() && !line_.starts_with("**")) return true;
    }
    return false;
  }

  std::size_t number() const { return number_; }
  std::string_view line() const { return line_; }
  bool is_keyword() const { return line_.starts_with('*'); }

  // Takes the next field off the line; nothing after the last. A trailing comma starts no field.
  std::optional<std::string_view> field() {
    if (line_.empty()) return {};
    const std::size_t comma = std::min(line_.find(','), line_.size());
    const std::string_view field = trimmed(line_.substr(0, comma));
    line_.remove_prefix(std::min(comma + 1, line_.size()));
    line_ = trimmed(line_);
    return field;
  }

 private:
  std::string_view rest_;
  std::string_view line_;
  std::size_t number_ = 0;
};

struct Keyword {
  std::string name;                               // "*NODE", upper case and without spaces
  std::map<std::string, std::string> parameters;  // "TYPE" -> "C3D4", likewise
};

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file), lines_(file_.bytes()) {}

  TetMesh read() {
    bool more = lines_.next();
    while (more) {
      if (!lines_.is_keyword()) {  // data of a keyword that is passed over
        more = lines_.next();
        continue;
      }
      const Keyword keyword = read_keyword();
      if (keyword.name == "*NODE")
        more = read_nodes();
      else if (keyword.name == "*ELEMENT")
        more = read_elements(keyword);
      else {
        if (keyword.name == "*INCLUDE") includes_ = true;
        more = lines_.next();
      }
    }
    if (raw_.corners.empty())
      fail("holds no tetrahedra", file_.path().string(), {}, includes_ ? "the file that its *INCLUDE names" : "");
    return assemble(
        raw_, file_.path(), [&](std::size_t n) { return place(node_lines_[n]); },
        [&](std::size_t e) { return place(element_lines_[e]); });
  }

 private:
  std::string place(std::size_t line) const { return file_.path().string() + ":" + std::to_string(line); }

  [[noreturn]] static void fail(std::string what, std::string where, std::string value = {}, std::string advice = {}) {
    throw InvalidInput({.what = std::move(what),
                        .where = std::move(where),
                        .value = std::move(value),
                        .limit = {},
                        .advice = std::move(advice)});
  }

  Keyword read_keyword() {
    Keyword keyword;
    for (;;) {
      const bool continues = lines_.line().ends_with(',');
      while (const auto field = lines_.field()) {
        const std::string text = upper_without_spaces(*field);
        const std::size_t equals = std::min(text.find('='), text.size());
        if (keyword.name.empty())
          keyword.name = text;
        else
          keyword.parameters[text.substr(0, equals)] = text.substr(std::min(equals + 1, text.size()));
      }
      if (!continues || !lines_.next()) return keyword;
    }
  }

  std::uint64_t read_number(std::string_view field) const {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
    if (error != std::errc() || end != field.data() + field.size() || number == 0)
      fail("not a node or element number", place(lines_.number()), std::string(field));
    return number;
  }

  double read_coordinate(std::string_view field) const {
    if (field.empty()) return 0;  // as Abaqus reads a blank field
    if (field.front() == '+') field.remove_prefix(1);
    double value = 0;
    const auto [end, error] = fast_float::from_chars(field.data(), field.data() + field.size(), value);
    if (error == std::errc() && end == field.data() + field.size()) return value;
    // Fortran programs write 1.0D-05.
    std::string text(field);
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == 'd' || c == 'D'; }, 'e');
    const auto second = fast_float::from_chars(text.data(), text.data() + text.size(), value);
    if (second.ec != std::errc() || second.ptr != text.data() + text.size())
      fail("not a number", place(lines_.number()), std::string(field));
    return value;
  }

  // Both return whether a keyword line follows.
  bool read_nodes() {
    while (lines_.next()) {
      if (lines_.is_keyword()) return true;
      raw_.node_numbers.push_back(read_number(lines_.field().value_or("")));
      Vec3 p = Vec3::Zero();
      for (int k = 0; k < 3; ++k)
        if (const auto field = lines_.field()) p[k] = read_coordinate(*field);
      raw_.nodes.push_back(p);
      node_lines_.push_back(lines_.number());
    }
    return false;
  }

  bool read_elements(const Keyword& keyword) {
    const std::size_t keyword_line = lines_.number();
    const auto it = keyword.parameters.find("TYPE");
    if (it == keyword.parameters.end()) fail("*ELEMENT without TYPE", place(keyword_line));
    std::string type = it->second;
    if (type.starts_with("DC3D")) type.erase(0, 1);
    const bool quadratic = type.starts_with("C3D10");
    if (!quadratic && (!type.starts_with("C3D4"))) {
      if (type.starts_with("C3D"))
        fail("elements are not tetrahedra", place(keyword_line), it->second, "a mesh of C3D4 or of C3D10 elements");
      return lines_.next();  // lines, surfaces, springs, masses
    }
    if (!raw_.corners.empty() && quadratic == raw_.mid_edges.empty())
      fail("tetrahedra of first and of second order in one mesh", place(keyword_line), it->second);
    const std::size_t nodes = quadratic ? 10 : 4;
    while (lines_.next()) {
      if (lines_.is_keyword()) return true;
      element_lines_.push_back(lines_.number());
      read_number(lines_.field().value_or(""));
      for (std::size_t i = 0; i < nodes; ++i) {
        auto field = lines_.field();
        if (!field) {  // continued on the next line
          if (!lines_.next() || lines_.is_keyword())
            fail("element has too few nodes", place(element_lines_.back()),
                 std::to_string(i) + " of " + std::to_string(nodes));
          field = lines_.field();
        }
        (i < 4 ? raw_.corners : raw_.mid_edges).push_back(read_number(*field));
      }
    }
    return false;
  }

  InputFile file_;
  Lines lines_;
  RawMesh raw_;
  std::vector<std::size_t> node_lines_, element_lines_;
  bool includes_ = false;
};

}  // namespace

TetMesh read_inp(const std::filesystem::path& file) {
  return Reader(file).read();
}

}  // namespace scan2fea
