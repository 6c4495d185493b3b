#include "export/partition.hpp"
#include "export/set_names.hpp"
#include "export/text_output.hpp"
#include "export/vtk_cells.hpp"
#include "export/xdmf.hpp"
#include "preproc/mesh/output_file.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <algorithm>
#include <span>

namespace scan2fea {
namespace {

void write_comment(TextOutput& out, std::string_view text) {
  std::string line = one_line(text);
  std::replace_if(
      line.begin(), line.end(), [](unsigned char c) { return c >= 0x80 || c == '-'; }, '_');  // no "--", no bytes
  out << "<!-- " << line << " -->\n";
}

void begin(TextOutput& out, const char* grid, const TetMesh& mesh, const FileOptions& options) {
  out << "<?xml version=\"1.0\"?>\n";
  write_comment(out, "written by scan2fea");
  if (!options.provenance.empty()) write_comment(out, options.provenance);
  if (!mesh.unit.empty()) write_comment(out, unit_comment(mesh.unit));
  out << "<Xdmf Version=\"3.0\"><Domain><Grid Name=\"" << grid << "\" GridType=\"Uniform\">\n";
}

void end(TextOutput& out) {
  out << "</Grid></Domain></Xdmf>\n";
}

// `write_row` prints one row of the item.
template <class WriteRow>
void write_item(TextOutput& out, std::size_t rows, std::size_t columns, std::string_view type,
                const WriteRow& write_row) {
  out << "<DataItem Dimensions=\"" << rows;
  if (columns > 1) out << " " << columns;
  out << "\" NumberType=\"" << type << "\" Precision=\"8\" Format=\"XML\">\n";
  for (std::size_t r = 0; r < rows; ++r) {
    write_row(r);
    out << "\n";
  }
  out << "</DataItem>\n";
}

void write_points(TextOutput& out, const TetMesh& mesh) {
  out << "<Geometry GeometryType=\"XYZ\">\n";
  write_item(out, mesh.nodes.size(), 3, "Float", [&](std::size_t n) {
    for (const double coordinate : mesh.nodes[n]) out.exact(coordinate) << " ";
  });
  out << "</Geometry>\n";
}

void write_names(TextOutput& out, const SetParts& parts, std::span<const std::string> names, int dimension) {
  if (parts.of.size() < 2) return;
  out << "<Information Name=\"field_data\" Value=\"" << parts.of.size() - 1 << "\"><![CDATA[<main>";
  for (std::size_t part = 1; part < parts.of.size(); ++part)
    out << "<map key=\"" << part_name(parts, part, names) << "\" dim=\"" << dimension << "\">" << part << "</map>";
  out << "</main>]]></Information>\n";
}

template <class Value>
void write_attribute(TextOutput& out, std::string_view name, const char* centre, const char* type, std::size_t count,
                     const Value& value_of) {
  out << "<Attribute Name=\"" << name << "\" AttributeType=\"Scalar\" Center=\"" << centre << "\">\n";
  write_item(out, count, 1, type, [&](std::size_t i) { out << value_of(i); });
  out << "</Attribute>\n";
}

void write_parts(TextOutput& out, std::span<const MeshPart> parts) {
  std::vector<std::uint32_t> part_of;
  for (std::uint32_t p = 0; p < parts.size(); ++p) part_of.resize(part_of.size() + parts[p].elements, p);
  write_attribute(out, vtk_part, "Cell", "Int", part_of.size(), [&](std::size_t t) { return part_of[t]; });
}

// Numbers alone: names are in the tags.
void write_fields(TextOutput& out, std::span<const Field> fields, const char* centre) {
  for (const Field& field : fields)
    if (field.names.empty())
      write_attribute(out, field.name, centre, "Float", field.values.size(),
                      [&](std::size_t i) { return field.values[i]; });
}

void write_topology_begin(TextOutput& out, const char* type, std::size_t elements, std::size_t nodes) {
  out << "<Topology TopologyType=\"" << type << "\" NumberOfElements=\"" << elements << "\" NodesPerElement=\"" << nodes
      << "\">\n";
}

void write_tetrahedra(TextOutput& out, const TetMesh& mesh) {
  const bool second = mesh.order() == 2;
  write_topology_begin(out, second ? "Tetrahedron_10" : "Tetrahedron", mesh.tetrahedra.size(), second ? 10 : 4);
  write_item(out, mesh.tetrahedra.size(), second ? 10 : 4, "Int", [&](std::size_t t) {
    for (const std::uint32_t n : mesh.tetrahedra[t]) out << n << " ";
    if (second)
      for (const std::uint32_t n : mesh.mid_edge_nodes[t]) out << n << " ";
  });
  out << "</Topology>\n";
}

void write_triangles(TextOutput& out, const TetMesh& mesh) {
  const bool second = mesh.order() == 2;
  write_topology_begin(out, second ? "Triangle_6" : "Triangle", mesh.boundary.size(), second ? 6 : 3);
  write_item(out, mesh.boundary.size(), second ? 6 : 3, "Int", [&](std::size_t f) {
    for (const std::uint32_t n : boundary_triangle(mesh, mesh.boundary[f])) out << n << " ";
    if (second)
      for (const std::uint32_t n : boundary_mid_edge_nodes(mesh, mesh.boundary[f])) out << n << " ";
  });
  out << "</Topology>\n";
}

}  // namespace

std::filesystem::path facets_of_xdmf(std::filesystem::path file) {
  return file.replace_filename(file.stem().string() + "_facets" + file.extension().string());
}

Notes write_xdmf(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options) {
  Notes notes;
  // `+` joins names, and a comma or a quote would end them.
  const NameRules rules{.longest = 100, .upper_case = false, .allowed = " _-.:/()", .starts_with_letter = true};
  const std::vector<std::string> elements = names_for(mesh.element_sets, rules, {}, notes);
  const std::vector<std::string> faces = names_for(mesh.face_sets, rules, {}, notes);
  const std::vector<std::string> nodes = names_for(mesh.node_sets, rules, {}, notes);
  const SetParts cell_parts = set_parts(mesh.element_sets, mesh.tetrahedra.size());
  const SetParts facet_parts = set_parts(mesh.face_sets, mesh.boundary.size());
  OutputFiles files(options.together);
  {
    TextOutput out(files.open(file).stream()), facets(files.open(facets_of_xdmf(file)).stream());
    begin(out, "Grid", mesh, options);
    write_names(out, cell_parts, elements, 3);
    write_tetrahedra(out, mesh);
    write_points(out, mesh);
    write_attribute(out, "cell_tags", "Cell", "Int", mesh.tetrahedra.size(),
                    [&](std::size_t t) { return cell_parts.part[t]; });
    if (!options.part_sizes.empty()) write_parts(out, parts_of(mesh, options.part_sizes));
    for (std::size_t s = 0; s < mesh.node_sets.size(); ++s) {
      std::vector<int> is_member(mesh.nodes.size(), 0);
      for (const std::uint32_t n : mesh.node_sets[s].members) is_member[n] = 1;
      write_attribute(out, std::string(vtk_node_set) + nodes[s], "Node", "Int", mesh.nodes.size(),
                      [&](std::size_t n) { return is_member[n]; });
    }
    write_fields(out, options.element_fields, "Cell");
    write_fields(out, options.node_fields, "Node");
    end(out);
    begin(facets, "facet_tags", mesh, options);
    write_names(facets, facet_parts, faces, 2);
    write_triangles(facets, mesh);
    write_points(facets, mesh);
    write_attribute(facets, "facet_tags", "Cell", "Int", mesh.boundary.size(),
                    [&](std::size_t f) { return facet_parts.part[f]; });
    end(facets);
  }
  files.commit();
  return notes;
}

}  // namespace scan2fea
