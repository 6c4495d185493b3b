#include "export/inp.hpp"
#include "export/raw_mesh.hpp"
#include "export/raw_sets.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/input_file.hpp"
#include "preproc/mesh/unit_comment.hpp"

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
      if (line_.starts_with("**")) {
        if (const auto unit = unit_in_comment(line_)) unit_ = *unit;
        continue;
      }
      if (!line_.empty()) return true;
    }
    return false;
  }

  std::size_t number() const { return number_; }
  std::string_view line() const { return line_; }
  const std::string& unit() const { return unit_; }  // of the comments so far
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
  std::string unit_;
  std::size_t number_ = 0;
};

struct Keyword {
  std::string name;                               // "*NODE", upper case and without spaces
  std::map<std::string, std::string> parameters;  // "TYPE" -> "C3D4", likewise
};

// The members of a set. A set that names sets may repeat their members without end, so that repeated ones are dropped
// whenever there are twice as many.
class Members {
 public:
  void add(const std::vector<std::uint64_t>& more) {
    members_.insert(members_.end(), more.begin(), more.end());
    if (members_.size() > 2 * different_ + 1000) drop_repeated();
  }
  std::vector<std::uint64_t> take() {
    drop_repeated();
    return std::move(members_);
  }

 private:
  void drop_repeated() {
    std::sort(members_.begin(), members_.end());
    members_.erase(std::unique(members_.begin(), members_.end()), members_.end());
    different_ = members_.size();
  }

  std::vector<std::uint64_t> members_;
  std::size_t different_ = 0;
};

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file), lines_(file_.bytes()) {}

  MeshFile read() {
    bool more = lines_.next();
    while (more) {
      if (!lines_.is_keyword()) {  // data of a keyword that is passed over
        more = lines_.next();
        continue;
      }
      const Keyword keyword = read_keyword();
      if (keyword.name == "*NODE")
        more = read_nodes(keyword);
      else if (keyword.name == "*ELEMENT")
        more = read_elements(keyword);
      else if (keyword.name == "*NSET")
        more = read_set(keyword, "NSET", raw_.node_sets);
      else if (keyword.name == "*ELSET")
        more = read_set(keyword, "ELSET", raw_.element_sets);
      else if (keyword.name == "*SURFACE")
        more = read_surface(keyword);
      else {
        if (keyword.name == "*INCLUDE") includes_ = true;
        more = lines_.next();
      }
    }
    if (raw_.corners.empty() && raw_.triangles.empty())
      fail("holds no tetrahedra and no triangles", file_.path().string(), {},
           includes_ ? "the file that its *INCLUDE names" : "");
    raw_.unit = lines_.unit();
    drop_parts_of_surfaces();
    const std::vector<std::size_t>& lines = raw_.corners.empty() ? triangle_lines_ : element_lines_;
    raw_.has_own_numbers = true;
    MeshFile read = assemble(
        raw_, file_.path(), [&](std::size_t n) { return place(node_lines_[n]); },
        [&](std::size_t e) { return place(lines[e]); });
    if (auto* mesh = std::get_if<TetMesh>(&read.mesh)) drop_nodes_of_face_sets(*mesh, "_NODES");
    return read;
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

  // All of these return whether a keyword line follows.
  bool read_nodes(const Keyword& keyword) {
    const std::size_t first = raw_.node_numbers.size();
    bool more = false;
    while (!more && lines_.next()) {
      more = lines_.is_keyword();
      if (more) break;
      raw_.node_numbers.push_back(read_number(lines_.field().value_or("")));
      Vec3 p = Vec3::Zero();
      for (int k = 0; k < 3; ++k)
        if (const auto field = lines_.field()) p[k] = read_coordinate(*field);
      raw_.nodes.push_back(p);
      node_lines_.push_back(lines_.number());
    }
    add_to_set(keyword, "NSET", raw_.node_sets, raw_.node_numbers, first);
    return more;
  }

  static void add_to_set(const Keyword& keyword, const char* parameter, std::vector<RawSet>& sets,
                         const std::vector<std::uint64_t>& numbers, std::size_t first) {
    const auto name = keyword.parameters.find(parameter);
    if (name == keyword.parameters.end() || name->second.empty()) return;
    auto& members = members_of(sets, name->second);
    members.insert(members.end(), numbers.begin() + static_cast<std::ptrdiff_t>(first), numbers.end());
  }

  bool read_elements(const Keyword& keyword) {
    const std::size_t keyword_line = lines_.number();
    const auto it = keyword.parameters.find("TYPE");
    if (it == keyword.parameters.end()) fail("*ELEMENT without TYPE", place(keyword_line));
    std::string type = it->second;
    if (type.starts_with("DC3D")) type.erase(0, 1);
    if (const std::size_t nodes = nodes_of_triangle(type)) return read_triangles(keyword, nodes);
    const bool quadratic = type.starts_with("C3D10");
    if (!quadratic && (!type.starts_with("C3D4"))) {
      if (type.starts_with("C3D"))
        fail("elements are not tetrahedra", place(keyword_line), it->second, "a mesh of C3D4 or of C3D10 elements");
      return pass_over_elements();
    }
    if (raw_.has_other_order(quadratic)) fail(mixed_orders, place(keyword_line), it->second);
    const std::size_t first = raw_.tetrahedron_numbers.size();
    const bool more =
        read_data(quadratic ? 10 : 4, raw_.tetrahedron_numbers, element_lines_,
                  [&](std::size_t i, std::uint64_t node) { (i < 4 ? raw_.corners : raw_.mid_edges).push_back(node); });
    add_to_set(keyword, "ELSET", raw_.element_sets, raw_.tetrahedron_numbers, first);
    return more;
  }

  bool read_triangles(const Keyword& keyword, std::size_t nodes) {
    const std::size_t first = raw_.triangle_numbers.size();
    const bool more = read_data(nodes, raw_.triangle_numbers, triangle_lines_, [&](std::size_t i, std::uint64_t node) {
      if (i < 3) raw_.triangles.push_back(node);
    });
    add_to_set(keyword, "ELSET", raw_.element_sets, raw_.triangle_numbers, first);
    return more;
  }

  // Shells and membranes; 0 for what is none of these.
  static std::size_t nodes_of_triangle(const std::string& type) {
    for (const char* three : {"S3", "STRI3", "M3D3", "SFM3D3", "R3D3", "DS3", "CPS3", "CPE3"})
      if (type == three || type == std::string(three) + "R") return 3;
    for (const char* six : {"S6", "STRI65", "M3D6", "SFM3D6", "DS6", "CPS6", "CPE6"})
      if (type == six) return 6;
    return 0;
  }

  // Lines, springs, masses and the like.
  bool pass_over_elements() {
    bool continues = false;
    while (lines_.next()) {
      if (lines_.is_keyword()) return true;
      if (!continues) ++raw_.passed_over;
      continues = lines_.line().ends_with(',');
    }
    return false;
  }

  template <class AddNode>
  bool read_data(std::size_t nodes, std::vector<std::uint64_t>& numbers, std::vector<std::size_t>& lines,
                 const AddNode& add_node) {
    while (lines_.next()) {
      if (lines_.is_keyword()) return true;
      lines.push_back(lines_.number());
      numbers.push_back(read_number(lines_.field().value_or("")));
      for (std::size_t i = 0; i < nodes; ++i) {
        auto field = lines_.field();
        if (!field) {  // continued on the next line
          if (!lines_.next() || lines_.is_keyword())
            fail("element has too few nodes", place(lines.back()), std::to_string(i) + " of " + std::to_string(nodes));
          field = lines_.field();
        }
        add_node(i, read_number(*field));
      }
    }
    return false;
  }

  bool read_set(const Keyword& keyword, const char* parameter, std::vector<RawSet>& sets) {
    const auto name = keyword.parameters.find(parameter);
    if (name == keyword.parameters.end() || name->second.empty()) return lines_.next();
    const bool generate = keyword.parameters.contains("GENERATE");
    Members members;
    bool more = false;
    while (!more && lines_.next()) {
      more = lines_.is_keyword();
      if (more) break;
      if (generate) {
        members.add(&sets == &raw_.node_sets ? range_of({&raw_.node_numbers})
                                             : range_of({&raw_.tetrahedron_numbers, &raw_.triangle_numbers}));
        continue;
      }
      while (const auto field = lines_.field()) {
        if (field->empty()) continue;
        if (std::isdigit(static_cast<unsigned char>(field->front())) != 0)
          members.add({read_number(*field)});
        else
          members.add(set_named(sets, *field));
      }
    }
    auto& all = members_of(sets, name->second);
    members.add(all);
    all = members.take();
    return more;
  }

  // Those of the range that exist: what a line may promise is not worth the memory.
  std::vector<std::uint64_t> range_of(std::initializer_list<const std::vector<std::uint64_t>*> lists) {
    const std::uint64_t first = read_number(lines_.field().value_or("")),
                        last = read_number(lines_.field().value_or(""));
    const auto step_field = lines_.field();
    const std::uint64_t step = step_field && !step_field->empty() ? read_number(*step_field) : 1;
    std::vector<std::uint64_t> members;
    for (const auto* numbers : lists)
      for (const std::uint64_t n : *numbers)
        if (n >= first && n <= last && (n - first) % step == 0) members.push_back(n);
    return members;
  }

  // A name that is not known is of a set that the file does not define, and stands for nothing.
  static std::vector<std::uint64_t> set_named(const std::vector<RawSet>& sets, std::string_view field) {
    const std::string name = upper_without_spaces(field);
    const auto it = std::find_if(sets.begin(), sets.end(), [&](const RawSet& s) { return s.name == name; });
    return it == sets.end() ? std::vector<std::uint64_t>{} : it->members;
  }

  bool read_surface(const Keyword& keyword) {
    const auto name = keyword.parameters.find("NAME");
    const auto type = keyword.parameters.find("TYPE");
    const bool of_nodes = type != keyword.parameters.end() && type->second == "NODE";
    Members nodes;
    RawFaceSet faces{name == keyword.parameters.end() ? "" : name->second, {}};
    bool more = false;
    while (!more && lines_.next()) {
      more = lines_.is_keyword();
      if (more) break;
      const std::string what = upper_without_spaces(lines_.field().value_or(""));
      const std::string label = upper_without_spaces(lines_.field().value_or(""));
      const bool is_number = !what.empty() && std::isdigit(static_cast<unsigned char>(what.front())) != 0;
      const auto members =
          is_number ? std::vector{read_number(what)} : set_named(of_nodes ? raw_.node_sets : raw_.element_sets, what);
      if (of_nodes) {
        nodes.add(members);
      } else if (label.size() == 2 && label[0] == 'S' && label[1] >= '1' && label[1] <= '4') {
        for (const std::uint64_t member : members)
          faces.faces.emplace_back(member, static_cast<std::uint8_t>(label[1] - '1'));
        if (!is_number) used_by_surface_.emplace(faces.name + "_" + label, what);
      }
    }
    if (faces.name.empty()) return more;
    if (of_nodes)
      members_of(raw_.node_sets, faces.name) = nodes.take();
    else
      raw_.face_sets.push_back(std::move(faces));
    return more;
  }

  // `write_inp` makes a surface of element sets, and a node set of a surface; neither is a set of its own.
  void drop_parts_of_surfaces() {
    std::erase_if(raw_.element_sets, [&](const RawSet& set) {
      const auto it = used_by_surface_.find(set.name);
      return it != used_by_surface_.end() && it->second == set.name;
    });
  }

  InputFile file_;
  Lines lines_;
  RawMesh raw_;
  std::vector<std::size_t> node_lines_, element_lines_, triangle_lines_;
  std::map<std::string, std::string> used_by_surface_;  // "<surface>_S1" -> the element set whose faces S1 it has
  bool includes_ = false;
};

}  // namespace

MeshFile read_inp(const std::filesystem::path& file) {
  return Reader(file).read();
}

}  // namespace scan2fea
