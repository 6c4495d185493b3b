#include "export/exodus.hpp"
#include "export/netcdf.hpp"
#include "export/raw_mesh.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <numeric>

namespace scan2fea {
namespace {

// Of sides 1 to 4 what `tetrahedron_faces` has.
constexpr std::array<std::uint8_t, 4> face_of_side{1, 2, 3, 0};

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : path_(path), file_(path), netcdf_(file_) {}

  MeshFile read() {
    for (const std::string& line : netcdf_.rows("info_records"))
      if (const auto unit = unit_in_comment(line)) raw_.unit = *unit;
    read_nodes();
    read_blocks();
    add_elements();
    read_sets();
    take_numbers();
    return assemble(raw_, path_);
  }

 private:
  struct Element {
    std::size_t first = 0, nodes = 0;  // in nodes_
    bool is_triangle = false;
  };

  // Numbers that cannot be nodes or elements become 0, which none is.
  static std::uint64_t number(std::int64_t value) { return value > 0 ? static_cast<std::uint64_t>(value) : 0; }

  std::vector<std::uint64_t> numbers(const std::string& name) const {
    std::vector<std::uint64_t> result;
    if (!netcdf_.shape(name)) return result;
    for (const std::int64_t value : netcdf_.integers(name)) result.push_back(number(value));
    return result;
  }

  void read_nodes() {
    std::array<std::vector<double>, 3> axes;
    if (netcdf_.shape("coord")) {  // as files before 1994 have them
      const std::vector<double> all = netcdf_.reals("coord");
      const std::size_t count = all.size() / 3;
      if (netcdf_.shape("coord")->size() != 2 || netcdf_.shape("coord")->at(0) != 3)
        file_.fail("the mesh is not three-dimensional");
      for (std::size_t k = 0; k < 3; ++k)
        axes[k].assign(all.begin() + static_cast<std::ptrdiff_t>(k * count),
                       all.begin() + static_cast<std::ptrdiff_t>((k + 1) * count));
    } else {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::string name = std::string("coord") + "xyz"[k];
        if (!netcdf_.shape(name)) file_.fail("the file holds no mesh of three dimensions", "no " + name);
        axes[k] = netcdf_.reals(name);
      }
    }
    if (axes[0].size() != axes[1].size() || axes[0].size() != axes[2].size())
      file_.fail("the coordinates are not equally many");
    for (std::size_t n = 0; n < axes[0].size(); ++n) {
      raw_.node_numbers.push_back(n + 1);
      raw_.nodes.emplace_back(axes[0][n], axes[1][n], axes[2][n]);
    }
  }

  void read_blocks() {
    const std::uint64_t blocks = netcdf_.dimension("num_el_blk").value_or(0);
    const std::vector<std::string> names = netcdf_.rows("eb_names");
    const std::vector<std::uint64_t> ids = numbers("eb_prop1");
    const bool any_name = std::ranges::any_of(names, [](const std::string& name) { return !name.empty(); });
    for (std::uint64_t b = 0; b < std::min<std::uint64_t>(blocks, file_.bytes().size()); ++b) {
      const std::string connect = "connect" + std::to_string(b + 1);
      const auto shape = netcdf_.shape(connect);
      if (!shape || shape->size() != 2) continue;  // a block without elements
      const std::size_t before = elements_.size();
      read_block(connect, shape->at(1));
      std::string name = b < names.size() ? names[b] : "";
      if (name.empty() && (any_name || blocks == 1)) continue;
      if (name.empty()) name = "block_" + std::to_string(b < ids.size() ? ids[b] : b + 1);
      std::vector<std::uint64_t>& members = members_of(raw_.element_sets, name);
      for (std::size_t e = before; e < elements_.size(); ++e) members.push_back(e + 1);
    }
  }

  void read_block(const std::string& connect, std::uint64_t nodes) {
    std::string type = netcdf_.text_attribute(connect, "elem_type");
    std::ranges::transform(type, type.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    const bool tetrahedra = type.starts_with("TET"), triangles = type.starts_with("TRI");
    const bool solids = type.starts_with("HEX") || type.starts_with("WEDGE") || type.starts_with("PYR");
    if (solids || (tetrahedra && nodes != 4 && nodes != 10))
      file_.fail("solid elements that are no tetrahedra of 4 or 10 nodes", type + " of " + std::to_string(nodes));
    const std::vector<std::uint64_t> all = numbers(connect);
    if (nodes == 0 || (triangles && nodes < 3)) file_.fail("elements with too few nodes", type);
    const std::size_t first = nodes_.size();
    nodes_.insert(nodes_.end(), all.begin(), all.end());
    const std::size_t used = tetrahedra ? nodes : triangles ? 3 : 0;
    if (used == 0) raw_.passed_over += all.size() / nodes;
    for (std::size_t e = 0; e < all.size() / nodes; ++e) elements_.push_back({first + e * nodes, used, triangles});
  }

  // One number for each of so many, all different; else nothing.
  std::vector<std::uint64_t> number_map(const std::string& name, std::size_t count) const {
    std::vector<std::uint64_t> map = numbers(name), sorted = map;
    std::ranges::sort(sorted);
    const bool is_map =
        map.size() == count && count > 0 && sorted.front() > 0 && std::ranges::adjacent_find(sorted) == sorted.end();
    return is_map ? map : std::vector<std::uint64_t>();
  }

  // In the order of the element map, where it is one of all elements.
  void add_elements() {
    std::vector<std::uint64_t> order(elements_.size());
    std::iota(order.begin(), order.end(), 0U);
    map_of_elements_ = number_map("elem_num_map", elements_.size());
    const std::vector<std::uint64_t>& map = map_of_elements_;
    if (!map.empty()) std::ranges::sort(order, {}, [&](std::uint64_t e) { return map[e]; });
    for (const std::uint64_t e : order) {
      const Element& element = elements_[e];
      const std::span nodes(nodes_.data() + element.first, element.nodes);
      if (element.nodes == 0) continue;
      if (element.is_triangle) {
        raw_.triangles.insert(raw_.triangles.end(), nodes.begin(), nodes.end());
        raw_.triangle_numbers.push_back(e + 1);
        continue;
      }
      if (raw_.has_other_order(nodes.size() == 10)) file_.fail(mixed_orders);
      raw_.add_tetrahedron(e + 1, nodes);
    }
  }

  // Calls add(name, number as text) for each set of a kind.
  template <class Add>
  void each_set(const char* dimension, const std::string& kind, const std::string& words, const Add& add) {
    const std::vector<std::string> names = netcdf_.rows(kind + "_names");
    const std::vector<std::uint64_t> ids = numbers(kind + "_prop1");
    const std::uint64_t sets = std::min<std::uint64_t>(netcdf_.dimension(dimension).value_or(0), file_.bytes().size());
    for (std::uint64_t s = 0; s < sets; ++s) {
      std::string name = s < names.size() ? names[s] : "";
      if (name.empty()) name = words + "_" + std::to_string(s < ids.size() ? ids[s] : s + 1);
      add(name, std::to_string(s + 1));
    }
  }

  void read_sets() {
    each_set("num_node_sets", "ns", "node_set", [&](const std::string& name, const std::string& number) {
      const std::vector<std::uint64_t> nodes = numbers("node_ns" + number);
      auto& members = members_of(raw_.node_sets, name);
      members.insert(members.end(), nodes.begin(), nodes.end());
    });
    each_set("num_elem_sets", "els", "element_set", [&](const std::string& name, const std::string& number) {
      const std::vector<std::uint64_t> elements = numbers("elem_els" + number);
      auto& members = members_of(raw_.element_sets, name);
      members.insert(members.end(), elements.begin(), elements.end());
    });
    each_set("num_side_sets", "ss", "side_set", [&](const std::string& name, const std::string& number) {
      add_side_set(name, numbers("elem_ss" + number), numbers("side_ss" + number));
    });
  }

  // Sides 1 and 2 of a triangle are its two faces: that is a set of triangles.
  void add_side_set(const std::string& name, const std::vector<std::uint64_t>& elements,
                    const std::vector<std::uint64_t>& sides) {
    RawFaceSet set{name, {}};
    for (std::size_t i = 0; i < std::min(elements.size(), sides.size()); ++i) {
      if (elements[i] < 1 || elements[i] > elements_.size()) file_.fail("a side set names no element", name);
      const Element& element = elements_[elements[i] - 1];
      if (element.is_triangle && sides[i] <= 2) members_of(raw_.element_sets, name).push_back(elements[i]);
      if (element.nodes < 4) continue;
      if (sides[i] < 1 || sides[i] > 4) file_.fail("a side set names no side of a tetrahedron", name);
      set.faces.emplace_back(elements[i], face_of_side[sides[i] - 1]);
    }
    if (!set.faces.empty()) raw_.face_sets.push_back(std::move(set));
  }

  // Places become the numbers that the maps tell. (In sets, too, nodes and elements go by their places.)
  void take_numbers() {
    const std::vector<std::uint64_t> nodes = number_map("node_num_map", raw_.nodes.size());
    raw_.has_own_numbers = !nodes.empty() || !map_of_elements_.empty();
    const auto take = [](const std::vector<std::uint64_t>& map, std::uint64_t& place) {
      if (!map.empty()) place = place > 0 && place <= map.size() ? map[place - 1] : 0;
    };
    for (auto* list : {&raw_.node_numbers, &raw_.corners, &raw_.mid_edges, &raw_.triangles})
      for (std::uint64_t& place : *list) take(nodes, place);
    for (RawSet& set : raw_.node_sets)
      for (std::uint64_t& place : set.members) take(nodes, place);
    for (auto* list : {&raw_.tetrahedron_numbers, &raw_.triangle_numbers})
      for (std::uint64_t& place : *list) take(map_of_elements_, place);
    for (RawSet& set : raw_.element_sets)
      for (std::uint64_t& place : set.members) take(map_of_elements_, place);
    for (RawFaceSet& set : raw_.face_sets)
      for (auto& [place, face] : set.faces) take(map_of_elements_, place);
  }

  std::filesystem::path path_;
  InputFile file_;
  NetcdfReader netcdf_;
  std::vector<std::uint64_t> nodes_;  // of all blocks
  std::vector<Element> elements_;     // in the order of the blocks
  std::vector<std::uint64_t> map_of_elements_;
  RawMesh raw_;
};

}  // namespace

MeshFile read_exodus(const std::filesystem::path& file) {
  return Reader(file).read();
}

}  // namespace scan2fea
