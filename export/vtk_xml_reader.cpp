#include "export/vtk.hpp"
#include "export/vtk_cells.hpp"
#include "export/vtk_xml.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/input_file.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <charconv>
#include <map>
#include <stdexcept>

namespace scan2fea {
namespace {

using vtk_xml::DataArray;
using vtk_xml::Tag;

struct Grid {
  vtk_xml::Storage storage;
  bool is_surface = false;  // PolyData
  Tag piece;
  std::map<std::string, DataArray> arrays;  // "Points", "Cells/types", "PointData/node_set A"
  std::vector<std::string> order;           // their names as the file has them, each once
  std::string unit;
};

void begin_file(Grid& grid, const Tag& tag, const std::filesystem::path& file) {
  const std::string type = tag.attribute("type");
  if (type != "UnstructuredGrid" && type != "PolyData")
    fail_vtk(file, "is neither an unstructured grid nor a surface", type, "saving it as .vtu or .vtp");
  grid.is_surface = type == "PolyData";
  const std::string compressor = tag.attribute("compressor");
  if (compressor == "vtkZLibDataCompressor")
    grid.storage.compressor = vtk_xml::Compressor::zlib;
  else if (compressor == "vtkLZ4DataCompressor")
    grid.storage.compressor = vtk_xml::Compressor::lz4;
  else if (!compressor.empty())
    fail_vtk(file, "is compressed in a way that is not read", compressor, "saving it with zlib, LZ4 or uncompressed");
  if (tag.attribute("byte_order") == "BigEndian") grid.storage.byte_order = std::endian::big;
  grid.storage.header_64 = tag.attribute("header_type") == "UInt64";
}

bool is_section(const std::string& name) {
  for (const char* known : {"Points", "Cells", "Polys", "Strips", "PointData", "CellData"})
    if (name == known) return true;
  return false;
}

Grid find_arrays(std::string_view text, const std::filesystem::path& file) {
  Grid grid;
  std::string section;
  bool is_vtk = false;
  for (std::size_t position = 0;;) {
    const std::optional<Tag> tag = vtk_xml::next_tag(text, position);
    if (!tag) break;
    position = tag->end;
    if (tag->name == "VTKFile") {
      is_vtk = true;
      if (const auto unit = unit_in_comment(text.substr(0, position))) grid.unit = *unit;
      begin_file(grid, *tag, file);
    } else if (tag->name == "Piece") {
      if (!grid.piece.name.empty()) fail_vtk(file, "has several pieces", {}, "merging the pieces");
      grid.piece = *tag;
    } else if (is_section(tag->name)) {
      section = tag->name;
    } else if (tag->name.starts_with('/') && tag->name != "/DataArray") {
      section.clear();
    } else if (tag->name == "DataArray" && !section.empty()) {
      const std::string name = section == "Points" ? section : section + "/" + tag->attribute("Name");
      if (!grid.arrays.contains(name)) grid.order.push_back(name);
      grid.arrays[name] = {*tag, text.substr(position, text.find('<', position) - position)};
    } else if (tag->name == "AppendedData") {
      grid.storage.appended_base64 = tag->attribute("encoding", "base64") == "base64";
      const std::size_t underscore = text.find('_', position);
      if (underscore != std::string_view::npos) grid.storage.appended = text.substr(underscore + 1);
      break;  // what follows is data, not XML
    }
  }
  if (!is_vtk) fail_vtk(file, "is not a VTK XML file");
  if (grid.piece.name.empty()) fail_vtk(file, "has no piece");
  return grid;
}

std::size_t piece_count(const Grid& grid, const char* attribute, const std::filesystem::path& file) {
  const std::string text = grid.piece.attribute(attribute);
  std::size_t count = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), count);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size())
    fail_vtk(file, std::string(attribute) + " is not a number", text);
  return count;
}

template <class Read>
auto array(const Grid& grid, const std::string& name, const std::filesystem::path& file, Read read) {
  const auto it = grid.arrays.find(name);
  const std::string shown = name.substr(name.find('/') + 1);
  if (it == grid.arrays.end()) fail_vtk(file, "has no array " + shown);
  try {
    return read(it->second, grid.storage);
  } catch (const std::runtime_error& error) {
    fail_vtk(file, "array " + shown + " " + error.what());
  }
}

template <class T>
void require_size(const std::vector<T>& values, std::size_t size, const std::string& name,
                  const std::filesystem::path& file) {
  if (values.size() != size)
    fail_vtk(file, "array " + name + " has a wrong size",
             std::to_string(values.size()) + ", not " + std::to_string(size));
}

void add_polygons(VtkCells& cells, const Grid& grid, const std::string& section, const char* count, std::uint64_t type,
                  const std::filesystem::path& file) {
  if (grid.piece.attribute(count).empty() || piece_count(grid, count, file) == 0) return;
  const auto connectivity = array(grid, section + "/connectivity", file, vtk_xml::read_integers);
  const auto offsets = array(grid, section + "/offsets", file, vtk_xml::read_integers);
  require_size(offsets, piece_count(grid, count, file), "offsets", file);
  const std::size_t before = cells.connectivity.size();
  cells.connectivity.insert(cells.connectivity.end(), connectivity.begin(), connectivity.end());
  for (const std::uint64_t end : offsets) {
    if (end > connectivity.size()) fail_vtk(file, "a cell of " + section + " has a wrong offset");
    cells.offsets.push_back(before + end);
    cells.types.push_back(type);
  }
}

void add_set_arrays(VtkCells& cells, const Grid& grid, std::size_t first_cell, const std::filesystem::path& file) {
  for (const std::string& key : grid.order) {
    const std::size_t slash = key.find('/');
    if (slash == std::string::npos) continue;
    const std::string section = key.substr(0, slash), name = key.substr(slash + 1);
    if (section == "PointData" && name.starts_with(vtk_node_set)) {
      cells.point_arrays.emplace_back(name, array(grid, key, file, vtk_xml::read_reals));
    } else if (section == "CellData" && (name.starts_with(vtk_element_set) || name.starts_with(vtk_face_set))) {
      std::vector<double> values = array(grid, key, file, vtk_xml::read_reals);
      values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(std::min(first_cell, values.size())));
      cells.cell_arrays.emplace_back(name, std::move(values));
    } else if (section == "PointData" || section == "CellData") {
      cells.other_arrays.push_back(name);
    }
  }
}

}  // namespace

VtkCells read_vtk_cells(const std::filesystem::path& file) {
  const InputFile input(file);
  const Grid grid = find_arrays(input.bytes(), file);
  const std::size_t points = piece_count(grid, "NumberOfPoints", file);
  VtkCells cells;
  cells.unit = grid.unit;
  cells.coordinates = array(grid, "Points", file, vtk_xml::read_reals);
  // Divided, since a promised count may overflow.
  if (cells.coordinates.size() % 3 != 0 || cells.coordinates.size() / 3 != points)
    require_size(cells.coordinates, 3 * points, "Points", file);
  std::size_t first_cell = 0;  // that `cells` holds: VTK counts a surface's points and lines first
  if (grid.is_surface) {
    for (const char* passed_over : {"NumberOfVerts", "NumberOfLines"})
      if (!grid.piece.attribute(passed_over).empty()) first_cell += piece_count(grid, passed_over, file);
    add_polygons(cells, grid, "Polys", "NumberOfPolys", vtk_polygon, file);
    add_polygons(cells, grid, "Strips", "NumberOfStrips", vtk_triangle_strip, file);
  } else {
    const std::size_t count = piece_count(grid, "NumberOfCells", file);
    cells.connectivity = array(grid, "Cells/connectivity", file, vtk_xml::read_integers);
    cells.offsets = array(grid, "Cells/offsets", file, vtk_xml::read_integers);
    cells.types = array(grid, "Cells/types", file, vtk_xml::read_integers);
    require_size(cells.offsets, count, "offsets", file);
    require_size(cells.types, count, "types", file);
  }
  add_set_arrays(cells, grid, first_cell, file);
  if (const std::string ids = "PointData/" + std::string(vtk_global_nodes); grid.arrays.contains(ids)) {
    cells.global_nodes = array(grid, ids, file, vtk_xml::read_integers);
    require_size(cells.global_nodes, points, std::string(vtk_global_nodes), file);
  }
  return cells;
}

MeshFile read_vtk_xml(const std::filesystem::path& file) {
  return mesh_of(read_vtk_cells(file), file);
}

}  // namespace scan2fea
