#include "export/text_output.hpp"
#include "export/vtu.hpp"
#include "preproc/mesh/output_file.hpp"

#include <algorithm>
#include <bit>

namespace scan2fea {
namespace {

constexpr std::uint8_t vtk_tetra = 10;
constexpr std::uint8_t vtk_quadratic_tetra = 24;

// A comment must not hold "--", and a parser refuses bytes that are not UTF-8, as paths may hold.
void write_comment(TextOutput& out, std::string_view text) {
  std::string line = one_line(text);
  std::replace_if(
      line.begin(), line.end(), [](unsigned char c) { return c >= 0x80; }, '?');
  for (std::size_t i = 1; i < line.size(); ++i)
    if (line[i] == '-' && line[i - 1] == '-') line.insert(i, 1, ' ');
  out << "<!-- " << line << " -->\n";
}

std::vector<double> coordinates(const TetMesh& mesh) {
  std::vector<double> values;
  values.reserve(3 * mesh.nodes.size());
  for (const Vec3& p : mesh.nodes) values.insert(values.end(), {p.x(), p.y(), p.z()});
  return values;
}

std::vector<std::int64_t> connectivity(const TetMesh& mesh) {
  std::vector<std::int64_t> values;
  values.reserve(mesh.tetrahedra.size() * (mesh.order() == 2 ? 10 : 4));
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    values.insert(values.end(), mesh.tetrahedra[t].begin(), mesh.tetrahedra[t].end());
    if (mesh.order() == 2) values.insert(values.end(), mesh.mid_edge_nodes[t].begin(), mesh.mid_edge_nodes[t].end());
  }
  return values;
}

template <class T>
void write_array(std::ostream& stream, const std::vector<T>& values) {
  const std::uint64_t bytes = values.size() * sizeof(T);
  stream.write(reinterpret_cast<const char*>(&bytes), sizeof bytes);
  stream.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(bytes));
}

template <class T>
std::uint64_t array_size(const std::vector<T>& values) {
  return sizeof(std::uint64_t) + values.size() * sizeof(T);
}

}  // namespace

void write_vtu(const TetMesh& mesh, const std::filesystem::path& file, const VtuOptions& options) {
  const std::vector<double> points = coordinates(mesh);
  const std::vector<std::int64_t> nodes = connectivity(mesh);
  std::vector<std::int64_t> offsets(mesh.tetrahedra.size());
  const std::int64_t per_cell = mesh.order() == 2 ? 10 : 4;
  for (std::size_t t = 0; t < offsets.size(); ++t) offsets[t] = per_cell * static_cast<std::int64_t>(t + 1);
  const std::vector<std::uint8_t> types(mesh.tetrahedra.size(), mesh.order() == 2 ? vtk_quadratic_tetra : vtk_tetra);

  OutputFile output(file);
  {
    TextOutput out(output.stream());
    out << "<?xml version=\"1.0\"?>\n";
    write_comment(out, "written by scan2fea");
    if (!options.provenance.empty()) write_comment(out, options.provenance);
    if (!options.unit.empty()) write_comment(out, "unit of length: " + options.unit);
    out << "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\""
        << (std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian")
        << "\" header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" << mesh.nodes.size()
        << "\" NumberOfCells=\"" << mesh.tetrahedra.size() << "\">\n";
    std::uint64_t offset = 0;
    const auto declare = [&](std::string_view type, std::string_view name, std::uint64_t size) {
      out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" format=\"appended\" offset=\"" << offset
          << "\"";
      if (name == "Points") out << " NumberOfComponents=\"3\"";
      out << "/>\n";
      offset += size;
    };
    out << "<Points>\n";
    declare("Float64", "Points", array_size(points));
    out << "</Points>\n<Cells>\n";
    declare("Int64", "connectivity", array_size(nodes));
    declare("Int64", "offsets", array_size(offsets));
    declare("UInt8", "types", array_size(types));
    out << "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
  }
  write_array(output.stream(), points);
  write_array(output.stream(), nodes);
  write_array(output.stream(), offsets);
  write_array(output.stream(), types);
  output.stream() << "\n</AppendedData>\n</VTKFile>\n";
  output.commit();
}

}  // namespace scan2fea
