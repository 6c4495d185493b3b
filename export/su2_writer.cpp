#include "export/set_names.hpp"
#include "export/su2.hpp"
#include "export/text_output.hpp"
#include "preproc/mesh/output_file.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <algorithm>

namespace scan2fea {

Notes write_su2(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options) {
  Notes notes;
  const std::vector<std::string> names =
      names_for(mesh.face_sets, {.longest = 60, .upper_case = false, .allowed = "_-."}, {}, notes);
  const SetParts parts = set_parts(mesh.face_sets, mesh.boundary.size());
  std::vector<std::vector<std::uint32_t>> markers(parts.of.size());
  for (std::uint32_t f = 0; f < mesh.boundary.size(); ++f) markers[parts.part[f]].push_back(f);
  OutputFiles files(options.together);
  OutputFile& output = files.open(file);
  {
    TextOutput out(output.stream());
    out << "% written by scan2fea\n";
    if (!options.provenance.empty()) out << "% " << one_line(options.provenance) << "\n";
    if (!mesh.unit.empty()) out << "% " << unit_comment(mesh.unit) << "\n";
    out << "NDIME= 3\nNELEM= " << mesh.tetrahedra.size() << "\n";
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
      out << "10";
      for (const std::uint32_t n : mesh.tetrahedra[t]) out << " " << n;
      out << " " << t << "\n";
    }
    out << "NPOIN= " << mesh.nodes.size() << "\n";
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
      for (const double coordinate : mesh.nodes[n]) out.exact(coordinate) << " ";
      out << n << "\n";
    }
    out << "NMARK= " << std::count_if(markers.begin(), markers.end(), [](const auto& m) { return !m.empty(); }) << "\n";
    for (std::size_t part = 0; part < markers.size(); ++part) {
      if (markers[part].empty()) continue;
      out << "MARKER_TAG= " << (part == 0 ? options.set_prefix + "SALL" : part_name(parts, part, names))
          << "\nMARKER_ELEMS= " << markers[part].size() << "\n";
      for (const std::uint32_t f : markers[part]) {
        out << "5";
        for (const std::uint32_t n : boundary_triangle(mesh, mesh.boundary[f])) out << " " << n;
        out << "\n";
      }
    }
  }
  files.commit();
  return notes;
}

}  // namespace scan2fea
