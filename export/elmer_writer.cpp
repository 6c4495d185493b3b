#include "export/elmer.hpp"
#include "export/partition.hpp"
#include "export/set_names.hpp"
#include "export/text_output.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/output_file.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <span>

namespace scan2fea {
namespace {

constexpr int tetrahedron_4 = 504, tetrahedron_10 = 510, triangle_3 = 303, triangle_6 = 306;

// What one part of the mesh holds, and behind `shared` how many of its nodes other parts have, too.
void write_header(TextOutput& out, const TetMesh& mesh, const MeshPart& part, std::size_t faces,
                  std::optional<std::size_t> shared) {
  const bool second = mesh.order() == 2;
  out << part.nodes.size() << " " << part.elements << " " << faces << "\n"
      << (faces > 0 ? 2 : 1) << "\n"
      << (second ? tetrahedron_10 : tetrahedron_4) << " " << part.elements << "\n";
  if (faces > 0) out << (second ? triangle_6 : triangle_3) << " " << faces << "\n";
  if (shared) out << *shared << " 0\n";
}

void write_nodes(TextOutput& out, const TetMesh& mesh, const MeshPart& part) {
  for (const std::uint32_t n : part.nodes) {
    out << std::uint64_t{n} + 1 << " -1";
    for (const double coordinate : mesh.nodes[n]) (out << " ").exact(coordinate);
    out << "\n";
  }
}

void write_elements(TextOutput& out, const TetMesh& mesh, const MeshPart& part, const SetParts& bodies) {
  for (std::size_t t = part.first_element; t < std::size_t{part.first_element} + part.elements; ++t) {
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

// A face with the elements behind it and in front of it, of which 0 stands for none, and for one in another part.
struct ElmerFace {
  std::uint32_t face;
  std::uint64_t behind, in_front;
};

void write_boundary(TextOutput& out, const TetMesh& mesh, std::span<const ElmerFace> faces,
                    const SetParts& boundaries) {
  for (const auto& [f, behind, in_front] : faces) {
    out << f + 1 << " " << boundaries.part[f] + 1 << " " << behind << " " << in_front << " "
        << (mesh.order() == 2 ? triangle_6 : triangle_3);
    for (const std::uint32_t n : boundary_triangle(mesh, mesh.boundary[f])) out << " " << std::uint64_t{n} + 1;
    if (mesh.order() == 2)
      for (const std::uint32_t n : boundary_mid_edge_nodes(mesh, mesh.boundary[f])) out << " " << std::uint64_t{n} + 1;
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

// With nodes that no element uses, too, so that their numbers have no gaps.
MeshPart whole_mesh(const TetMesh& mesh) {
  MeshPart whole{.first_element = 0,
                 .elements = static_cast<std::uint32_t>(mesh.tetrahedra.size()),
                 .nodes = std::vector<std::uint32_t>(mesh.nodes.size()),
                 .faces = {}};
  std::iota(whole.nodes.begin(), whole.nodes.end(), 0U);
  return whole;
}

// What all files of a mesh are made of.
struct Sources {
  const TetMesh& mesh;
  const SetParts &bodies, &boundaries;
  std::vector<std::uint64_t> in_front;  // see elements_in_front
};

// The faces of the elements of a part. One between two bodies whose elements are in two parts is in both of them.
std::vector<ElmerFace> faces_of(const Sources& of, const MeshPart& part) {
  const std::uint64_t first = std::uint64_t{part.first_element} + 1, end = first + part.elements;
  const auto own = [&](std::uint64_t element) { return element >= first && element < end ? element : 0; };
  std::vector<ElmerFace> faces;
  for (std::uint32_t f = 0; f < of.mesh.boundary.size(); ++f) {
    const ElmerFace face{f, own(std::uint64_t{of.mesh.boundary[f].tetrahedron} + 1), own(of.in_front[f])};
    if (face.behind != 0 || face.in_front != 0) faces.push_back(face);
  }
  return faces;
}

// The parts, from 1 on, that have each node; the first one owns it.
std::vector<std::vector<std::size_t>> parts_of_nodes(const TetMesh& mesh, std::span<const MeshPart> parts) {
  std::vector<std::vector<std::size_t>> of(mesh.nodes.size());
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (const std::uint32_t n : parts[p].nodes) of[n].push_back(p + 1);
  return of;
}

// Each shared node, how many parts have it, and these. Returns how many nodes these are.
std::size_t write_shared(TextOutput& out, const MeshPart& part, const std::vector<std::vector<std::size_t>>& parts_of) {
  std::size_t count = 0;
  for (const std::uint32_t n : part.nodes) {
    if (parts_of[n].size() < 2) continue;
    out << std::uint64_t{n} + 1 << " " << parts_of[n].size();
    for (const std::size_t p : parts_of[n]) out << " " << p;
    out << "\n";
    ++count;
  }
  return count;
}

// Each file is closed when it is whole, since there may be many.
template <class Write>
void write_file(OutputFiles& files, const std::filesystem::path& name, const Write& write) {
  OutputFile& file = files.open(name, OutputFile::Folder::is_made);
  {
    TextOutput out(file.stream());
    write(out);
  }
  file.finish();
}

void write_parts(const Sources& of, std::span<const MeshPart> parts, const std::filesystem::path& header,
                 OutputFiles& files) {
  const std::vector<std::vector<std::size_t>> parts_of = parts_of_nodes(of.mesh, parts);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const std::array<std::filesystem::path, 5> names = files_of_elmer_part(header, parts.size(), p + 1);
    const MeshPart& part = parts[p];
    const std::vector<ElmerFace> faces = faces_of(of, part);
    std::size_t shared = 0;
    write_file(files, names[1], [&](TextOutput& out) { write_nodes(out, of.mesh, part); });
    write_file(files, names[2], [&](TextOutput& out) { write_elements(out, of.mesh, part, of.bodies); });
    write_file(files, names[3], [&](TextOutput& out) { write_boundary(out, of.mesh, faces, of.boundaries); });
    write_file(files, names[4], [&](TextOutput& out) { shared = write_shared(out, part, parts_of); });
    write_file(files, names[0], [&](TextOutput& out) { write_header(out, of.mesh, part, faces.size(), shared); });
  }
}

}  // namespace

std::array<std::filesystem::path, 5> files_of_elmer_part(const std::filesystem::path& header, std::size_t parts,
                                                         std::size_t part) {
  const std::filesystem::path folder = header.parent_path() / ("partitioning." + std::to_string(parts));
  const std::string name = "part." + std::to_string(part);
  return {folder / (name + ".header"), folder / (name + ".nodes"), folder / (name + ".elements"),
          folder / (name + ".boundary"), folder / (name + ".shared")};
}

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
  const Sources sources{mesh, of_elements, of_faces, elements_in_front(mesh)};
  const MeshPart whole = whole_mesh(mesh);
  OutputFiles files(options.together);
  {
    const auto open = [&](const char* name) -> std::ostream& { return files.open(folder / name).stream(); };
    TextOutput of_nodes(open("mesh.nodes")), elements_out(open("mesh.elements")), boundary_out(open("mesh.boundary")),
        out(open("mesh.names")), of_header(files.open(file).stream());
    write_header(of_header, mesh, whole, mesh.boundary.size(), {});
    write_nodes(of_nodes, mesh, whole);
    write_elements(elements_out, mesh, whole, of_elements);
    write_boundary(boundary_out, mesh, faces_of(sources, whole), of_faces);
    out << "! written by scan2fea\n";
    if (!options.provenance.empty()) out << "! " << one_line(options.provenance) << "\n";
    if (!mesh.unit.empty()) out << "! " << unit_comment(mesh.unit) << "\n";
    write_names(out, "body", options.set_prefix + "EALL", of_elements, bodies);
    write_names(out, "boundary", options.set_prefix + "SALL", of_faces, boundaries);
  }
  if (!options.part_sizes.empty()) write_parts(sources, parts_of(mesh, options.part_sizes), file, files);
  files.commit();
  return notes;
}

}  // namespace scan2fea
