#include "export/cdb.hpp"
#include "export/set_names.hpp"
#include "export/text_output.hpp"
#include "preproc/mesh/length_unit.hpp"
#include "preproc/mesh/output_file.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <array>
#include <cstdio>
#include <span>
#include <string_view>
#include <utility>

namespace scan2fea {
namespace {

void write_integer(TextOutput& out, std::uint64_t number, std::size_t width) {
  const std::string text = std::to_string(number);
  out << std::string_view("            ").substr(0, width - std::min(width, text.size())) << text;
}

void write_header(TextOutput& out, const TetMesh& mesh, const FileOptions& options) {
  out << "/COM, written by scan2fea\n";
  if (!options.provenance.empty()) out << "/COM, " << one_line(options.provenance).substr(0, 70) << "\n";
  if (!mesh.unit.empty()) out << "/COM, " << unit_comment(mesh.unit) << "\n";
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 6> labels{
      {{"m", "SI"}, {"cm", "CGS"}, {"mm", "MPA"}, {"um", "UMKS"}, {"in", "BIN"}, {"ft", "BFT"}}};
  for (const auto& [unit, label] : labels)
    if (length_unit(mesh.unit) == unit) out << "/UNITS," << label << "\n";
  out << "/PREP7\nET,1," << (mesh.order() == 2 ? 187 : 285) << "\n";
  if (!mesh.face_sets.empty()) out << "ET,2,154\n" << (mesh.order() == 2 ? "" : "KEYOPT,2,4,1\n");
}

void write_nodes(TextOutput& out, const std::vector<Vec3>& nodes, const Numbering& numbers) {
  out << "NBLOCK,6,SOLID," << numbers.largest_node(nodes.size()) << "," << nodes.size() << "\n(3i9,6e24.16e3)\n";
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    write_integer(out, numbers.node(n), 9);
    out << "        0        0";
    for (const double coordinate : nodes[n]) {
      std::array<char, 32> text{};
      std::snprintf(text.data(), text.size(), "%24.16E", coordinate);
      // Of three digits in the exponent, as the format says.
      std::string number(text.data());
      const std::size_t exponent = number.find('E') + 2;
      if (number.size() - exponent == 2) {
        number.insert(exponent, "0");
        number.erase(0, 1);
      }
      out << number;
    }
    out << "\n";
  }
  out << "N,R5.3,LOC,       -1,\n";
}

class Elements {
 public:
  Elements(TextOutput& out, std::size_t count, const Numbering& numbers) : out_(out), numbers_(numbers) {
    out_ << "EBLOCK,19,SOLID," << numbers_.largest_element(count) << "," << count << "\n(19i9)\n";
  }
  ~Elements() { out_ << "       -1\n"; }
  Elements(const Elements&) = delete;
  Elements& operator=(const Elements&) = delete;

  // Eleven numbers of the element, then eight nodes, the others on a line of their own.
  void write(std::uint64_t material, std::uint64_t type, std::uint64_t number, std::span<const std::uint32_t> nodes) {
    for (const std::uint64_t value :
         {material, type, std::uint64_t{1}, std::uint64_t{1}, std::uint64_t{0}, std::uint64_t{0}, std::uint64_t{0},
          std::uint64_t{0}, std::uint64_t{nodes.size()}, std::uint64_t{0}, number})
      write_integer(out_, value, 9);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      if (k == 8) out_ << "\n";
      write_integer(out_, numbers_.node(nodes[k]), 9);
    }
    out_ << "\n";
  }

 private:
  TextOutput& out_;
  const Numbering& numbers_;
};

// A triangle is a quadrilateral whose third node is repeated.
std::vector<std::uint32_t> surface_nodes(const TetMesh& mesh, BoundaryFace f) {
  const Triangle c = boundary_triangle(mesh, f);
  if (mesh.order() == 1) return {c[0], c[1], c[2], c[2]};
  const Triangle m = boundary_mid_edge_nodes(mesh, f);
  return {c[0], c[1], c[2], c[2], m[0], m[1], c[2], m[2]};
}

std::vector<std::uint64_t> write_elements(TextOutput& out, const TetMesh& mesh, const Numbering& numbering) {
  std::vector<std::uint64_t> numbers(mesh.boundary.size(), 0);  // of faces in sets
  for (const NamedSet& set : mesh.face_sets)
    for (const std::uint32_t f : set.members) numbers[f] = 1;
  std::size_t count = mesh.tetrahedra.size();
  for (std::uint64_t& n : numbers)
    if (n != 0) n = numbering.element(count++);
  // Of the named sets alone: EALL, the last one, is one more set of all.
  const SetParts parts =
      set_parts(std::span(mesh.element_sets).first(mesh.element_sets.size() - 1), mesh.tetrahedra.size());
  Elements elements(out, count, numbering);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    std::vector<std::uint32_t> nodes(mesh.tetrahedra[t].begin(), mesh.tetrahedra[t].end());
    if (mesh.order() == 2) nodes.insert(nodes.end(), mesh.mid_edge_nodes[t].begin(), mesh.mid_edge_nodes[t].end());
    elements.write(numbering.other(parts.part[t] + 1), 1, numbering.element(t), nodes);
  }
  for (std::size_t f = 0; f < numbers.size(); ++f)
    if (numbers[f] != 0) elements.write(numbering.other(1), 2, numbers[f], surface_nodes(mesh, mesh.boundary[f]));
  return numbers;
}

template <class Number>
void write_component(TextOutput& out, const std::string& name, const char* kind, const NamedSet& set,
                     const Number& number_of) {
  if (set.members.empty()) return;
  constexpr std::size_t per_line = 8;
  out << "CMBLOCK," << name << "," << kind << "," << set.members.size() << "\n(8i10)\n";
  for (std::size_t i = 0; i < set.members.size(); ++i) {
    write_integer(out, number_of(set.members[i]), 10);
    if (i + 1 == set.members.size() || (i + 1) % per_line == 0) out << "\n";
  }
}

}  // namespace

Notes write_cdb(const TetMesh& given, const std::filesystem::path& file, const FileOptions& options) {
  Notes notes;
  const TetMesh mesh = with_whole_sets(given, options.set_prefix, notes);
  // Components have one list of names.
  std::vector<NamedSet> sets = mesh.element_sets;
  sets.insert(sets.end(), mesh.face_sets.begin(), mesh.face_sets.end());
  sets.insert(sets.end(), mesh.node_sets.begin(), mesh.node_sets.end());
  const std::vector<std::string> names =
      names_for(sets, {.longest = 32, .upper_case = true, .allowed = "_", .keeps_reserved = true}, {}, notes);
  const std::size_t faces = mesh.element_sets.size(), nodes = faces + mesh.face_sets.size();
  OutputFiles files(options.together);
  OutputFile& output = files.open(file);
  {
    TextOutput out(output.stream());
    write_header(out, mesh, options);
    write_nodes(out, mesh.nodes, options.numbers);
    const std::vector<std::uint64_t> of_faces = write_elements(out, mesh, options.numbers);
    for (std::size_t s = 0; s < sets.size(); ++s)
      write_component(out, names[s], s < nodes ? "ELEM" : "NODE", sets[s], [&](std::uint32_t member) {
        if (s >= faces && s < nodes) return of_faces[member];
        return s < faces ? options.numbers.element(member) : options.numbers.node(member);
      });
    out << "FINISH\n";
  }
  files.commit();
  return notes;
}

}  // namespace scan2fea
