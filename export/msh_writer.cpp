#include "export/gmsh_elements.hpp"
#include "export/msh.hpp"
#include "export/set_names.hpp"
#include "export/text_output.hpp"
#include "preproc/mesh/output_file.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <algorithm>
#include <limits>
#include <span>

namespace scan2fea {
namespace {

// Elements of one dimension, and which sets of that dimension each is in.
struct Group {
  int dimension;
  int type;  // Gmsh's
  std::size_t nodes_per_element;
  std::vector<std::uint64_t> nodes;  // node numbers, of all elements
  SetParts parts;                    // of the elements
  std::vector<std::string> names;    // of the sets
  std::string name_of_rest;          // of the elements in no set; empty where these are not written
  std::size_t first_tag = 0;         // physical tag of the first set
  std::size_t elements() const { return parts.part.size(); }
};

// Of the elements in no set, as it always was; those of sets follow. For GetDP a number is one region, whatever the
// dimension.
std::size_t tag_of_rest(const Group& group, const Numbering& numbers) {
  return numbers.other(group.dimension == 2 ? 1 : 2);
}

void number_sets(std::vector<Group>& groups, const Numbering& numbers) {
  std::size_t next = numbers.other(3);
  for (Group& group : groups) {
    group.first_tag = next;
    next += group.names.size();
  }
}

std::vector<std::size_t> physical_tags(const Group& group, std::size_t part, const Numbering& numbers) {
  std::vector<std::size_t> tags;
  for (const std::uint32_t s : group.parts.of[part]) tags.push_back(group.first_tag + s);
  if (tags.empty() && !group.name_of_rest.empty()) tags.push_back(tag_of_rest(group, numbers));
  return tags;
}

Group tetrahedra(const TetMesh& mesh, const std::string& prefix, Notes& notes) {
  Group group{.dimension = 3,
              .type = mesh.order() == 2 ? gmsh_tetrahedron_10 : gmsh_tetrahedron_4,
              .nodes_per_element = mesh.order() == 2 ? 10U : 4U,
              .nodes = {},
              .parts = set_parts(mesh.element_sets, mesh.tetrahedra.size()),
              .names = names_for(mesh.element_sets, {.allowed = " _-.+:/()"}, {}, notes),
              .name_of_rest = prefix + "EALL"};
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (const std::uint32_t n : mesh.tetrahedra[t]) group.nodes.push_back(std::uint64_t{n} + 1);
    if (mesh.order() == 2)
      for (const std::size_t e : gmsh_mid_edges) group.nodes.push_back(std::uint64_t{mesh.mid_edge_nodes[t][e]} + 1);
  }
  return group;
}

Group triangles(const TetMesh& mesh, const std::string& prefix, Notes& notes) {
  Group group{.dimension = 2,
              .type = mesh.order() == 2 ? gmsh_triangle_6 : gmsh_triangle_3,
              .nodes_per_element = mesh.order() == 2 ? 6U : 3U,
              .nodes = {},
              .parts = set_parts(mesh.face_sets, mesh.boundary.size()),
              .names = names_for(mesh.face_sets, {.allowed = " _-.+:/()"}, {}, notes),
              .name_of_rest = prefix + "SALL"};
  for (const BoundaryFace f : mesh.boundary) {
    for (const std::uint32_t n : boundary_triangle(mesh, f)) group.nodes.push_back(std::uint64_t{n} + 1);
    if (mesh.order() == 2)
      for (const std::uint32_t n : boundary_mid_edge_nodes(mesh, f)) group.nodes.push_back(std::uint64_t{n} + 1);
  }
  return group;
}

Group triangles(const NamedSurface& surface, const std::string& prefix, Notes& notes) {
  Group group{.dimension = 2,
              .type = gmsh_triangle_3,
              .nodes_per_element = 3,
              .nodes = {},
              .parts = set_parts(surface.face_sets, surface.mesh.triangles.size()),
              .names = names_for(surface.face_sets, {.allowed = " _-.+:/()"}, {}, notes),
              .name_of_rest = prefix + "SALL"};
  for (const Triangle& t : surface.mesh.triangles)
    for (const std::uint32_t n : t) group.nodes.push_back(std::uint64_t{n} + 1);
  return group;
}

// The nodes of sets, each an element.
Group points(const std::vector<NamedSet>& sets, std::size_t nodes, Notes& notes) {
  Group group{.dimension = 0,
              .type = gmsh_point,
              .nodes_per_element = 1,
              .nodes = {},
              .parts = {},
              .names = names_for(sets, {.allowed = " _-.+:/()"}, {}, notes),
              .name_of_rest = {}};
  const SetParts parts = set_parts(sets, nodes);
  group.parts.of = parts.of;
  for (std::uint32_t n = 0; n < nodes; ++n) {
    if (parts.part[n] == 0) continue;
    group.nodes.push_back(std::uint64_t{n} + 1);
    group.parts.part.push_back(parts.part[n]);
  }
  return group;
}

class Writer {
 public:
  // Groups from the highest dimension down.
  Writer(TextOutput& out, const std::vector<Vec3>& nodes, std::vector<Group> groups, const Numbering& numbers)
      : out_(out), nodes_(nodes), groups_(std::move(groups)), numbers_(numbers) {
    number_sets(groups_, numbers_);
    for (const Group& group : groups_) {
      auto& members = members_.emplace_back(group.parts.of.size());
      for (std::uint32_t e = 0; e < group.elements(); ++e) members[group.parts.part[e]].push_back(e);
    }
  }

  void write_header(const std::string& unit, const FileOptions& options) {
    out_ << "$MeshFormat\n" << (options.msh_version == MshVersion::v4_1 ? "4.1" : "2.2") << " 0 8\n$EndMeshFormat\n";
    out_ << "$Comments\nwritten by scan2fea\n";
    if (!options.provenance.empty()) out_ << without_section_marks(options.provenance) << "\n";
    if (!unit.empty()) out_ << unit_comment(unit) << "\n";
    out_ << "$EndComments\n";
    std::size_t names = 0;
    for_each_name([&](int, std::size_t, std::string_view) { ++names; });
    out_ << "$PhysicalNames\n" << names << "\n";
    for_each_name([&](int dimension, std::size_t tag, std::string_view name) {
      out_ << dimension << " " << tag << " \"" << name << "\"\n";
    });
    out_ << "$EndPhysicalNames\n";
  }

  void write_4() {
    write_entities();
    write_nodes_4();
    std::size_t blocks = 0, elements = 0;
    for_each_part([&](const Group&, std::size_t, const auto& members) {
      ++blocks;
      elements += members.size();
    });
    out_ << "$Elements\n"
         << blocks << " " << elements << " " << numbers_.element(0) << " " << numbers_.element(elements) - 1 << "\n";
    std::uint64_t first = numbers_.first_element;  // the number of the group's first element
    const Group* current = nullptr;
    for_each_part([&](const Group& group, std::size_t part, const auto& members) {
      if (current != nullptr && current != &group) first += current->elements();
      current = &group;
      out_ << group.dimension << " " << numbers_.other(part + 1) << " " << group.type << " " << members.size() << "\n";
      for (const std::uint32_t e : members) {
        out_ << first + e;
        write_nodes_of(group, e);
      }
    });
    out_ << "$EndElements\n";
  }

  void write_2() {
    out_ << "$Nodes\n" << nodes_.size() << "\n";
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      out_ << numbers_.node(n) << " ";
      write_point(nodes_[n]);
    }
    std::size_t lines = 0;
    for_each_line_2([&](const Group&, std::uint32_t, std::size_t, std::size_t) { ++lines; });
    out_ << "$EndNodes\n$Elements\n" << lines << "\n";
    std::uint64_t number = numbers_.first_element;
    for_each_line_2([&](const Group& group, std::uint32_t e, std::size_t part, std::size_t tag) {
      out_ << number++ << " " << group.type << " 2 " << tag << " " << numbers_.other(part + 1);
      write_nodes_of(group, e);
    });
    out_ << "$EndElements\n";
  }

 private:
  // A `$` at the start of a line ends a section.
  static std::string without_section_marks(std::string_view text) {
    std::string line = one_line(text);
    std::replace(line.begin(), line.end(), '$', '_');
    return line;
  }

  template <class Do>
  void for_each_name(const Do& what) const {
    for (auto group = groups_.rbegin(); group != groups_.rend(); ++group) {
      const bool has_rest =
          std::find(group->parts.part.begin(), group->parts.part.end(), 0U) != group->parts.part.end();
      if (!group->name_of_rest.empty() && has_rest)
        what(group->dimension, tag_of_rest(*group, numbers_), group->name_of_rest);
      for (std::size_t s = 0; s < group->names.size(); ++s)
        what(group->dimension, group->first_tag + s, group->names[s]);
    }
  }

  // Parts that have elements.
  template <class Do>
  void for_each_part(const Do& what) const {
    for (std::size_t g = 0; g < groups_.size(); ++g)
      for (std::size_t part = 0; part < members_[g].size(); ++part)
        if (!members_[g][part].empty()) what(groups_[g], part, members_[g][part]);
  }

  // In version 2.2 points and triangles are written once for each of their sets, tetrahedra once.
  template <class Do>
  void for_each_line_2(const Do& what) const {
    for (const Group& group : groups_)
      for (std::uint32_t e = 0; e < group.elements(); ++e) {
        const std::size_t part = group.parts.part[e];
        const std::vector<std::size_t> tags = physical_tags(group, part, numbers_);
        for (std::size_t i = 0; i < (group.dimension == 3 ? 1 : tags.size()); ++i) what(group, e, part, tags[i]);
      }
  }

  void write_entities() {
    const BoundingBox box = bounding_box(nodes_);
    std::array<std::size_t, 4> counts{};
    for_each_part(
        [&](const Group& group, std::size_t, const auto&) { ++counts[static_cast<std::size_t>(group.dimension)]; });
    out_ << "$Entities\n" << counts[0] << " 0 " << counts[2] << " " << counts[3] << "\n";
    for (const int dimension : {0, 2, 3})
      for_each_part([&](const Group& group, std::size_t part, const auto& members) {
        if (group.dimension != dimension) return;
        out_ << numbers_.other(part + 1);
        if (dimension == 0) {
          const Vec3& p = nodes_[group.nodes[members.front()] - 1];
          out_ << " " << p.x() << " " << p.y() << " " << p.z();
        } else {
          for (const Vec3& p : {box.low, box.high}) out_ << " " << p.x() << " " << p.y() << " " << p.z();
        }
        const std::vector<std::size_t> tags = physical_tags(group, part, numbers_);
        out_ << " " << tags.size();
        for (const std::size_t tag : tags) out_ << " " << tag;
        out_ << (dimension == 0 ? "\n" : " 0\n");
      });
    out_ << "$EndEntities\n";
  }

  // Each node is filed under the last part that uses it: that of the boundary, where it lies there.
  void write_nodes_4() {
    struct Owner {
      std::uint32_t group, part;
    };
    constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    std::vector<Owner> owners(nodes_.size(), {none, none});
    for (std::uint32_t g = 0; g < groups_.size(); ++g) {
      const Group& group = groups_[g];
      if (group.dimension == 0) continue;
      for (std::size_t i = 0; i < group.nodes.size(); ++i)
        owners[group.nodes[i] - 1] = {g, group.parts.part[i / group.nodes_per_element]};
    }
    // Of one that nothing uses, the first.
    for (Owner& owner : owners)
      if (owner.group == none && groups_.front().elements() > 0) owner = {0, groups_.front().parts.part.front()};
    std::vector<std::vector<std::vector<std::uint32_t>>> blocks(groups_.size());
    for (std::size_t g = 0; g < groups_.size(); ++g) blocks[g].resize(groups_[g].parts.of.size());
    for (std::uint32_t n = 0; n < owners.size(); ++n)
      if (owners[n].group != none) blocks[owners[n].group][owners[n].part].push_back(n);
    std::size_t count = 0;
    for (const auto& parts : blocks)
      for (const auto& block : parts) count += block.empty() ? 0 : 1;
    out_ << "$Nodes\n"
         << count << " " << nodes_.size() << " " << numbers_.node(0) << " " << numbers_.node(nodes_.size()) - 1 << "\n";
    for (std::size_t g = 0; g < groups_.size(); ++g)
      for (std::size_t part = 0; part < blocks[g].size(); ++part) {
        const std::vector<std::uint32_t>& block = blocks[g][part];
        if (block.empty()) continue;
        out_ << groups_[g].dimension << " " << numbers_.other(part + 1) << " 0 " << block.size() << "\n";
        for (const std::uint32_t n : block) out_ << numbers_.node(n) << "\n";
        for (const std::uint32_t n : block) write_point(nodes_[n]);
      }
    out_ << "$EndNodes\n";
  }

  void write_point(const Vec3& p) {
    out_.exact(p.x()) << " ";
    out_.exact(p.y()) << " ";
    out_.exact(p.z()) << "\n";
  }

  void write_nodes_of(const Group& group, std::uint32_t element) {
    for (std::size_t k = 0; k < group.nodes_per_element; ++k)
      out_ << " " << numbers_.node(group.nodes[element * group.nodes_per_element + k] - 1);
    out_ << "\n";
  }

  TextOutput& out_;
  const std::vector<Vec3>& nodes_;
  std::vector<Group> groups_;
  Numbering numbers_;
  std::vector<std::vector<std::vector<std::uint32_t>>> members_;  // elements of each part of each group
};

void write(const std::vector<Vec3>& nodes, std::vector<Group> groups, const std::string& unit,
           const std::filesystem::path& file, const FileOptions& options) {
  OutputFiles files(options.together);
  OutputFile& output = files.open(file);
  {
    TextOutput out(output.stream());
    Writer writer(out, nodes, std::move(groups), options.numbers);
    writer.write_header(unit, options);
    if (options.msh_version == MshVersion::v4_1)
      writer.write_4();
    else
      writer.write_2();
  }
  files.commit();
}

}  // namespace

Notes write_msh(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options) {
  Notes notes;
  std::vector<Group> groups;
  groups.push_back(tetrahedra(mesh, options.set_prefix, notes));
  groups.push_back(triangles(mesh, options.set_prefix, notes));
  groups.push_back(points(mesh.node_sets, mesh.nodes.size(), notes));
  if (options.msh_version == MshVersion::v2_2)
    for (const auto& sets : groups.front().parts.of)
      if (sets.size() > 1)
        notes.push_back("MSH 2.2 holds one set of elements for each; those of several are in the first, " +
                        groups.front().names[sets.front()]);
  write(mesh.nodes, std::move(groups), mesh.unit, file, options);
  return notes;
}

Notes write_msh(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options) {
  Notes notes;
  std::vector<Group> groups;
  groups.push_back(triangles(surface, options.set_prefix, notes));
  groups.push_back(points(surface.node_sets, surface.mesh.vertices.size(), notes));
  write(surface.mesh.vertices, std::move(groups), surface.unit, file, options);
  return notes;
}

}  // namespace scan2fea
