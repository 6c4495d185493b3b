#include "export/inp.hpp"
#include "export/text_output.hpp"
#include "preproc/mesh/output_file.hpp"

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

void write_header(TextOutput& out, const TetMesh& mesh, const InpOptions& options) {
  write_comment(out, "written by scan2fea for Abaqus and CalculiX");
  if (!options.provenance.empty()) write_comment(out, options.provenance);
  if (!options.unit.empty()) write_comment(out, "unit of length: " + options.unit);
  const BoundingBox box = bounding_box(mesh.nodes);
  out << "** bounding box, low:  " << box.low.x() << " " << box.low.y() << " " << box.low.z() << "\n";
  out << "** bounding box, high: " << box.high.x() << " " << box.high.y() << " " << box.high.z() << "\n";
  out << "** " << mesh.nodes.size() << " nodes, " << mesh.tetrahedra.size() << " tetrahedra, " << mesh.boundary.size()
      << " boundary faces\n";
  write_comment(out, "sets: NALL (nodes), EALL (elements), SALL (surface), SALL_NODES (nodes of the surface)");
}

void write_nodes(TextOutput& out, const TetMesh& mesh) {
  out << "*NODE, NSET=NALL\n";
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const Vec3& p = mesh.nodes[n];
    out << n + 1 << ", " << p.x() << ", " << p.y() << ", " << p.z() << "\n";
  }
}

void write_elements(TextOutput& out, const TetMesh& mesh) {
  out << (mesh.order() == 2 ? "*ELEMENT, TYPE=C3D10, ELSET=EALL\n" : "*ELEMENT, TYPE=C3D4, ELSET=EALL\n");
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    out << t + 1;
    for (const std::uint32_t n : mesh.tetrahedra[t]) out << "," << std::uint64_t{n} + 1;
    if (mesh.order() == 2)
      for (const std::uint32_t n : mesh.mid_edge_nodes[t]) out << "," << std::uint64_t{n} + 1;
    out << "\n";
  }
}

// Ten numbers of up to ten digits and their commas keep within a line of CalculiX.
void write_numbers(TextOutput& out, const std::vector<std::uint32_t>& indices) {
  constexpr std::size_t per_line = 10;
  for (std::size_t i = 0; i < indices.size(); ++i)
    out << std::uint64_t{indices[i]} + 1 << (i + 1 == indices.size() || (i + 1) % per_line == 0 ? "\n" : ", ");
}

void write_surface_set(TextOutput& out, const TetMesh& mesh, const std::string& name,
                       std::span<const std::uint32_t> faces) {
  if (faces.empty()) return;
  std::array<std::vector<std::uint32_t>, 4> elements;
  for (const std::uint32_t i : faces) elements[mesh.boundary[i].face].push_back(mesh.boundary[i].tetrahedron);
  for (std::size_t f = 0; f < 4; ++f) {
    if (elements[f].empty()) continue;
    std::sort(elements[f].begin(), elements[f].end());
    out << "*ELSET, ELSET=" << name << "_S" << f + 1 << "\n";
    write_numbers(out, elements[f]);
  }
  out << "*SURFACE, NAME=" << name << ", TYPE=ELEMENT\n";
  for (std::size_t f = 0; f < 4; ++f)
    if (!elements[f].empty()) out << name << "_S" << f + 1 << ", S" << f + 1 << "\n";
  out << "*NSET, NSET=" << name << "_NODES\n";
  write_numbers(out, nodes_of_faces(mesh, faces));
}

void write_boundary(TextOutput& out, const TetMesh& mesh) {
  if (mesh.boundary.empty()) return;
  std::vector<std::uint32_t> all(mesh.boundary.size());
  std::iota(all.begin(), all.end(), 0U);
  write_surface_set(out, mesh, "SALL", all);
  for (const NamedSet& set : mesh.face_sets) write_surface_set(out, mesh, set.name, set.members);
}

}  // namespace

void write_inp(const TetMesh& mesh, const std::filesystem::path& file, const InpOptions& options) {
  OutputFile output(file);
  {
    TextOutput out(output.stream());
    write_header(out, mesh, options);
    write_nodes(out, mesh);
    write_elements(out, mesh);
    write_boundary(out, mesh);
  }
  output.commit();
}

}  // namespace scan2fea
