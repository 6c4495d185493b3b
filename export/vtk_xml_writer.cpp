#include "export/set_names.hpp"
#include "export/text_output.hpp"
#include "export/vtk.hpp"
#include "export/vtk_cells.hpp"
#include "preproc/mesh/output_file.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <algorithm>
#include <bit>
#include <span>

namespace scan2fea {
namespace {

// Arrays of one section, in the bytes of the file.
struct Array {
  std::string type, name;
  int components;
  std::string bytes;
};

template <class T>
Array array_of(const char* type, std::string name, const std::vector<T>& values, int components = 1) {
  return {type, std::move(name), components,
          std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T))};
}

struct Section {
  std::string tag;
  std::vector<Array> arrays;
  std::string shown = {};  // the array that a viewer colours by at first
};

// Without the characters that XML has a meaning for.
constexpr NameRules rules{.longest = 200, .upper_case = false, .allowed = " _-.+:/()", .starts_with_letter = true};

Array coordinates(const std::vector<Vec3>& points) {
  std::vector<double> values;
  values.reserve(3 * points.size());
  for (const Vec3& p : points) values.insert(values.end(), {p.x(), p.y(), p.z()});
  return array_of("Float64", "Points", values, 3);
}

std::vector<Array> membership(std::string_view prefix, std::span<const NamedSet> sets, std::size_t members,
                              Notes& notes) {
  std::vector<Array> arrays;
  const std::vector<std::string> names = names_for(sets, rules, {}, notes);
  for (std::size_t s = 0; s < sets.size(); ++s) {
    std::vector<std::uint8_t> is_member(members, 0);
    for (const std::uint32_t m : sets[s].members) is_member[m] = 1;
    arrays.push_back(array_of("UInt8", std::string(prefix) + names[s], is_member));
  }
  return arrays;
}

std::vector<Array> faces_of_cells(const TetMesh& mesh, Notes& notes) {
  std::vector<Array> arrays;
  const std::vector<std::string> names = names_for(mesh.face_sets, rules, {}, notes);
  for (std::size_t s = 0; s < mesh.face_sets.size(); ++s) {
    std::vector<std::uint8_t> faces(mesh.tetrahedra.size(), 0);
    for (const std::uint32_t i : mesh.face_sets[s].members) {
      const BoundaryFace f = mesh.boundary[i];
      faces[f.tetrahedron] = static_cast<std::uint8_t>(faces[f.tetrahedron] | 1U << f.face);
    }
    arrays.push_back(array_of("UInt8", std::string(vtk_face_set) + names[s], faces));
  }
  return arrays;
}

Array array_of(const Field& field) {
  if (field.names.empty()) return array_of("Float64", field.name, field.values);
  std::vector<std::int32_t> numbers;
  numbers.reserve(field.values.size());
  for (const double value : field.values) numbers.push_back(static_cast<std::int32_t>(value));
  return array_of("Int32", field.name, numbers);
}

// Of the fields the first is shown.
Section data_section(const char* tag, std::vector<Array> arrays, const std::vector<Field>& fields) {
  for (const Field& field : fields) arrays.push_back(array_of(field));
  return {tag, std::move(arrays), fields.empty() ? "" : fields.front().name};
}

std::vector<std::int64_t> ends(std::size_t cells, std::int64_t per_cell) {
  std::vector<std::int64_t> offsets(cells);
  for (std::size_t c = 0; c < cells; ++c) offsets[c] = per_cell * static_cast<std::int64_t>(c + 1);
  return offsets;
}

std::vector<Array> cells_of(const TetMesh& mesh) {
  std::vector<std::int64_t> nodes;
  nodes.reserve(mesh.tetrahedra.size() * (mesh.order() == 2 ? 10 : 4));
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    nodes.insert(nodes.end(), mesh.tetrahedra[t].begin(), mesh.tetrahedra[t].end());
    if (mesh.order() == 2) nodes.insert(nodes.end(), mesh.mid_edge_nodes[t].begin(), mesh.mid_edge_nodes[t].end());
  }
  const auto type = static_cast<std::uint8_t>(mesh.order() == 2 ? vtk_quadratic_tetra : vtk_tetra);
  return {array_of("Int64", "connectivity", nodes),
          array_of("Int64", "offsets", ends(mesh.tetrahedra.size(), mesh.order() == 2 ? 10 : 4)),
          array_of("UInt8", "types", std::vector<std::uint8_t>(mesh.tetrahedra.size(), type))};
}

std::vector<Array> cells_of(const SurfaceMesh& mesh, bool with_types) {
  std::vector<std::int64_t> nodes;
  nodes.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) nodes.insert(nodes.end(), t.begin(), t.end());
  std::vector<Array> arrays{array_of("Int64", "connectivity", nodes),
                            array_of("Int64", "offsets", ends(mesh.triangles.size(), 3))};
  if (with_types)
    arrays.push_back(
        array_of("UInt8", "types", std::vector<std::uint8_t>(mesh.triangles.size(), std::uint8_t{vtk_triangle})));
  return arrays;
}

// A comment must not hold "--", and a parser refuses bytes that are not UTF-8, as paths may hold.
void write_comment(TextOutput& out, std::string_view text) {
  std::string line = one_line(text);
  std::replace_if(
      line.begin(), line.end(), [](unsigned char c) { return c >= 0x80; }, '?');
  for (std::size_t i = 1; i < line.size(); ++i)
    if (line[i] == '-' && line[i - 1] == '-') line.insert(i, 1, ' ');
  out << "<!-- " << line << " -->\n";
}

// `counts`: the attributes of the piece.
void write(const std::string& type, const std::string& counts, const std::vector<Section>& sections,
           const std::string& unit, const std::filesystem::path& file, const FileOptions& options) {
  OutputFiles files(options.together);
  OutputFile& output = files.open(file);
  {
    TextOutput out(output.stream());
    out << "<?xml version=\"1.0\"?>\n";
    write_comment(out, "written by scan2fea");
    if (!options.provenance.empty()) write_comment(out, options.provenance);
    if (!unit.empty()) write_comment(out, unit_comment(unit));
    out << "<VTKFile type=\"" << type << "\" version=\"1.0\" byte_order=\""
        << (std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian")
        << "\" header_type=\"UInt64\">\n<" << type << ">\n<Piece " << counts << ">\n";
    std::uint64_t offset = 0;
    for (const Section& section : sections) {
      out << "<" << section.tag;
      if (!section.shown.empty()) out << " Scalars=\"" << section.shown << "\"";
      out << ">\n";
      for (const Array& array : section.arrays) {
        out << "<DataArray type=\"" << array.type << "\" Name=\"" << array.name << "\" format=\"appended\" offset=\""
            << offset << "\"";
        if (array.components > 1) out << " NumberOfComponents=\"" << array.components << "\"";
        out << "/>\n";
        offset += sizeof(std::uint64_t) + array.bytes.size();
      }
      out << "</" << section.tag << ">\n";
    }
    out << "</Piece>\n</" << type << ">\n<AppendedData encoding=\"raw\">\n_";
  }
  for (const Section& section : sections)
    for (const Array& array : section.arrays) {
      const std::uint64_t bytes = array.bytes.size();
      output.stream().write(reinterpret_cast<const char*>(&bytes), sizeof bytes);
      output.stream().write(array.bytes.data(), static_cast<std::streamsize>(bytes));
    }
  output.stream() << "\n</AppendedData>\n</VTKFile>\n";
  files.commit();
}

std::string count(const char* attribute, std::size_t value) {
  return std::string(attribute) + "=\"" + std::to_string(value) + "\" ";
}

}  // namespace

Notes write_vtu(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options) {
  Notes notes;
  std::vector<Array> of_cells = membership(vtk_element_set, mesh.element_sets, mesh.tetrahedra.size(), notes);
  for (Array& array : faces_of_cells(mesh, notes)) of_cells.push_back(std::move(array));
  write("UnstructuredGrid", count("NumberOfPoints", mesh.nodes.size()) + count("NumberOfCells", mesh.tetrahedra.size()),
        {data_section("PointData", membership(vtk_node_set, mesh.node_sets, mesh.nodes.size(), notes),
                      options.node_fields),
         data_section("CellData", std::move(of_cells), options.element_fields),
         {"Points", {coordinates(mesh.nodes)}},
         {"Cells", cells_of(mesh)}},
        mesh.unit, file, options);
  return notes;
}

namespace {

Notes write_surface_as(bool grid, const NamedSurface& surface, const std::filesystem::path& file,
                       const FileOptions& options) {
  Notes notes;
  const SurfaceMesh& mesh = surface.mesh;
  const std::string cells = grid ? count("NumberOfCells", mesh.triangles.size())
                                 : count("NumberOfVerts", 0) + count("NumberOfLines", 0) + count("NumberOfStrips", 0) +
                                       count("NumberOfPolys", mesh.triangles.size());
  write(grid ? "UnstructuredGrid" : "PolyData", count("NumberOfPoints", mesh.vertices.size()) + cells,
        {data_section("PointData", membership(vtk_node_set, surface.node_sets, mesh.vertices.size(), notes),
                      options.node_fields),
         data_section("CellData", membership(vtk_face_set, surface.face_sets, mesh.triangles.size(), notes),
                      options.element_fields),
         {"Points", {coordinates(mesh.vertices)}},
         {grid ? "Cells" : "Polys", cells_of(mesh, grid)}},
        surface.unit, file, options);
  return notes;
}

}  // namespace

Notes write_vtu(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options) {
  return write_surface_as(true, surface, file, options);
}

Notes write_vtp(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options) {
  return write_surface_as(false, surface, file, options);
}

}  // namespace scan2fea
