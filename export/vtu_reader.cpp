#include "export/raw_mesh.hpp"
#include "export/vtu.hpp"
#include "export/vtu_xml.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/input_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>
#include <stdexcept>

namespace scan2fea {
namespace {

using vtu::DataArray;
using vtu::Tag;

[[noreturn]] void fail(const std::filesystem::path& file, std::string what, std::string value = {},
                       std::string advice = {}) {
  throw InvalidInput({.what = std::move(what),
                      .where = file.string(),
                      .value = std::move(value),
                      .limit = {},
                      .advice = std::move(advice)});
}

struct Grid {
  vtu::Storage storage;
  Tag piece;
  std::map<std::string, DataArray> arrays;  // "Points", "connectivity", "offsets", "types"
};

Grid find_arrays(std::string_view text, const std::filesystem::path& file) {
  constexpr const char* save_otherwise = "saving it as VTU with raw or ASCII data, uncompressed";
  Grid grid;
  std::string section;
  bool is_vtk = false;
  for (std::size_t position = 0;;) {
    const std::optional<Tag> tag = vtu::next_tag(text, position);
    if (!tag) break;
    position = tag->end;
    if (tag->name == "VTKFile") {
      is_vtk = true;
      if (tag->attribute("type") != "UnstructuredGrid")
        fail(file, "is not an unstructured grid", tag->attribute("type"), save_otherwise);
      if (!tag->attribute("compressor").empty())
        fail(file, "is compressed", tag->attribute("compressor"), save_otherwise);
      if (tag->attribute("byte_order") == "BigEndian") grid.storage.byte_order = std::endian::big;
      grid.storage.header_64 = tag->attribute("header_type") == "UInt64";
    } else if (tag->name == "Piece") {
      if (!grid.piece.name.empty()) fail(file, "has several pieces", {}, "merging the pieces");
      grid.piece = *tag;
    } else if (tag->name == "Points" || tag->name == "Cells") {
      section = tag->name;
    } else if (tag->name.starts_with('/') && tag->name != "/DataArray") {
      section.clear();
    } else if (tag->name == "DataArray" && !section.empty()) {
      const std::string name = section == "Points" ? section : tag->attribute("Name");
      grid.arrays[name] = {*tag, text.substr(position, text.find('<', position) - position)};
    } else if (tag->name == "AppendedData") {
      grid.storage.appended_base64 = tag->attribute("encoding", "base64") == "base64";
      const std::size_t underscore = text.find('_', position);
      if (underscore != std::string_view::npos) grid.storage.appended = text.substr(underscore + 1);
      break;  // what follows is data, not XML
    }
  }
  if (!is_vtk) fail(file, "is not a VTK XML file");
  if (grid.piece.name.empty()) fail(file, "has no piece");
  return grid;
}

std::size_t piece_count(const Grid& grid, const char* attribute, const std::filesystem::path& file) {
  const std::string text = grid.piece.attribute(attribute);
  std::size_t count = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), count);
  if (result.ec != std::errc()) fail(file, std::string("has no ") + attribute, text);
  return count;
}

// An array of the grid, or a failure that names it.
template <class Read>
auto array(const Grid& grid, const std::string& name, const std::filesystem::path& file, Read read) {
  const auto it = grid.arrays.find(name);
  if (it == grid.arrays.end()) fail(file, "array " + name + " is missing");
  try {
    return read(it->second, grid.storage);
  } catch (const std::runtime_error& error) {
    fail(file, "array " + name + " " + error.what());
  }
}

template <class T>
void require_size(const std::vector<T>& values, std::size_t size, const char* name, const std::filesystem::path& file) {
  if (values.size() != size)
    throw InvalidInput({.what = std::string("array ") + name + " has a wrong size",
                        .where = file.string(),
                        .value = std::to_string(values.size()),
                        .limit = std::to_string(size),
                        .advice = {}});
}

// VTK's cell types of points, lines and surfaces.
bool is_not_solid(std::uint64_t type) {
  constexpr std::array<std::uint64_t, 23> types{0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  21, 22,
                                                23, 28, 30, 34, 35, 36, 68, 69, 70, 75, 76};
  return std::find(types.begin(), types.end(), type) != types.end();
}

RawMesh gather(const Grid& grid, const std::filesystem::path& file, std::vector<std::size_t>& cell_of_element) {
  const std::size_t points = piece_count(grid, "NumberOfPoints", file);
  const std::size_t cells = piece_count(grid, "NumberOfCells", file);
  const std::vector<double> coordinates = array(grid, "Points", file, vtu::read_reals);
  const std::vector<std::uint64_t> nodes = array(grid, "connectivity", file, vtu::read_integers);
  const std::vector<std::uint64_t> offsets = array(grid, "offsets", file, vtu::read_integers);
  const std::vector<std::uint64_t> types = array(grid, "types", file, vtu::read_integers);
  // Divided, since a promised count may overflow.
  if (coordinates.size() % 3 != 0 || coordinates.size() / 3 != points)
    require_size(coordinates, 3 * points, "Points", file);
  require_size(offsets, cells, "offsets", file);
  require_size(types, cells, "types", file);

  RawMesh raw;
  raw.node_numbers.resize(points);
  std::iota(raw.node_numbers.begin(), raw.node_numbers.end(), std::uint64_t{0});
  raw.nodes.resize(points);
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    raw.nodes[i / 3][static_cast<Eigen::Index>(i % 3)] = coordinates[i];

  std::uint64_t begin = 0;
  for (std::size_t c = 0; c < cells; begin = offsets[c], ++c) {
    const std::string name = "cell " + std::to_string(c);
    if (offsets[c] < begin || offsets[c] > nodes.size()) fail(file, name + " has a wrong offset");
    if (is_not_solid(types[c])) continue;
    if (types[c] != 10 && types[c] != 24)
      fail(file, name + " is not a tetrahedron", "VTK type " + std::to_string(types[c]), "a mesh of tetrahedra");
    const std::uint64_t count = types[c] == 24 ? 10 : 4;
    if (offsets[c] - begin != count) fail(file, name + " has a wrong number of nodes");
    if (!raw.corners.empty() && (types[c] == 24) == raw.mid_edges.empty())
      fail(file, name + " is of another order than the cells before it");
    for (std::uint64_t k = 0; k < count; ++k) (k < 4 ? raw.corners : raw.mid_edges).push_back(nodes[begin + k]);
    cell_of_element.push_back(c);
  }
  return raw;
}

}  // namespace

TetMesh read_vtu(const std::filesystem::path& file) {
  const InputFile input(file);
  const Grid grid = find_arrays(input.bytes(), file);
  std::vector<std::size_t> cell_of_element;
  const RawMesh raw = gather(grid, file, cell_of_element);
  return assemble(
      raw, file, [&](std::size_t n) { return file.string() + ": point " + std::to_string(n); },
      [&](std::size_t e) { return file.string() + ": cell " + std::to_string(cell_of_element[e]); });
}

}  // namespace scan2fea
