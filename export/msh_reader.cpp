#include "export/gmsh_elements.hpp"
#include "export/msh.hpp"
#include "export/raw_mesh.hpp"
#include "preproc/mesh/byte_order.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/input_file.hpp"
#include "preproc/mesh/text_scanner.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

namespace scan2fea {
namespace {

// How many nodes each of Gmsh's element types has. Solids other than tetrahedra of order 1 and 2 are not listed.
struct ElementType {
  std::int64_t number;
  int nodes;
};
constexpr std::array<ElementType, 21> element_types{
    {{1, 2},   {2, 3},   {3, 4},   {4, 4},   {8, 3},   {9, 6},  {10, 9}, {11, 10}, {15, 1},  {16, 8}, {20, 9},
     {21, 10}, {22, 12}, {23, 15}, {24, 15}, {25, 21}, {26, 4}, {27, 5}, {28, 6},  {36, 16}, {37, 25}}};

// Numbers of a section, as text or as bytes.
class Numbers {
 public:
  explicit Numbers(const InputFile& file) : scanner_(file) {}

  void set_binary(std::endian order) {
    binary_ = true;
    order_ = order;
  }
  bool binary() const { return binary_; }

  std::int64_t integer() { return binary_ ? load_next<std::int32_t>() : text_integer(); }
  std::uint64_t size() { return binary_ ? load_next<std::uint64_t>() : static_cast<std::uint64_t>(text_integer()); }
  double real() {
    if (binary_) return load_next<double>();
    to_next_word();
    return scanner_.number();
  }
  std::int64_t text_integer() {
    to_next_word();
    return scanner_.integer();
  }
  void skip_line() { scanner_.skip_line(); }

  // The name of the next section, without its $; empty at the end of the file.
  std::string next_section() {
    while (scanner_.skip_space()) {
      const std::string_view word = scanner_.word();
      if (!word.starts_with('$')) fail("not the start of a section", std::string(word.substr(0, 40)));
      scanner_.skip_line();
      return std::string(word.substr(1));
    }
    return {};
  }

  // The text up to the end of the line, without it.
  std::string_view rest_of_line() {
    const char* const start = scanner_.position();
    scanner_.skip_line();
    std::string_view line(start, static_cast<std::size_t>(scanner_.position() - start));
    while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
    return line;
  }

  // What is left of the section.
  std::string_view section_text(const std::string& name) {
    const std::string_view rest(scanner_.position(), scanner_.bytes_left());
    return rest.substr(0, rest.find("$End" + name));
  }

  // Behind the closing tag of a section whose content was read or is not needed.
  void close_section(const std::string& name) {
    const std::string tag = "$End" + name;
    const std::string_view rest(scanner_.position(), scanner_.bytes_left());
    const std::size_t at = rest.find(tag);
    if (at == std::string_view::npos) fail("section has no end", "$" + name);
    scanner_ = TextScanner(scanner_.file(), rest.data() + at + tag.size());
  }

  [[noreturn]] void fail(std::string what, std::string value = {}, std::string limit = {}, std::string advice = {}) {
    if (binary_)
      scanner_.file().fail_at_byte(scanner_.position(), std::move(what), std::move(value), std::move(limit),
                                   std::move(advice));
    scanner_.fail(scanner_.position(), std::move(what), std::move(value), std::move(limit), std::move(advice));
  }

 private:
  void to_next_word() {
    if (!scanner_.skip_space()) fail("the file is truncated");
  }

  template <class T>
  T load_next() {
    if (scanner_.bytes_left() < sizeof(T)) fail("the file is truncated");
    const T value = load<T>(scanner_.position(), order_);
    scanner_ = TextScanner(scanner_.file(), scanner_.position() + sizeof(T));
    return value;
  }

  TextScanner scanner_;
  bool binary_ = false;
  std::endian order_ = std::endian::little;
};

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : file_(path), in_(file_) {}

  MeshFile read() {
    if (!file_.bytes().starts_with("$MeshFormat") && !file_.bytes().starts_with("$Comments"))
      file_.fail("not a Gmsh mesh file: does not begin with $MeshFormat");
    for (std::string section = in_.next_section(); !section.empty(); section = in_.next_section()) {
      if (section == "MeshFormat")
        read_format();
      else if (section == "Comments")
        read_comments();
      else if (section == "PhysicalNames")
        read_names();
      else if (section == "Entities" && version_4_)
        read_entities();
      else if (section == "Nodes")
        version_4_ ? read_nodes_4() : read_nodes_2();
      else if (section == "Elements")
        version_4_ ? read_elements_4() : read_elements_2();
      else if (section == "ParametricNodes")
        in_.fail("nodes with parametric coordinates are not read", {}, {}, "Gmsh's Mesh.SaveParametric = 0");
      in_.close_section(section);
    }
    for (auto& [key, members] : groups_) {
      const auto known = names_.find(key);
      const std::string name = known != names_.end() ? known->second : "PHYSICAL_" + std::to_string(key.second);
      auto& all = members_of(key.first == 0 ? raw_.node_sets : raw_.element_sets, name);
      all.insert(all.end(), members.begin(), members.end());
    }
    return assemble(raw_, file_.path());
  }

 private:
  void read_format() {
    const double version = in_.real();
    version_4_ = version == 4.1;
    if (!version_4_ && !(version >= 2 && version < 3))
      in_.fail("a version of MSH that is not known", std::to_string(version), "2.2 or 4.1",
               "saving the mesh again with a newer Gmsh");
    const bool binary = in_.text_integer() == 1;
    if (in_.text_integer() != 8) in_.fail("numbers are not of 8 bytes");
    if (!binary) return;
    in_.skip_line();
    in_.set_binary(std::endian::little);
    const std::int64_t one = in_.integer();
    if (one == 1) return;
    if (one != 0x01000000) in_.fail("the byte order cannot be told");
    in_.set_binary(std::endian::big);
  }

  void read_comments() {
    if (const auto unit = unit_in_comment(in_.section_text("Comments"))) raw_.unit = *unit;
  }

  // Text in binary files, too.
  void read_names() {
    const std::int64_t count = in_.text_integer();
    for (std::int64_t n = 0; n < count; ++n) {
      const std::int64_t dimension = in_.text_integer(), tag = in_.text_integer();
      std::string_view line = in_.rest_of_line();
      const std::size_t open = line.find('"'), close = line.rfind('"');
      if (open == std::string_view::npos || close <= open) in_.fail("a physical name without quotes");
      names_[{dimension, tag}] = line.substr(open + 1, close - open - 1);
    }
  }

  void read_entities() {
    std::array<std::uint64_t, 4> counts{};
    for (std::uint64_t& count : counts) count = in_.size();
    for (std::int64_t dimension = 0; dimension < 4; ++dimension)
      for (std::uint64_t e = 0; e < counts[static_cast<std::size_t>(dimension)]; ++e) {
        const std::int64_t tag = in_.integer();
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) in_.real();
        const std::uint64_t physical = in_.size();
        for (std::uint64_t k = 0; k < physical; ++k)
          physical_[{dimension, tag}].push_back(std::abs(in_.integer()));  // < 0: turned round
        if (dimension == 0) continue;
        const std::uint64_t bounding = in_.size();
        for (std::uint64_t k = 0; k < bounding; ++k) in_.integer();
      }
  }

  void read_node(std::uint64_t number) {
    raw_.node_numbers.push_back(number);
    Vec3& p = raw_.nodes.emplace_back();
    for (int k = 0; k < 3; ++k) p[k] = in_.real();
  }

  void read_nodes_2() {
    const std::int64_t count = read_count_2();
    for (std::int64_t n = 0; n < count; ++n) {
      const auto number = static_cast<std::uint64_t>(in_.integer());
      read_node(number);
    }
  }

  void read_nodes_4() {
    const std::uint64_t blocks = in_.size();
    for (int k = 0; k < 3; ++k) in_.size();
    std::vector<std::uint64_t> numbers;
    for (std::uint64_t b = 0; b < blocks; ++b) {
      const std::int64_t dimension = in_.integer();
      in_.integer();
      const bool parametric = in_.integer() != 0;
      const std::uint64_t count = in_.size();
      numbers.clear();
      for (std::uint64_t n = 0; n < count; ++n) numbers.push_back(in_.size());
      for (const std::uint64_t number : numbers) {
        read_node(number);
        for (std::int64_t k = 0; parametric && k < dimension; ++k) in_.real();
      }
    }
  }

  // Version 2 writes counts as text even into binary files.
  std::int64_t read_count_2() {
    const std::int64_t count = in_.text_integer();
    if (in_.binary()) in_.skip_line();
    return count;
  }

  void read_elements_2() {
    const std::int64_t count = read_count_2();
    for (std::int64_t e = 0; e < count;) {
      std::int64_t number = in_.binary() ? 0 : in_.integer();
      const std::int64_t type = in_.integer();
      const std::int64_t in_block = in_.binary() ? in_.integer() : 1;
      if (in_block < 1) in_.fail("a block of no elements", std::to_string(in_block));
      const std::int64_t tags = in_.integer();
      for (std::int64_t k = 0; k < in_block; ++k, ++e) {
        if (in_.binary()) number = in_.integer();
        std::vector<std::int64_t> physical;  // the first tag, where there is one
        for (std::int64_t t = 0; t < tags; ++t)
          if (const std::int64_t tag = in_.integer(); t == 0 && tag != 0) physical.push_back(tag);
        read_element(type, number, physical, [&] { return static_cast<std::uint64_t>(in_.integer()); });
      }
    }
  }

  void read_elements_4() {
    const std::uint64_t blocks = in_.size();
    for (int k = 0; k < 3; ++k) in_.size();
    for (std::uint64_t b = 0; b < blocks; ++b) {
      const std::int64_t dimension = in_.integer(), entity = in_.integer();
      const std::int64_t type = in_.integer();
      const std::uint64_t count = in_.size();
      const auto physical = physical_.find({dimension, entity});
      const std::vector<std::int64_t> tags =
          physical == physical_.end() ? std::vector<std::int64_t>{} : physical->second;
      for (std::uint64_t e = 0; e < count; ++e) {
        const auto number = static_cast<std::int64_t>(in_.size());
        read_element(type, number, tags, [&] { return in_.size(); });
      }
    }
  }

  template <class ReadNode>
  void read_element(std::int64_t type, std::int64_t number, const std::vector<std::int64_t>& physical,
                    ReadNode read_node_number) {
    const auto* const known = std::find_if(element_types.begin(), element_types.end(),
                                           [&](const ElementType& t) { return t.number == type; });
    if (known == element_types.end())
      in_.fail("element is not a tetrahedron of first or second order", "Gmsh type " + std::to_string(type));
    std::array<std::uint64_t, 25> nodes{};
    for (int k = 0; k < known->nodes; ++k) nodes[static_cast<std::size_t>(k)] = read_node_number();
    const auto add_to_groups = [&](std::int64_t dimension, std::uint64_t member) {
      for (const std::int64_t tag : physical) groups_[{dimension, tag}].push_back(member);
    };
    const auto element = static_cast<std::uint64_t>(number);
    if (type == gmsh_point) {
      add_to_groups(0, nodes[0]);
    } else if (type == gmsh_triangle_3 || type == gmsh_triangle_6) {
      raw_.triangles.insert(raw_.triangles.end(), nodes.begin(), nodes.begin() + 3);
      raw_.triangle_numbers.push_back(element);
      add_to_groups(2, element);
    } else if (type == gmsh_tetrahedron_4 || type == gmsh_tetrahedron_10) {
      add_tetrahedron(nodes, type == gmsh_tetrahedron_10);
      raw_.tetrahedron_numbers.push_back(element);
      add_to_groups(3, element);
    } else {
      ++raw_.passed_over;
    }
  }

  void add_tetrahedron(const std::array<std::uint64_t, 25>& nodes, bool quadratic) {
    if (raw_.has_other_order(quadratic)) in_.fail(mixed_orders);
    raw_.corners.insert(raw_.corners.end(), nodes.begin(), nodes.begin() + 4);
    if (quadratic)
      for (const std::size_t k : gmsh_mid_edges) raw_.mid_edges.push_back(nodes[4 + k]);
  }

  InputFile file_;
  Numbers in_;
  bool version_4_ = false;
  RawMesh raw_;
  using Tag = std::pair<std::int64_t, std::int64_t>;   // dimension and number
  std::map<Tag, std::string> names_;                   // of physical groups
  std::map<Tag, std::vector<std::int64_t>> physical_;  // groups of entities
  std::map<Tag, std::vector<std::uint64_t>> groups_;   // members of physical groups
};

}  // namespace

MeshFile read_msh(const std::filesystem::path& file) {
  return Reader(file).read();
}

}  // namespace scan2fea
