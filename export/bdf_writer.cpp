#include "export/bdf.hpp"
#include "export/number_text.hpp"
#include "export/set_names.hpp"
#include "export/text_output.hpp"
#include "preproc/mesh/output_file.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <algorithm>
#include <cctype>
#include <span>

namespace scan2fea {
namespace {

constexpr NameRules rules{
    .longest = 60, .upper_case = false, .allowed = "_-.", .starts_with_letter = true, .keeps_reserved = true};

// A surface's file has no sets but those that have names.
NameRules surface_rules() {
  NameRules without = rules;
  without.keeps_reserved = false;
  return without;
}

// Comments end at column 80 for some readers.
void write_comment(TextOutput& out, std::string_view text) {
  const std::string line = one_line(text);
  for (std::size_t i = 0; i < line.size(); i += 78) out << "$ " << std::string_view(line).substr(i, 78) << "\n";
}

// Cards in fields of eight characters, continued after eight of them.
class Card {
 public:
  Card(TextOutput& out, std::string_view name) : out_(out) { write(name); }
  ~Card() { out_ << "\n"; }
  Card(const Card&) = delete;
  Card& operator=(const Card&) = delete;

  Card& operator<<(std::uint64_t number) { return *this << std::to_string(number); }
  Card& operator<<(const std::string& text) {
    constexpr int fields_per_line = 8;
    if (fields_ == fields_per_line) {
      out_ << "\n";
      write("+");
      fields_ = 0;
    }
    ++fields_;
    write(text);
    return *this;
  }

 private:
  void write(std::string_view text) {
    constexpr std::string_view blanks = "        ";
    out_ << text;
    if (text.size() < blanks.size()) out_ << blanks.substr(text.size());
  }

  TextOutput& out_;
  int fields_ = 0;
};

// Of the card's name and two or three fields of sixteen.
void write_grid(TextOutput& out, std::size_t number, const Vec3& p) {
  const auto wide = [&](std::string text) {
    text.resize(16, ' ');
    out << text;
  };
  const auto real = [](double value) {
    char text[nastran_width];
    return std::string(text, write_nastran_number(text, value));
  };
  out << "GRID*   ";
  wide(std::to_string(number));
  wide("");
  wide(real(p.x()));
  wide(real(p.y()));
  out << "\n*       " << real(p.z()) << "\n";
}

void write_header(TextOutput& out, const std::vector<Vec3>& nodes, const std::string& unit,
                  const FileOptions& options) {
  write_comment(out, "written by scan2fea for Nastran");
  if (!options.provenance.empty()) write_comment(out, options.provenance);
  if (!unit.empty()) write_comment(out, unit_comment(unit));
  out << "BEGIN BULK\n";
  for (std::size_t n = 0; n < nodes.size(); ++n) write_grid(out, options.numbers.node(n), nodes[n]);
}

void write_properties(TextOutput& out, std::string_view card, const SetParts& parts, std::span<const std::string> names,
                      const Numbering& numbers) {
  for (std::size_t part = 0; part < parts.of.size(); ++part) {
    if (std::find(parts.part.begin(), parts.part.end(), part) == parts.part.end()) continue;
    if (part > 0)
      write_comment(out, std::string(card) + " " + std::to_string(numbers.other(part + 1)) + " is " +
                             part_name(parts, part, names));
    if (card == "PSHELL")
      Card(out, card) << numbers.other(part + 1) << std::uint64_t{1} << std::string("1.");
    else
      Card(out, card) << numbers.other(part + 1) << std::uint64_t{1};
  }
}

void write_nodes_of_set(TextOutput& out, std::size_t number, std::span<const std::uint32_t> nodes,
                        const Numbering& numbers) {
  if (nodes.empty()) return;
  Card set(out, "SET1");
  set << number;
  for (const std::uint32_t n : nodes) set << numbers.node(n);
}

void write_clamp(TextOutput& out, std::size_t number, std::span<const std::uint32_t> nodes, const Numbering& numbers) {
  if (nodes.empty()) return;
  Card clamp(out, "SPC1");
  clamp << number << std::string("123");
  for (const std::uint32_t n : nodes) clamp << numbers.node(n);
}

void write_node_sets(TextOutput& out, std::span<const NamedSet> sets, std::span<const std::string> names,
                     std::size_t first, const FileOptions& options) {
  for (std::size_t s = 0; s < sets.size(); ++s) {
    write_comment(out, "SET1 " + std::to_string(first + s) + " is " + names[s]);
    write_nodes_of_set(out, first + s, sets[s].members, options.numbers);
    if (!is_whole_set(names[s], options.set_prefix))
      write_clamp(out, first + s, sets[s].members, options.numbers);  // nobody clamps all
  }
}

// PLOAD4 tells the face of a CTETRA by one of its corners and the corner opposite to it.
void write_face_sets(TextOutput& out, const TetMesh& mesh, std::span<const std::string> names, std::size_t first,
                     const FileOptions& options) {
  for (std::size_t s = 0; s < mesh.face_sets.size(); ++s) {
    const NamedSet& set = mesh.face_sets[s];
    const std::size_t number = first + s;
    write_comment(out, "PLOAD4 " + std::to_string(number) + " is " + names[s]);
    for (const std::uint32_t i : set.members) {
      const BoundaryFace f = mesh.boundary[i];
      const Tetrahedron& corners = mesh.tetrahedra[f.tetrahedron];
      const auto& face = tetrahedron_faces[f.face];
      const auto opposite = static_cast<std::size_t>(6 - face[0] - face[1] - face[2]);  // corners are 0 to 3
      Card load(out, "PLOAD4");
      load << number << options.numbers.element(f.tetrahedron) << std::string("1.") << std::string() << std::string()
           << std::string() << options.numbers.node(corners[static_cast<std::size_t>(face[0])])
           << options.numbers.node(corners[opposite]);
    }
    const std::vector<std::uint32_t> nodes = nodes_of_faces(mesh, set.members);
    write_nodes_of_set(out, number, nodes, options.numbers);
    if (!is_whole_set(names[s], options.set_prefix)) write_clamp(out, number, nodes, options.numbers);
  }
}

}  // namespace

Notes write_bdf(const TetMesh& given, const std::filesystem::path& file, const FileOptions& options) {
  Notes notes;
  TetMesh mesh = with_whole_sets(given, options.set_prefix, notes);
  mesh.element_sets.pop_back();  // every element has one property, so EALL is what all cards of CTETRA are
  const std::vector<std::string> elements = names_for(mesh.element_sets, rules, {}, notes);
  const std::vector<std::string> faces = names_for(mesh.face_sets, rules, {}, notes);
  const std::vector<std::string> nodes = names_for(mesh.node_sets, rules, {}, notes);
  const SetParts parts = set_parts(mesh.element_sets, mesh.tetrahedra.size());
  OutputFiles files(options.together);
  OutputFile& output = files.open(file);
  {
    TextOutput out(output.stream());
    write_header(out, mesh.nodes, mesh.unit, options);
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
      Card element(out, "CTETRA");
      element << options.numbers.element(t) << options.numbers.other(parts.part[t] + 1);
      for (const std::uint32_t n : mesh.tetrahedra[t]) element << options.numbers.node(n);
      if (mesh.order() == 2)
        for (const std::uint32_t n : mesh.mid_edge_nodes[t]) element << options.numbers.node(n);
    }
    write_properties(out, "PSOLID", parts, elements, options.numbers);
    write_node_sets(out, mesh.node_sets, nodes, options.numbers.other(1), options);
    write_face_sets(out, mesh, faces, options.numbers.other(1 + mesh.node_sets.size()), options);
    out << "ENDDATA\n";
  }
  files.commit();
  return notes;
}

Notes write_bdf(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options) {
  Notes notes;
  const std::vector<std::string> faces = names_for(surface.face_sets, surface_rules(), {}, notes);
  const std::vector<std::string> nodes = names_for(surface.node_sets, surface_rules(), {}, notes);
  const SetParts parts = set_parts(surface.face_sets, surface.mesh.triangles.size());
  OutputFiles files(options.together);
  OutputFile& output = files.open(file);
  {
    TextOutput out(output.stream());
    write_header(out, surface.mesh.vertices, surface.unit, options);
    for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t) {
      Card element(out, "CTRIA3");
      element << options.numbers.element(t) << options.numbers.other(parts.part[t] + 1);
      for (const std::uint32_t v : surface.mesh.triangles[t]) element << options.numbers.node(v);
    }
    write_properties(out, "PSHELL", parts, faces, options.numbers);
    write_node_sets(out, surface.node_sets, nodes, options.numbers.other(1), options);
    out << "ENDDATA\n";
  }
  files.commit();
  return notes;
}

}  // namespace scan2fea
