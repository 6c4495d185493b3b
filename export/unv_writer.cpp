#include "export/set_names.hpp"
#include "export/text_output.hpp"
#include "export/unv.hpp"
#include "preproc/mesh/length_unit.hpp"
#include "preproc/mesh/output_file.hpp"

#include <array>
#include <cstdio>
#include <span>

namespace scan2fea {
namespace {

// Groups' names have a line of forty characters.
constexpr NameRules rules{
    .longest = 40, .upper_case = false, .allowed = "_-.", .starts_with_letter = true, .keeps_reserved = true};

// A surface's file has no sets but those that have names.
NameRules surface_rules() {
  NameRules without = rules;
  without.keeps_reserved = false;
  return without;
}
constexpr std::uint64_t node_entity = 7, element_entity = 8;

void write_integers(TextOutput& out, std::initializer_list<std::uint64_t> numbers) {
  for (const std::uint64_t number : numbers) {
    const std::string text = std::to_string(number);
    out << std::string_view("          ").substr(std::min<std::size_t>(text.size(), 10)) << text;
  }
  out << "\n";
}

// Seventeen digits, which round-trip, as Fortran prints double precision.
void write_reals(TextOutput& out, std::initializer_list<double> values) {
  for (const double value : values) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%25.16E", value);
    std::string with_d(text.data());
    with_d[with_d.find('E')] = 'D';
    out << with_d;
  }
  out << "\n";
}

void begin(TextOutput& out, const char* dataset) {
  out << "    -1\n" << dataset << "\n";
}

void end(TextOutput& out) {
  out << "    -1\n";
}

// What a unit is in metres is its factor's inverse. Code 9 is user defined; the others, with their fixed names, have
// none for centimetres and mean forces, too.
void write_units(TextOutput& out, const std::string& unit) {
  const auto known = length_unit(unit);
  if (!known) return;
  begin(out, "   164");
  std::string name = known->substr(0, 20);
  name.resize(20, ' ');
  out << "         9" << name << "         2\n";
  write_reals(out, {1 / metres(*known), 1, 1});
  write_reals(out, {273.15});
  end(out);
}

void write_nodes(TextOutput& out, const std::vector<Vec3>& nodes, const Numbering& numbers) {
  begin(out, "  2411");
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    write_integers(out, {numbers.node(n), 1, 1, 11});
    write_reals(out, {nodes[n].x(), nodes[n].y(), nodes[n].z()});
  }
  end(out);
}

// Nodes of second order run along the edges: a corner, the middle behind it, the next corner.
void write_triangle(TextOutput& out, std::uint64_t number, std::uint64_t property, const Triangle& corners,
                    const Triangle* mid_edges, const Numbering& numbers) {
  write_integers(out,
                 {number, mid_edges != nullptr ? 92U : 91U, property, property, 7, mid_edges != nullptr ? 6U : 3U});
  const auto n = [&](std::uint32_t index) { return numbers.node(index); };
  if (mid_edges == nullptr)
    write_integers(out, {n(corners[0]), n(corners[1]), n(corners[2])});
  else
    write_integers(
        out, {n(corners[0]), n((*mid_edges)[0]), n(corners[1]), n((*mid_edges)[1]), n(corners[2]), n((*mid_edges)[2])});
}

// `parts`: physical and material properties, by which Gmsh, which reads no groups, tells sets from one another.
void write_tetrahedra(TextOutput& out, const TetMesh& mesh, const SetParts& parts, const Numbering& numbers) {
  const auto n = [&](std::uint32_t index) { return numbers.node(index); };
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const Tetrahedron& c = mesh.tetrahedra[t];
    const std::uint64_t property = numbers.other(parts.part[t] + 1);
    write_integers(out, {numbers.element(t), mesh.order() == 2 ? 118U : 111U, property, property, 7,
                         mesh.order() == 2 ? 10U : 4U});
    if (mesh.order() == 1) {
      write_integers(out, {n(c[0]), n(c[1]), n(c[2]), n(c[3])});
      continue;
    }
    const MidEdgeNodes& m = mesh.mid_edge_nodes[t];
    write_integers(out, {n(c[0]), n(m[0]), n(c[1]), n(m[1]), n(c[2]), n(m[2]), n(m[3]), n(m[4])});
    write_integers(out, {n(m[5]), n(c[3])});
  }
}

class Groups {
 public:
  Groups(TextOutput& out, const Numbering& numbers) : out_(out), count_(numbers.other(0)) {}

  template <class Number>
  void write(const std::string& name, std::uint64_t entity, std::size_t members, const Number& number_of) {
    if (members == 0) return;
    write_integers(out_, {++count_, 0, 0, 0, 0, 0, 0, members});
    out_ << name << "\n";
    for (std::size_t i = 0; i < members; i += 2) {
      if (i + 1 < members)
        write_integers(out_, {entity, number_of(i), 0, 0, entity, number_of(i + 1), 0, 0});
      else
        write_integers(out_, {entity, number_of(i), 0, 0});
    }
  }

 private:
  TextOutput& out_;
  std::uint64_t count_;
};

void write_node_groups(Groups& groups, std::span<const NamedSet> sets, std::span<const std::string> names,
                       const Numbering& numbers) {
  for (std::size_t s = 0; s < sets.size(); ++s)
    groups.write(names[s], node_entity, sets[s].members.size(),
                 [&](std::size_t i) { return numbers.node(sets[s].members[i]); });
}

}  // namespace

Notes write_unv(const TetMesh& given, const std::filesystem::path& file, const FileOptions& options) {
  Notes notes;
  const Numbering& numbers = options.numbers;
  const TetMesh mesh = with_whole_sets(given, options.set_prefix, notes);
  // One list of names for all kinds, since groups of one name would be one group to many readers.
  std::vector<NamedSet> sets = mesh.element_sets;
  sets.insert(sets.end(), mesh.face_sets.begin(), mesh.face_sets.end());
  sets.insert(sets.end(), mesh.node_sets.begin(), mesh.node_sets.end());
  const std::vector<std::string> names = names_for(sets, rules, {}, notes);
  const std::span<const std::string> of_elements(names.data(), mesh.element_sets.size());
  const std::span<const std::string> of_faces(names.data() + of_elements.size(), mesh.face_sets.size());
  const std::span<const std::string> of_nodes(of_faces.data() + of_faces.size(), mesh.node_sets.size());
  // Triangles that are in sets, numbered behind the tetrahedra.
  std::vector<std::uint64_t> triangle_number(mesh.boundary.size(), 0);
  for (const NamedSet& set : mesh.face_sets)
    for (const std::uint32_t f : set.members) triangle_number[f] = 1;
  OutputFiles files(options.together);
  OutputFile& output = files.open(file);
  {
    TextOutput out(output.stream());
    write_units(out, mesh.unit);
    write_nodes(out, mesh.nodes, numbers);
    begin(out, "  2412");
    const SetParts bodies = set_parts(given.element_sets, mesh.tetrahedra.size());
    const SetParts faces = set_parts(given.face_sets, mesh.boundary.size());
    write_tetrahedra(out, mesh, bodies, numbers);
    std::uint64_t number = numbers.element(mesh.tetrahedra.size());
    for (std::size_t f = 0; f < mesh.boundary.size(); ++f) {
      if (triangle_number[f] == 0) continue;
      triangle_number[f] = number++;
      const Triangle mid_edges = mesh.order() == 2 ? boundary_mid_edge_nodes(mesh, mesh.boundary[f]) : Triangle{};
      write_triangle(out, triangle_number[f], numbers.other(bodies.of.size() + faces.part[f] + 1),
                     boundary_triangle(mesh, mesh.boundary[f]), mesh.order() == 2 ? &mid_edges : nullptr, numbers);
    }
    end(out);
    begin(out, "  2467");
    Groups groups(out, numbers);
    for (std::size_t s = 0; s < of_elements.size(); ++s)
      groups.write(of_elements[s], element_entity, mesh.element_sets[s].members.size(),
                   [&](std::size_t i) { return numbers.element(mesh.element_sets[s].members[i]); });
    for (std::size_t s = 0; s < of_faces.size(); ++s)
      groups.write(of_faces[s], element_entity, mesh.face_sets[s].members.size(),
                   [&](std::size_t i) { return triangle_number[mesh.face_sets[s].members[i]]; });
    write_node_groups(groups, mesh.node_sets, of_nodes, numbers);
    end(out);
  }
  files.commit();
  return notes;
}

Notes write_unv(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options) {
  Notes notes;
  const Numbering& numbers = options.numbers;
  std::vector<NamedSet> sets = surface.face_sets;
  sets.insert(sets.end(), surface.node_sets.begin(), surface.node_sets.end());
  const std::vector<std::string> names = names_for(sets, surface_rules(), {}, notes);
  OutputFiles files(options.together);
  OutputFile& output = files.open(file);
  {
    TextOutput out(output.stream());
    write_units(out, surface.unit);
    write_nodes(out, surface.mesh.vertices, numbers);
    begin(out, "  2412");
    for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t)
      write_triangle(out, numbers.element(t), numbers.other(1), surface.mesh.triangles[t], nullptr, numbers);
    end(out);
    begin(out, "  2467");
    Groups groups(out, numbers);
    for (std::size_t s = 0; s < surface.face_sets.size(); ++s)
      groups.write(names[s], element_entity, surface.face_sets[s].members.size(),
                   [&](std::size_t i) { return numbers.element(surface.face_sets[s].members[i]); });
    write_node_groups(groups, surface.node_sets, std::span(names).subspan(surface.face_sets.size()), numbers);
    end(out);
  }
  files.commit();
  return notes;
}

}  // namespace scan2fea
