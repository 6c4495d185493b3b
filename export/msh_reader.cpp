#include "export/gmsh_elements.hpp"
#include "export/msh.hpp"
#include "export/raw_mesh.hpp"
#include "preproc/mesh/byte_order.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/input_file.hpp"
#include "preproc/mesh/text_scanner.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>

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

  TetMesh read() {
    if (!file_.bytes().starts_with("$MeshFormat") && !file_.bytes().starts_with("$Comments"))
      file_.fail("not a Gmsh mesh file: does not begin with $MeshFormat");
    for (std::string section = in_.next_section(); !section.empty(); section = in_.next_section()) {
      if (section == "MeshFormat")
        read_format();
      else if (section == "Nodes")
        version_4_ ? read_nodes_4() : read_nodes_2();
      else if (section == "Elements")
        version_4_ ? read_elements_4() : read_elements_2();
      else if (section == "ParametricNodes")
        in_.fail("nodes with parametric coordinates are not read", {}, {}, "Gmsh's Mesh.SaveParametric = 0");
      in_.close_section(section);
    }
    const std::string name = file_.path().string();
    return assemble(
        raw_, file_.path(), [&](std::size_t n) { return name + ": node " + std::to_string(raw_.node_numbers[n]); },
        [&](std::size_t e) { return name + ": element " + std::to_string(element_numbers_[e]); });
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
        for (std::int64_t t = 0; t < tags; ++t) in_.integer();
        read_element(type, number, [&] { return static_cast<std::uint64_t>(in_.integer()); });
      }
    }
  }

  void read_elements_4() {
    const std::uint64_t blocks = in_.size();
    for (int k = 0; k < 3; ++k) in_.size();
    for (std::uint64_t b = 0; b < blocks; ++b) {
      in_.integer();
      in_.integer();
      const std::int64_t type = in_.integer();
      const std::uint64_t count = in_.size();
      for (std::uint64_t e = 0; e < count; ++e) {
        const auto number = static_cast<std::int64_t>(in_.size());
        read_element(type, number, [&] { return in_.size(); });
      }
    }
  }

  template <class ReadNode>
  void read_element(std::int64_t type, std::int64_t number, ReadNode read_node_number) {
    const auto* const known = std::find_if(element_types.begin(), element_types.end(),
                                           [&](const ElementType& t) { return t.number == type; });
    if (known == element_types.end())
      in_.fail("element is not a tetrahedron of first or second order", "Gmsh type " + std::to_string(type));
    std::array<std::uint64_t, 25> nodes{};
    for (int k = 0; k < known->nodes; ++k) nodes[static_cast<std::size_t>(k)] = read_node_number();
    if (type != gmsh_tetrahedron_4 && type != gmsh_tetrahedron_10) return;
    const bool quadratic = type == gmsh_tetrahedron_10;
    if (!raw_.corners.empty() && quadratic == raw_.mid_edges.empty())
      in_.fail("tetrahedra of first and of second order in one mesh");
    raw_.corners.insert(raw_.corners.end(), nodes.begin(), nodes.begin() + 4);
    if (quadratic)
      for (const std::size_t k : gmsh_mid_edges) raw_.mid_edges.push_back(nodes[4 + k]);
    element_numbers_.push_back(number);
  }

  InputFile file_;
  Numbers in_;
  bool version_4_ = false;
  RawMesh raw_;
  std::vector<std::int64_t> element_numbers_;
};

}  // namespace

TetMesh read_msh(const std::filesystem::path& file) {
  return Reader(file).read();
}

}  // namespace scan2fea
