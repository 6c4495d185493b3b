#include "export/exodus.hpp"
#include "export/netcdf.hpp"
#include "export/set_names.hpp"
#include "export/text_output.hpp"
#include "preproc/mesh/output_file.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <array>
#include <cmath>
#include <span>

namespace scan2fea {
namespace {

// What the library of Exodus II has by default: 32 characters and a zero.
constexpr std::size_t name_row = 33, line_row = 81;
constexpr NameRules rules{
    .longest = 32, .upper_case = false, .allowed = "_-.+", .starts_with_letter = true, .keeps_reserved = true};

// Of the faces of `tetrahedron_faces` 123, 142, 243, 341.
constexpr std::array<std::int32_t, 4> sides{4, 1, 2, 3};

std::string row(std::string text, std::size_t size) {
  text = text.substr(0, size - 1);
  text.resize(size, '\0');
  return text;
}

std::vector<std::int32_t> numbers(std::span<const std::uint32_t> indices) {
  std::vector<std::int32_t> result;
  for (const std::uint32_t i : indices) result.push_back(static_cast<std::int32_t>(i) + 1);
  return result;
}

class Writer {
 public:
  Writer(const std::vector<Vec3>& nodes, const std::string& unit, const FileOptions& options)
      : numbers_(options.numbers) {
    out_.attribute({"api_version", 5.22F});
    out_.attribute({"version", 5.22F});
    out_.attribute({"floating_point_word_size", std::int32_t{8}});
    out_.attribute({"file_size", std::int32_t{1}});
    out_.attribute({"maximum_name_length", std::int32_t{32}});
    out_.attribute({"int64_status", std::int32_t{0}});
    const std::string title = one_line(options.provenance).substr(0, line_row - 1);
    out_.attribute({"title", title.empty() ? std::string("written by scan2fea") : title});
    name_ = out_.dimension("len_name", name_row);
    line_ = out_.dimension("len_line", line_row);
    out_.dimension("len_string", name_row);
    out_.dimension("four", 4);
    const std::size_t time = out_.dimension("time_step", 0);
    const std::size_t axes = out_.dimension("num_dim", 3), points = out_.dimension("num_nodes", nodes.size());
    out_.variable("time_whole", {time}, std::vector<double>{});
    std::string information = row("written by scan2fea", line_row);
    if (!unit.empty()) information += row(unit_comment(unit), line_row);
    const std::size_t lines = out_.dimension("num_info", information.size() / line_row);
    out_.variable("info_records", {lines, line_}, std::move(information));
    out_.variable("coor_names", {axes, name_}, row("x", name_row) + row("y", name_row) + row("z", name_row));
    for (int k = 0; k < 3; ++k) {
      std::vector<double> values;
      values.reserve(nodes.size());
      for (const Vec3& p : nodes) values.push_back(p[k]);
      out_.variable(
          std::string("coord") + "xyz" [k], { points }, std::move(values));
    }
    std::vector<std::int32_t> map;
    for (std::size_t n = 0; n < nodes.size(); ++n) map.push_back(static_cast<std::int32_t>(numbers_.node(n)));
    out_.variable("node_num_map", {points}, std::move(map));
  }

  struct Block {
    std::string name;
    std::vector<std::uint32_t> elements;  // by index, in its order
  };

  // `add_nodes` appends those of an element, from 1.
  template <class AddNodes>
  void blocks(const std::vector<Block>& blocks, const std::string& type, std::size_t nodes, std::size_t elements,
              const AddNodes& add_nodes) {
    place_.resize(elements);
    const std::size_t all = out_.dimension("num_elem", elements);
    std::vector<std::string> names;
    std::vector<std::int32_t> order;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const std::string number = std::to_string(b + 1);
      names.push_back(blocks[b].name);
      std::vector<std::int32_t> connectivity;
      connectivity.reserve(nodes * blocks[b].elements.size());
      for (const std::uint32_t e : blocks[b].elements) {
        add_nodes(e, connectivity);
        order.push_back(static_cast<std::int32_t>(numbers_.element(e)));
        place_[e] = static_cast<std::int32_t>(order.size());
      }
      const std::size_t rows = out_.dimension("num_el_in_blk" + number, blocks[b].elements.size()),
                        columns = out_.dimension("num_nod_per_el" + number, nodes);
      out_.variable("connect" + number, {rows, columns}, std::move(connectivity), {{"elem_type", type}});
    }
    list("num_el_blk", "eb", names);
    out_.variable("elem_num_map", {all}, std::move(order));
  }

  // Sets without members are left out, which Exodus has no way to hold.
  void node_sets(std::span<const NamedSet> sets, std::span<const std::string> names) {
    each_set(sets, names, "num_node_sets", "ns", [&](const NamedSet& set, const std::string& number) {
      const std::size_t size = out_.dimension("num_nod_ns" + number, set.members.size());
      out_.variable("node_ns" + number, {size}, numbers(set.members));
    });
  }

  void element_sets(std::span<const NamedSet> sets, std::span<const std::string> names) {
    each_set(sets, names, "num_elem_sets", "els", [&](const NamedSet& set, const std::string& number) {
      const std::size_t size = out_.dimension("num_ele_els" + number, set.members.size());
      std::vector<std::int32_t> elements;
      for (const std::uint32_t m : set.members) elements.push_back(place_[m]);
      out_.variable("elem_els" + number, {size}, std::move(elements));
    });
  }

  void side_sets(const TetMesh& mesh, std::span<const NamedSet> sets, std::span<const std::string> names) {
    each_set(sets, names, "num_side_sets", "ss", [&](const NamedSet& set, const std::string& number) {
      const std::size_t size = out_.dimension("num_side_ss" + number, set.members.size());
      std::vector<std::int32_t> elements, faces;
      for (const std::uint32_t m : set.members) {
        elements.push_back(place_[mesh.boundary[m].tetrahedron]);
        faces.push_back(sides[mesh.boundary[m].face]);
      }
      out_.variable("elem_ss" + number, {size}, std::move(elements));
      out_.variable("side_ss" + number, {size}, std::move(faces));
    });
  }

  void write(const std::filesystem::path& file, OutputFiles* together) const {
    OutputFiles files(together);
    out_.write(files.open(file).stream());
    files.commit();
  }

 private:
  template <class Add>
  void each_set(std::span<const NamedSet> sets, std::span<const std::string> names, const char* dimension,
                const std::string& kind, const Add& add) {
    std::vector<std::string> written;
    for (std::size_t s = 0; s < sets.size(); ++s) {
      if (sets[s].members.empty()) continue;
      written.push_back(names[s]);
      add(sets[s], std::to_string(written.size()));
    }
    list(dimension, kind, written);
  }

  // What every list of blocks or sets has: that they are there, their numbers, their names.
  void list(const std::string& dimension, const std::string& kind, const std::vector<std::string>& names) {
    if (names.empty()) return;
    const std::size_t count = out_.dimension(dimension, names.size());
    std::vector<std::int32_t> ids, there(names.size(), 1);
    std::string rows;
    for (std::size_t i = 0; i < names.size(); ++i) {
      ids.push_back(static_cast<std::int32_t>(i) + 1);
      rows += row(names[i], name_row);
    }
    out_.variable(kind + "_status", {count}, std::move(there));
    out_.variable(kind + "_prop1", {count}, std::move(ids), {{"name", std::string("ID")}});
    out_.variable(kind + "_names", {count, name_}, std::move(rows));
  }

  NetcdfWriter out_;
  const Numbering& numbers_;
  std::size_t name_ = 0, line_ = 0;
  std::vector<std::int32_t> place_;  // of an element in the order of the blocks, from 1
};

}  // namespace

Notes write_exodus(const TetMesh& given, const std::filesystem::path& file, const FileOptions& options) {
  Notes notes;
  const TetMesh mesh = with_whole_sets(given, options.set_prefix, notes);
  const std::vector<std::string> elements = names_for(mesh.element_sets, rules, {}, notes);
  // EALL, the last one, is a block only where there is no other.
  const std::size_t named = mesh.element_sets.size() - 1;
  const DisjointSets bodies = disjoint_sets(std::span(mesh.element_sets).first(named), mesh.tetrahedra.size());
  std::vector<Writer::Block> blocks;
  for (const std::size_t s : bodies.disjoint) blocks.push_back({elements[s], mesh.element_sets[s].members});
  if (blocks.empty())
    blocks.push_back({elements[named], bodies.rest});
  else if (!bodies.rest.empty())
    blocks.push_back({"", bodies.rest});
  std::vector<NamedSet> sets;
  std::vector<std::string> names;
  for (const std::size_t s : bodies.overlapping) {
    sets.push_back(mesh.element_sets[s]);
    names.push_back(elements[s]);
  }
  if (!bodies.disjoint.empty()) {
    sets.push_back(mesh.element_sets[named]);
    names.push_back(elements[named]);
  }
  Writer writer(mesh.nodes, mesh.unit, options);
  const bool second = mesh.order() == 2;
  writer.blocks(blocks, second ? "TETRA10" : "TETRA", second ? 10 : 4, mesh.tetrahedra.size(),
                [&](std::uint32_t t, std::vector<std::int32_t>& nodes) {
                  for (const std::uint32_t n : mesh.tetrahedra[t]) nodes.push_back(static_cast<std::int32_t>(n) + 1);
                  if (!second) return;
                  for (const std::uint32_t n : mesh.mid_edge_nodes[t])
                    nodes.push_back(static_cast<std::int32_t>(n) + 1);
                });
  writer.side_sets(mesh, mesh.face_sets, names_for(mesh.face_sets, rules, {}, notes));
  writer.node_sets(mesh.node_sets, names_for(mesh.node_sets, rules, {}, notes));
  writer.element_sets(sets, names);
  writer.write(file, options.together);
  return notes;
}

Notes write_exodus(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options) {
  Notes notes;
  Writer writer(surface.mesh.vertices, surface.unit, options);
  std::vector<Writer::Block> block{{"EALL", {}}};
  for (std::uint32_t t = 0; t < surface.mesh.triangles.size(); ++t) block[0].elements.push_back(t);
  writer.blocks(block, "TRI3", 3, surface.mesh.triangles.size(),
                [&](std::uint32_t t, std::vector<std::int32_t>& nodes) {
                  for (const std::uint32_t v : surface.mesh.triangles[t])
                    nodes.push_back(static_cast<std::int32_t>(v) + 1);
                });
  writer.node_sets(surface.node_sets, names_for(surface.node_sets, rules, {}, notes));
  writer.element_sets(surface.face_sets, names_for(surface.face_sets, rules, {}, notes));
  writer.write(file, options.together);
  return notes;
}

}  // namespace scan2fea
