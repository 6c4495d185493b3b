#include "export/raw_mesh.hpp"
#include "export/set_names.hpp"
#include "export/vtk_cells.hpp"
#include "export/vtk_xml.hpp"
#include "export/xdmf.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/input_file.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <charconv>
#include <map>
#include <stdexcept>

namespace scan2fea {
namespace {

using vtk_xml::Tag;

struct Attribute {
  std::string name, centre;
  std::vector<double> values;
};

struct Grid {
  std::string topology;              // in lower case
  std::vector<std::uint64_t> nodes;  // of all elements
  std::vector<double> coordinates;
  std::vector<Attribute> attributes;
  std::map<std::uint64_t, std::string> names;  // of tags
  std::string unit;
};

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

std::uint64_t integer(const InputFile& file, const std::string& text) {
  std::uint64_t value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) file.fail("not a whole number", text);
  return value;
}

template <class Read>
auto read_item(const InputFile& file, const Tag& tag, std::string_view content, const Read& read) {
  const std::string format = tag.attribute("Format", "XML");
  if (format != "XML") file.fail("data that are not in the file", format, "XML", "saving it with data as XML");
  try {
    return read({{.name = "DataArray", .attributes = {}, .end = 0}, content}, vtk_xml::Storage{});
  } catch (const std::runtime_error& error) {
    file.fail(std::string("a DataItem ") + error.what());
  }
}

Grid read_grid(const InputFile& file) {
  Grid grid;
  const std::string_view text = file.bytes();
  std::string section;
  bool is_xdmf = false;
  for (std::size_t position = 0;;) {
    const std::optional<Tag> tag = vtk_xml::next_tag(text, position);
    if (!tag) break;
    position = tag->end;
    const std::string_view content = text.substr(position, text.find('<', position) - position);
    if (tag->name == "Xdmf") {
      is_xdmf = true;
      if (const auto unit = unit_in_comment(text.substr(0, position))) grid.unit = *unit;
    } else if (tag->name == "Topology") {
      if (!grid.topology.empty()) file.fail("several grids", {}, "one");
      grid.topology = lower(tag->attribute("TopologyType", tag->attribute("Type")));
      section = tag->name;
    } else if (tag->name == "Geometry") {
      section = tag->name;
    } else if (tag->name == "Attribute") {
      grid.attributes.push_back({tag->attribute("Name"), tag->attribute("Center"), {}});
      section = tag->name;
    } else if (tag->name == "map") {
      grid.names[integer(file, std::string(content))] = tag->attribute("key");
    } else if (tag->name == "DataItem") {
      if (section == "Topology") grid.nodes = read_item(file, *tag, content, vtk_xml::read_integers);
      if (section == "Geometry") grid.coordinates = read_item(file, *tag, content, vtk_xml::read_reals);
      if (section == "Attribute") grid.attributes.back().values = read_item(file, *tag, content, vtk_xml::read_reals);
    }
  }
  if (!is_xdmf) file.fail("not an XDMF file");
  return grid;
}

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : path_(file) {}

  MeshFile read() {
    const InputFile file(path_);
    const Grid grid = read_grid(file);
    for (std::size_t i = 0; i + 2 < grid.coordinates.size(); i += 3) {
      raw_.node_numbers.push_back(i / 3);
      raw_.nodes.emplace_back(grid.coordinates[i], grid.coordinates[i + 1], grid.coordinates[i + 2]);
    }
    raw_.unit = grid.unit;
    add_elements(file, grid);
    for (const Attribute& attribute : grid.attributes)
      if (attribute.centre == "Node" && attribute.name.starts_with(vtk_node_set)) {
        auto& members = members_of(raw_.node_sets, attribute.name.substr(vtk_node_set.size()));
        for (std::size_t n = 0; n < attribute.values.size(); ++n)
          if (attribute.values[n] != 0) members.push_back(n);
      }
    std::filesystem::path facets = path_;
    facets.replace_filename(path_.stem().string() + "_facets" + path_.extension().string());
    if (!raw_.corners.empty() && std::filesystem::exists(facets)) {
      const InputFile facets_file(facets);
      const Grid grid_of_facets = read_grid(facets_file);
      // Another mesh by this name would come on top of the first.
      if (!grid_of_facets.topology.starts_with("tri"))
        facets_file.fail("facets of " + path_.filename().string() + " are not triangles", grid_of_facets.topology, {},
                         "another name for this file");
      add_elements(facets_file, grid_of_facets);
    }
    MeshFile mesh = assemble(raw_, path_);
    for (const Attribute& attribute : grid.attributes)
      if (!is_of_tags(attribute.name) && !attribute.name.starts_with(vtk_node_set))
        mesh.other_arrays.push_back(attribute.name);
    return mesh;
  }

 private:
  void add_elements(const InputFile& file, const Grid& grid) {
    const bool tetrahedra = grid.topology.starts_with("tet"),
               second = grid.topology.ends_with("_10") || grid.topology.ends_with("_6");
    if (!tetrahedra && !grid.topology.starts_with("tri"))
      file.fail("elements are neither tetrahedra nor triangles", grid.topology);
    const std::size_t each = tetrahedra ? (second ? 10 : 4) : (second ? 6 : 3), count = grid.nodes.size() / each;
    if (grid.nodes.size() % each != 0) file.fail("the topology has a wrong size", std::to_string(grid.nodes.size()));
    std::vector<std::uint64_t> numbers(count);
    for (std::size_t e = 0; e < count; ++e) {
      numbers[e] = 2 * e + (tetrahedra ? 0 : 1);
      for (std::size_t k = 0; k < each; ++k) {
        const std::uint64_t node = grid.nodes[e * each + k];
        if (tetrahedra)
          (k < 4 ? raw_.corners : raw_.mid_edges).push_back(node);
        else if (k < 3)
          raw_.triangles.push_back(node);
      }
    }
    add_tags(grid, numbers);
    (tetrahedra ? raw_.tetrahedron_numbers : raw_.triangle_numbers) = std::move(numbers);
  }

  // Tags of other programs, which have no names, are called by their number.
  void add_tags(const Grid& grid, const std::vector<std::uint64_t>& numbers) {
    for (const Attribute& attribute : grid.attributes) {
      if (attribute.centre != "Cell" || !is_of_tags(attribute.name)) continue;
      for (std::size_t e = 0; e < std::min(numbers.size(), attribute.values.size()); ++e) {
        if (!(attribute.values[e] > 0 && attribute.values[e] < 1e9)) continue;
        const auto tag = static_cast<std::uint64_t>(attribute.values[e]);
        const auto name = grid.names.find(tag);
        const std::string text = name == grid.names.end() ? "TAG_" + std::to_string(tag) : name->second;
        for (const std::string& part : split_part_name(text)) members_of(raw_.element_sets, part).push_back(numbers[e]);
      }
    }
  }

  static bool is_of_tags(const std::string& name) {
    return name == "cell_tags" || name == "facet_tags" || name == "name_to_read" || name == "gmsh:physical";
  }

  std::filesystem::path path_;
  RawMesh raw_;
};

}  // namespace

MeshFile read_xdmf(const std::filesystem::path& file) {
  return Reader(file).read();
}

}  // namespace scan2fea
