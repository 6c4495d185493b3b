#include "export/inp.hpp"
#include "export/set_names.hpp"
#include "export/smallest_determinant.hpp"
#include "export/text_output.hpp"
#include "preproc/mesh/output_file.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <string>

namespace scan2fea {
namespace {

constexpr std::size_t longest_line = 132;

void write_comment(TextOutput& out, std::string_view text) {
  constexpr std::string_view start = "** ";
  const std::string line = one_line(text);
  constexpr std::size_t width = longest_line - start.size();
  for (std::size_t i = 0; i < line.size(); i += width) out << start << std::string_view(line).substr(i, width) << "\n";
}

void write_header(TextOutput& out, const std::vector<Vec3>& nodes, const std::string& unit,
                  const FileOptions& options) {
  write_comment(out, "written by scan2fea for Abaqus and CalculiX");
  if (!options.provenance.empty()) write_comment(out, options.provenance);
  if (!unit.empty()) write_comment(out, unit_comment(unit));
  const BoundingBox box = bounding_box(nodes);
  out << "** bounding box, low:  " << box.low.x() << " " << box.low.y() << " " << box.low.z() << "\n";
  out << "** bounding box, high: " << box.high.x() << " " << box.high.y() << " " << box.high.z() << "\n";
}

void write_nodes(TextOutput& out, const std::vector<Vec3>& nodes, const FileOptions& options) {
  out << "*NODE, NSET=" << options.set_prefix << "NALL\n";
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const Vec3& p = nodes[n];
    out << options.numbers.node(n) << ", " << p.x() << ", " << p.y() << ", " << p.z() << "\n";
  }
}

void write_elements(TextOutput& out, const TetMesh& mesh, const FileOptions& options) {
  out << "*ELEMENT, TYPE=" << (mesh.order() == 2 ? "C3D10" : "C3D4") << ", ELSET=" << options.set_prefix << "EALL\n";
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    out << options.numbers.element(t);
    for (const std::uint32_t n : mesh.tetrahedra[t]) out << "," << options.numbers.node(n);
    if (mesh.order() == 2)
      for (const std::uint32_t n : mesh.mid_edge_nodes[t]) out << "," << options.numbers.node(n);
    out << "\n";
  }
}

using NumberOf = std::uint64_t (Numbering::*)(std::uint64_t) const;

// Ten numbers of up to ten digits and their commas keep within a line of CalculiX.
void write_numbers(TextOutput& out, const std::vector<std::uint32_t>& indices, const Numbering& numbers,
                   NumberOf number_of) {
  constexpr std::size_t per_line = 10;
  for (std::size_t i = 0; i < indices.size(); ++i)
    out << (numbers.*number_of)(indices[i]) << (i + 1 == indices.size() || (i + 1) % per_line == 0 ? "\n" : ", ");
}

void write_surface_set(TextOutput& out, const TetMesh& mesh, const std::string& name,
                       std::span<const std::uint32_t> faces, const Numbering& numbers) {
  if (faces.empty()) return;
  std::array<std::vector<std::uint32_t>, 4> elements;
  for (const std::uint32_t i : faces) elements[mesh.boundary[i].face].push_back(mesh.boundary[i].tetrahedron);
  for (std::size_t f = 0; f < 4; ++f) {
    if (elements[f].empty()) continue;
    std::sort(elements[f].begin(), elements[f].end());
    out << "*ELSET, ELSET=" << name << "_S" << f + 1 << "\n";
    write_numbers(out, elements[f], numbers, &Numbering::element);
  }
  out << "*SURFACE, NAME=" << name << ", TYPE=ELEMENT\n";
  for (std::size_t f = 0; f < 4; ++f)
    if (!elements[f].empty()) out << name << "_S" << f + 1 << ", S" << f + 1 << "\n";
  out << "*NSET, NSET=" << name << "_NODES\n";
  write_numbers(out, nodes_of_faces(mesh, faces), numbers, &Numbering::node);
}

void write_sets(TextOutput& out, const char* keyword, std::span<const NamedSet> sets,
                std::span<const std::string> names, const Numbering& numbers, NumberOf number_of) {
  for (std::size_t s = 0; s < sets.size(); ++s) {
    out << keyword << names[s] << "\n";
    write_numbers(out, sets[s].members, numbers, number_of);
  }
}

// CalculiX takes 80 characters, of which a surface's parts need six.
constexpr NameRules rules{.longest = 74, .upper_case = true, .allowed = "_-.", .starts_with_letter = true};

Notes determinant_notes(const TetMesh& mesh, const std::filesystem::path& file, const Numbering& numbers) {
  const SmallestDeterminant smallest = smallest_determinant(mesh);
  if (smallest.value >= calculix_smallest_determinant || mesh.tetrahedra.empty()) return {};
  const auto text = [](double value) {
    char characters[longest_number];
    return std::string(characters, write_number(characters, value));
  };
  std::string note = file.string() + ": CalculiX will refuse element " +
                     std::to_string(numbers.element(smallest.tetrahedron)) + ": Jacobian determinant " +
                     text(smallest.value) + " (limit: " + text(calculix_smallest_determinant) + ")";
  if (smallest.value > 0) note += "; try: a smaller unit of length, millimetres for metres";
  return {note};
}

}  // namespace

// The parts of a surface and its nodes are named after it, and element and node sets must not have these names.
WrittenNames names_in_inp(const TetMesh& mesh, const std::string& prefix, Notes& notes) {
  std::vector<std::string> parts = taken_with_prefix(prefix), nodes = parts;
  WrittenNames names{.nodes = {}, .faces = names_for(mesh.face_sets, rules, parts, notes), .elements = {}};
  for (const std::string& name : names.faces) {
    for (const char* end : {"_S1", "_S2", "_S3", "_S4"}) parts.push_back(name + end);
    nodes.push_back(name + "_NODES");
  }
  names.elements = names_for(mesh.element_sets, rules, parts, notes);
  names.nodes = names_for(mesh.node_sets, rules, nodes, notes);
  return names;
}

Notes write_inp(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options) {
  Notes notes = determinant_notes(mesh, file, options.numbers);
  const WrittenNames names = names_in_inp(mesh, options.set_prefix, notes);
  OutputFiles files(options.together);
  OutputFile& output = files.open(file);
  {
    TextOutput out(output.stream());
    write_header(out, mesh.nodes, mesh.unit, options);
    out << "** " << mesh.nodes.size() << " nodes, " << mesh.tetrahedra.size() << " tetrahedra, " << mesh.outer_faces()
        << " boundary faces\n";
    const std::string& prefix = options.set_prefix;
    write_comment(out, "sets: " + prefix + "NALL (nodes), " + prefix + "EALL (elements), " + prefix +
                           "SALL (surface), " + prefix + "SALL_NODES (nodes of the surface)");
    write_nodes(out, mesh.nodes, options);
    write_elements(out, mesh, options);
    write_sets(out, "*ELSET, ELSET=", mesh.element_sets, names.elements, options.numbers, &Numbering::element);
    write_sets(out, "*NSET, NSET=", mesh.node_sets, names.nodes, options.numbers, &Numbering::node);
    std::vector<std::uint32_t> all(mesh.outer_faces());
    std::iota(all.begin(), all.end(), 0U);
    write_surface_set(out, mesh, prefix + "SALL", all, options.numbers);
    for (std::size_t s = 0; s < mesh.face_sets.size(); ++s)
      write_surface_set(out, mesh, names.faces[s], mesh.face_sets[s].members, options.numbers);
  }
  files.commit();
  return notes;
}

Notes write_inp(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options) {
  Notes notes;
  const std::vector<std::string> elements =
      names_for(surface.face_sets, rules, taken_with_prefix(options.set_prefix), notes);
  const std::vector<std::string> nodes =
      names_for(surface.node_sets, rules, taken_with_prefix(options.set_prefix), notes);
  OutputFiles files(options.together);
  OutputFile& output = files.open(file);
  {
    TextOutput out(output.stream());
    write_header(out, surface.mesh.vertices, surface.unit, options);
    write_nodes(out, surface.mesh.vertices, options);
    out << "*ELEMENT, TYPE=S3, ELSET=" << options.set_prefix << "EALL\n";
    for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t) {
      out << options.numbers.element(t);
      for (const std::uint32_t v : surface.mesh.triangles[t]) out << "," << options.numbers.node(v);
      out << "\n";
    }
    write_sets(out, "*ELSET, ELSET=", surface.face_sets, elements, options.numbers, &Numbering::element);
    write_sets(out, "*NSET, NSET=", surface.node_sets, nodes, options.numbers, &Numbering::node);
  }
  files.commit();
  return notes;
}

}  // namespace scan2fea
