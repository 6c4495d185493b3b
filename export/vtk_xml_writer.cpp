#include "export/partition.hpp"
#include "export/set_names.hpp"
#include "export/text_output.hpp"
#include "export/vtk.hpp"
#include "export/vtk_cells.hpp"
#include "export/vtk_xml.hpp"
#include "preproc/mesh/output_file.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
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
  std::string shown = {};       // the array that a viewer colours by at first
  std::string global_ids = {};  // the array of numbers that are the same in all pieces
};

// What a file holds; `counts` are the attributes of its piece.
struct Document {
  std::string type, counts;
  std::vector<Section> sections;
  std::string unit;
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

void write_head(TextOutput& out, const std::string& type, const std::string& unit, const std::string& provenance) {
  out << "<?xml version=\"1.0\"?>\n";
  write_comment(out, "written by scan2fea");
  if (!provenance.empty()) write_comment(out, provenance);
  if (!unit.empty()) write_comment(out, unit_comment(unit));
  out << "<VTKFile type=\"" << type << "\" version=\"1.0\" byte_order=\""
      << (std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian") << "\" header_type=\"UInt64\">\n";
}

// `P` before the tags of an index of pieces.
void write_section_begin(TextOutput& out, const char* before, const Section& section) {
  out << "<" << before << section.tag;
  if (!section.shown.empty()) out << " Scalars=\"" << section.shown << "\"";
  if (!section.global_ids.empty()) out << " GlobalIds=\"" << section.global_ids << "\"";
  out << ">\n";
}

void write_array_begin(TextOutput& out, const char* before, const Array& array) {
  out << "<" << before << "DataArray type=\"" << array.type << "\" Name=\"" << array.name << "\"";
  if (array.components > 1) out << " NumberOfComponents=\"" << array.components << "\"";
}

void write(const Document& document, const std::filesystem::path& file, const FileOptions& options) {
  OutputFiles files(options.together);
  OutputFile& output = files.open(file);
  {
    TextOutput out(output.stream());
    write_head(out, document.type, document.unit, options.provenance);
    out << "<" << document.type << ">\n<Piece " << document.counts << ">\n";
    std::uint64_t offset = 0;
    for (const Section& section : document.sections) {
      write_section_begin(out, "", section);
      for (const Array& array : section.arrays) {
        write_array_begin(out, "", array);
        out << " format=\"appended\" offset=\"" << offset << "\"/>\n";
        offset += sizeof(std::uint64_t) + array.bytes.size();
      }
      out << "</" << section.tag << ">\n";
    }
    out << "</Piece>\n</" << document.type << ">\n<AppendedData encoding=\"raw\">\n_";
  }
  for (const Section& section : document.sections)
    for (const Array& array : section.arrays) {
      const std::uint64_t bytes = array.bytes.size();
      output.stream().write(reinterpret_cast<const char*>(&bytes), sizeof bytes);
      output.stream().write(array.bytes.data(), static_cast<std::streamsize>(bytes));
    }
  output.stream() << "\n</AppendedData>\n</VTKFile>\n";
  output.finish();  // there may be many
  files.commit();
}

std::string count(const char* attribute, std::size_t value) {
  return std::string(attribute) + "=\"" + std::to_string(value) + "\" ";
}

Document document_of(const TetMesh& mesh, const FileOptions& options, Notes& notes) {
  std::vector<Array> of_cells = membership(vtk_element_set, mesh.element_sets, mesh.tetrahedra.size(), notes);
  for (Array& array : faces_of_cells(mesh, notes)) of_cells.push_back(std::move(array));
  return {"UnstructuredGrid",
          count("NumberOfPoints", mesh.nodes.size()) + count("NumberOfCells", mesh.tetrahedra.size()),
          {data_section("PointData", membership(vtk_node_set, mesh.node_sets, mesh.nodes.size(), notes),
                        options.node_fields),
           data_section("CellData", std::move(of_cells), options.element_fields),
           {"Points", {coordinates(mesh.nodes)}},
           {"Cells", cells_of(mesh)}},
          mesh.unit};
}

// Those of the members that are in `origin`, both ascending, by their place there.
std::vector<NamedSet> sets_within(const std::vector<NamedSet>& sets, std::span<const std::uint32_t> origin) {
  std::vector<NamedSet> within;
  for (const NamedSet& set : sets) {
    NamedSet& part = within.emplace_back(NamedSet{set.name, {}});
    auto at = origin.begin();
    auto member = at == origin.end() ? set.members.end() : std::ranges::lower_bound(set.members, *at);
    while (member != set.members.end() && at != origin.end()) {
      if (*member == *at) part.members.push_back(static_cast<std::uint32_t>(at - origin.begin()));
      if (*member <= *at)
        ++member;
      else
        ++at;
    }
  }
  return within;
}

// A part as a mesh of its own, with those of the fields that are its own.
struct Piece {
  TetMesh mesh;
  FileOptions options;
};

std::vector<Field> fields_within(const std::vector<Field>& fields, std::span<const std::uint32_t> origin) {
  std::vector<Field> within;
  for (const Field& field : fields) {
    Field& part = within.emplace_back(Field{.name = field.name, .values = {}, .names = field.names});
    part.values.reserve(origin.size());
    for (const std::uint32_t i : origin) part.values.push_back(field.values[i]);
  }
  return within;
}

Piece piece_of(const TetMesh& mesh, const MeshPart& part, const FileOptions& options) {
  Piece piece{.mesh = {}, .options = {.provenance = options.provenance}};
  const auto own = [&](std::uint32_t node) {
    return static_cast<std::uint32_t>(std::ranges::lower_bound(part.nodes, node) - part.nodes.begin());
  };
  for (const std::uint32_t n : part.nodes) piece.mesh.nodes.push_back(mesh.nodes[n]);
  std::vector<std::uint32_t> elements(part.elements);
  std::iota(elements.begin(), elements.end(), part.first_element);
  for (const std::uint32_t t : elements) {
    std::ranges::transform(mesh.tetrahedra[t], piece.mesh.tetrahedra.emplace_back().begin(), own);
    if (mesh.order() == 2)
      std::ranges::transform(mesh.mid_edge_nodes[t], piece.mesh.mid_edge_nodes.emplace_back().begin(), own);
  }
  for (const std::uint32_t f : part.faces)
    piece.mesh.boundary.push_back({mesh.boundary[f].tetrahedron - part.first_element, mesh.boundary[f].face});
  piece.mesh.node_sets = sets_within(mesh.node_sets, part.nodes);
  piece.mesh.face_sets = sets_within(mesh.face_sets, part.faces);
  piece.mesh.element_sets = sets_within(mesh.element_sets, elements);
  piece.mesh.unit = mesh.unit;
  piece.options.node_fields = fields_within(options.node_fields, part.nodes);
  piece.options.element_fields = fields_within(options.element_fields, elements);
  return piece;
}

Document piece_document(const TetMesh& mesh, const MeshPart& part, std::size_t number, const FileOptions& options,
                        Notes& notes) {
  const Piece piece = piece_of(mesh, part, options);
  Document document = document_of(piece.mesh, piece.options, notes);
  std::vector<std::int64_t> elements(part.elements);
  std::iota(elements.begin(), elements.end(), std::int64_t{part.first_element});
  Section &of_points = document.sections[0], &of_cells = document.sections[1];
  of_points.arrays.push_back(array_of("Int64", of_points.global_ids = vtk_global_nodes,
                                      std::vector<std::int64_t>(part.nodes.begin(), part.nodes.end())));
  of_cells.arrays.push_back(array_of("Int64", of_cells.global_ids = vtk_global_elements, elements));
  of_cells.arrays.push_back(array_of("Int32", std::string(vtk_part),
                                     std::vector<std::int32_t>(part.elements, static_cast<std::int32_t>(number))));
  return document;
}

// `like`: one of the pieces, which all have the same arrays.
void write_index(const Document& like, std::span<const std::filesystem::path> pieces, const std::string& provenance,
                 std::ostream& stream) {
  TextOutput out(stream);
  write_head(out, "P" + like.type, like.unit, provenance);
  out << "<P" << like.type << " GhostLevel=\"0\">\n";
  for (const Section& section : like.sections) {
    if (section.tag == "Cells") continue;
    write_section_begin(out, "P", section);
    for (const Array& array : section.arrays) {
      write_array_begin(out, "P", array);
      out << "/>\n";
    }
    out << "</P" << section.tag << ">\n";
  }
  for (const std::filesystem::path& piece : pieces)
    out << "<Piece Source=\"" << vtk_xml::escaped(piece.filename().string()) << "\"/>\n";
  out << "</P" << like.type << ">\n</VTKFile>\n";
}

}  // namespace

Notes write_vtu(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options) {
  Notes notes;
  write(document_of(mesh, options, notes), file, options);
  return notes;
}

std::vector<std::filesystem::path> pieces_of_pvtu(const std::filesystem::path& file, std::size_t parts) {
  std::vector<std::filesystem::path> pieces;
  for (std::size_t p = 0; p < std::max<std::size_t>(parts, 1); ++p)
    pieces.push_back(file.parent_path() / (file.stem().string() + "_" + std::to_string(p) + ".vtu"));
  return pieces;
}

Notes write_pvtu(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options) {
  const std::vector<MeshPart> parts = parts_of(mesh, options.part_sizes);
  const std::vector<std::filesystem::path> pieces = pieces_of_pvtu(file, parts.size());
  OutputFiles files(options.together);
  FileOptions of_piece;
  of_piece.provenance = options.provenance;
  of_piece.together = &files;
  Document last;
  Notes notes;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    notes.clear();  // the same of all
    last = piece_document(mesh, parts[p], p, options, notes);
    write(last, pieces[p], of_piece);
  }
  // Behind the pieces, which are in place before it is.
  write_index(last, pieces, options.provenance, files.open(file).stream());
  files.commit();
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
  write({grid ? "UnstructuredGrid" : "PolyData",
         count("NumberOfPoints", mesh.vertices.size()) + cells,
         {data_section("PointData", membership(vtk_node_set, surface.node_sets, mesh.vertices.size(), notes),
                       options.node_fields),
          data_section("CellData", membership(vtk_face_set, surface.face_sets, mesh.triangles.size(), notes),
                       options.element_fields),
          {"Points", {coordinates(mesh.vertices)}},
          {grid ? "Cells" : "Polys", cells_of(mesh, grid)}},
         surface.unit},
        file, options);
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
