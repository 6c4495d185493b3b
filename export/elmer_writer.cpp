#include "export/elmer.hpp"
#include "export/set_names.hpp"
#include "export/text_output.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/output_file.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <algorithm>
#include <map>
#include <span>

namespace scan2fea {
namespace {

constexpr int tetrahedron_4 = 504, tetrahedron_10 = 510, triangle_3 = 303, triangle_6 = 306;

void write_header(TextOutput& out, const TetMesh& mesh) {
  const bool second = mesh.order() == 2;
  out << mesh.nodes.size() << " " << mesh.tetrahedra.size() << " " << mesh.boundary.size() << "\n2\n"
      << (second ? tetrahedron_10 : tetrahedron_4) << " " << mesh.tetrahedra.size() << "\n"
      << (second ? triangle_6 : triangle_3) << " " << mesh.boundary.size() << "\n";
}

void write_nodes(TextOutput& out, const TetMesh& mesh) {
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    out << n + 1 << " -1";
    for (const double coordinate : mesh.nodes[n]) (out << " ").exact(coordinate);
    out << "\n";
  }
}

void write_elements(TextOutput& out, const TetMesh& mesh, const SetParts& bodies) {
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    out << t + 1 << " " << bodies.part[t] + 1 << " " << (mesh.order() == 2 ? tetrahedron_10 : tetrahedron_4);
    for (const std::uint32_t n : mesh.tetrahedra[t]) out << " " << std::uint64_t{n} + 1;
    if (mesh.order() == 2)
      for (const std::uint32_t n : mesh.mid_edge_nodes[t]) out << " " << std::uint64_t{n} + 1;
    out << "\n";
  }
}

// Numbers of the elements in front of faces between bodies, by face; 0 in front of the others.
std::vector<std::uint64_t> elements_in_front(const TetMesh& mesh) {
  std::map<Triangle, std::size_t> between;
  const auto sorted = [](Triangle corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
  };
  for (std::size_t f = mesh.outer_faces(); f < mesh.boundary.size(); ++f)
    between[sorted(boundary_triangle(mesh, mesh.boundary[f]))] = f;
  std::vector<std::uint64_t> in_front(mesh.boundary.size(), 0);
  for (std::uint32_t t = 0; !between.empty() && t < mesh.tetrahedra.size(); ++t)
    for (std::uint8_t k = 0; k < 4; ++k)
      if (const auto at = between.find(sorted(boundary_triangle(mesh, {t, k})));
          at != between.end() && mesh.boundary[at->second].tetrahedron != t)
        in_front[at->second] = std::uint64_t{t} + 1;
  return in_front;
}

void write_boundary(TextOutput& out, const TetMesh& mesh, const SetParts& boundaries) {
  const std::vector<std::uint64_t> in_front = elements_in_front(mesh);
  for (std::size_t f = 0; f < mesh.boundary.size(); ++f) {
    const BoundaryFace face = mesh.boundary[f];
    out << f + 1 << " " << boundaries.part[f] + 1 << " " << std::uint64_t{face.tetrahedron} + 1 << " " << in_front[f]
        << " " << (mesh.order() == 2 ? triangle_6 : triangle_3);
    for (const std::uint32_t n : boundary_triangle(mesh, face)) out << " " << std::uint64_t{n} + 1;
    if (mesh.order() == 2)
      for (const std::uint32_t n : boundary_mid_edge_nodes(mesh, face)) out << " " << std::uint64_t{n} + 1;
    out << "\n";
  }
}

// Elmer knows the names behind a `$`, which hold letters, digits and `_`; what they are made of is a comment.
void write_names(TextOutput& out, const char* kind, const std::string& rest, const SetParts& parts,
                 std::span<const std::string> names) {
  for (std::size_t part = 0; part < parts.of.size(); ++part) {
    std::string name = part == 0 ? rest : part_name(parts, part, names);
    out << "! " << kind << " " << part + 1 << " is " << name << "\n";
    std::replace(name.begin(), name.end(), part_name_joint, '_');
    out << "$ " << name << " = " << part + 1 << "\n";
  }
}

}  // namespace

Notes write_elmer(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options) {
  if (file.filename() != "mesh.header")
    throw WrongUsage({"Elmer wants the name mesh.header", file.string(), {}, {}, "FOLDER/mesh.header"});
  Notes notes;
  const NameRules rules{.longest = 60, .upper_case = false, .allowed = "_", .starts_with_letter = true};
  const std::vector<std::string> bodies = names_for(mesh.element_sets, rules, {}, notes);
  const std::vector<std::string> boundaries = names_for(mesh.face_sets, rules, bodies, notes);
  const SetParts of_elements = set_parts(mesh.element_sets, mesh.tetrahedra.size());
  const SetParts of_faces = set_parts(mesh.face_sets, mesh.boundary.size());
  const std::filesystem::path folder = file.parent_path();
  OutputFiles files(options.together);
  {
    const auto open = [&](const char* name) -> std::ostream& { return files.open(folder / name).stream(); };
    TextOutput of_nodes(open("mesh.nodes")), elements_out(open("mesh.elements")), boundary_out(open("mesh.boundary")),
        out(open("mesh.names")), of_header(files.open(file).stream());
    write_header(of_header, mesh);
    write_nodes(of_nodes, mesh);
    write_elements(elements_out, mesh, of_elements);
    write_boundary(boundary_out, mesh, of_faces);
    out << "! written by scan2fea\n";
    if (!options.provenance.empty()) out << "! " << one_line(options.provenance) << "\n";
    if (!mesh.unit.empty()) out << "! " << unit_comment(mesh.unit) << "\n";
    write_names(out, "body", options.set_prefix + "EALL", of_elements, bodies);
    write_names(out, "boundary", options.set_prefix + "SALL", of_faces, boundaries);
  }
  files.commit();
  return notes;
}

}  // namespace scan2fea
