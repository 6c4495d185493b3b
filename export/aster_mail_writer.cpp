#include "export/aster_mail.hpp"
#include "export/set_names.hpp"
#include "export/text_output.hpp"
#include "preproc/mesh/output_file.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <charconv>
#include <span>

namespace scan2fea {
namespace {

// Words of a section, in lines of at most 80 characters.
class Words {
 public:
  explicit Words(TextOutput& out) : out_(out) {}

  Words& operator<<(const std::string& word) {
    constexpr std::size_t longest = 80;
    if (column_ + 1 + word.size() > longest) end_line();
    out_ << " " << word;
    column_ += 1 + word.size();
    return *this;
  }
  void end_line() {
    if (column_ > 0) out_ << "\n";
    column_ = 0;
  }

 private:
  TextOutput& out_;
  std::size_t column_ = 0;
};

std::string node(std::uint64_t number) {
  return "N" + std::to_string(number);
}

std::string element(std::uint64_t number) {
  return "M" + std::to_string(number);
}

std::string exact(double value) {
  char text[32];
  return {text, std::to_chars(text, std::end(text), value).ptr};
}

void write_nodes(TextOutput& out, const std::vector<Vec3>& nodes, const Numbering& numbers) {
  out << "COOR_3D\n";
  Words words(out);
  for (std::uint32_t n = 0; n < nodes.size(); ++n) {
    words << node(numbers.node(n)) << exact(nodes[n].x()) << exact(nodes[n].y()) << exact(nodes[n].z());
    words.end_line();
  }
  out << "FINSF\n";
}

void write_tetrahedra(TextOutput& out, const TetMesh& mesh, const Numbering& numbers) {
  out << (mesh.order() == 2 ? "TETRA10\n" : "TETRA4\n");
  Words words(out);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    words << element(numbers.element(t));
    for (const std::uint32_t n : mesh.tetrahedra[t]) words << node(numbers.node(n));
    if (mesh.order() == 2)
      for (const std::uint32_t n : mesh.mid_edge_nodes[t]) words << node(numbers.node(n));
    words.end_line();
  }
  out << "FINSF\n";
}

// Those that are in sets; numbers behind the tetrahedra's.
std::vector<std::uint64_t> write_triangles(TextOutput& out, const TetMesh& mesh, const Numbering& numbering) {
  std::vector<std::uint64_t> numbers(mesh.boundary.size(), 0);
  bool any = false;
  for (const NamedSet& set : mesh.face_sets)
    for (const std::uint32_t f : set.members) {
      numbers[f] = 1;
      any = true;
    }
  if (!any) return numbers;
  out << (mesh.order() == 2 ? "TRIA6\n" : "TRIA3\n");
  Words words(out);
  std::uint64_t number = numbering.element(mesh.tetrahedra.size());
  for (std::size_t f = 0; f < numbers.size(); ++f) {
    if (numbers[f] == 0) continue;
    numbers[f] = number++;
    words << element(numbers[f]);
    for (const std::uint32_t n : boundary_triangle(mesh, mesh.boundary[f])) words << node(numbering.node(n));
    if (mesh.order() == 2)
      for (const std::uint32_t n : boundary_mid_edge_nodes(mesh, mesh.boundary[f])) words << node(numbering.node(n));
    words.end_line();
  }
  out << "FINSF\n";
  return numbers;
}

template <class Name>
void write_groups(TextOutput& out, const char* keyword, std::span<const NamedSet> sets,
                  std::span<const std::string> names, const Name& name_of) {
  for (std::size_t s = 0; s < sets.size(); ++s) {
    if (sets[s].members.empty()) continue;
    out << keyword << " NOM = " << names[s] << "\n";
    Words words(out);
    for (const std::uint32_t m : sets[s].members) words << name_of(m);
    words.end_line();
    out << "FINSF\n";
  }
}

// Sets of faces are groups of elements, too.
WrittenNames names_of_whole(const TetMesh& mesh, Notes& notes) {
  const NameRules rules{
      .longest = 24, .upper_case = false, .allowed = "_", .starts_with_letter = true, .keeps_reserved = true};
  WrittenNames names{.nodes = {}, .faces = {}, .elements = names_for(mesh.element_sets, rules, {}, notes)};
  names.faces = names_for(mesh.face_sets, rules, names.elements, notes);
  names.nodes = names_for(mesh.node_sets, rules, {}, notes);
  return names;
}

}  // namespace

WrittenNames names_in_mail(const TetMesh& mesh, const std::string& prefix, Notes& notes) {
  TetMesh sets;  // the mesh itself is not needed
  sets.node_sets = mesh.node_sets;
  sets.face_sets = mesh.face_sets;
  sets.element_sets = mesh.element_sets;
  return names_of_whole(with_whole_sets(sets, prefix, notes), notes);
}

Notes write_mail(const TetMesh& given, const std::filesystem::path& file, const FileOptions& options) {
  Notes notes;
  const TetMesh mesh = with_whole_sets(given, options.set_prefix, notes);
  const WrittenNames names = names_of_whole(mesh, notes);
  OutputFiles files(options.together);
  OutputFile& output = files.open(file);
  {
    TextOutput out(output.stream());
    out << "% written by scan2fea\n";
    if (!options.provenance.empty()) out << "% " << one_line(options.provenance).substr(0, 76) << "\n";
    if (!mesh.unit.empty()) out << "% " << unit_comment(mesh.unit) << "\n";
    const Numbering& numbers = options.numbers;
    write_nodes(out, mesh.nodes, numbers);
    write_tetrahedra(out, mesh, numbers);
    const std::vector<std::uint64_t> triangles = write_triangles(out, mesh, numbers);
    write_groups(out, "GROUP_MA", mesh.element_sets, names.elements,
                 [&](std::uint32_t t) { return element(numbers.element(t)); });
    write_groups(out, "GROUP_MA", mesh.face_sets, names.faces, [&](std::uint32_t f) { return element(triangles[f]); });
    write_groups(out, "GROUP_NO", mesh.node_sets, names.nodes, [&](std::uint32_t n) { return node(numbers.node(n)); });
    out << "FIN\n";
  }
  files.commit();
  return notes;
}

}  // namespace scan2fea
