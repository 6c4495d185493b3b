#include "export/vtk.hpp"
#include "export/vtk_cells.hpp"
#include "export/vtk_xml.hpp"
#include "preproc/mesh/input_file.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <algorithm>
#include <iterator>

namespace scan2fea {
namespace {

namespace fs = std::filesystem;

struct Index {
  std::vector<fs::path> pieces;
  std::string unit;
};

Index read_index(const fs::path& file) {
  const InputFile input(file);
  const std::string_view text = input.bytes();
  Index index;
  bool is_index = false;
  for (std::size_t position = 0;;) {
    const std::optional<vtk_xml::Tag> tag = vtk_xml::next_tag(text, position);
    if (!tag) break;
    position = tag->end;
    if (tag->name == "VTKFile") {
      if (const auto unit = unit_in_comment(text.substr(0, position))) index.unit = *unit;
      const std::string type = tag->attribute("type");
      if (type != "PUnstructuredGrid")
        fail_vtk(file, "is no index of the pieces of an unstructured grid", type, "saving it as .pvtu");
      is_index = true;
    } else if (tag->name == "PUnstructuredGrid") {
      const std::string levels = tag->attribute("GhostLevel", "0");
      if (levels != "0") fail_vtk(file, "has ghost cells, which are in several pieces", levels, "saving it as .vtu");
    } else if (tag->name == "Piece") {
      index.pieces.push_back(file.parent_path() / vtk_xml::unescaped(tag->attribute("Source")));
    }
  }
  if (!is_index) fail_vtk(file, "is not a VTK XML file");
  if (index.pieces.empty()) fail_vtk(file, "has no piece");
  return index;
}

using NamedArrays = std::vector<std::pair<std::string, std::vector<double>>>;

// The array of that name, of `size` members at least; what a piece does not have is 0.
std::vector<double>& array_of(NamedArrays& arrays, const std::string& name, std::size_t size) {
  auto at = std::ranges::find(arrays, name, &NamedArrays::value_type::first);
  if (at == arrays.end()) at = arrays.emplace(arrays.end(), name, std::vector<double>());
  at->second.resize(std::max(size, at->second.size()), 0.0);
  return at->second;
}

// Adds pieces, one after the other, to cells whose points are those of the sorted numbers.
class Merger {
 public:
  Merger(VtkCells& whole, std::vector<std::uint64_t> numbers, const fs::path& file)
      : whole_(whole), numbers_(std::move(numbers)), is_placed_(numbers_.size(), false), file_(file) {
    whole_.coordinates.resize(3 * numbers_.size());
  }

  void add(const VtkCells& piece) {
    std::vector<std::size_t> place;
    place.reserve(piece.global_nodes.size());
    for (const std::uint64_t number : piece.global_nodes)
      place.push_back(static_cast<std::size_t>(std::ranges::lower_bound(numbers_, number) - numbers_.begin()));
    add_points(piece, place);
    add_cells(piece, place);
    for (const std::string& name : piece.other_arrays)
      if (name != vtk_global_nodes && name != vtk_global_elements && name != vtk_part &&
          std::ranges::count(whole_.other_arrays, name) == 0)
        whole_.other_arrays.push_back(name);
  }

 private:
  void add_points(const VtkCells& piece, const std::vector<std::size_t>& place) {
    for (std::size_t n = 0; n < place.size(); ++n) {
      const auto* const from = piece.coordinates.data() + 3 * n;
      auto* const to = whole_.coordinates.data() + 3 * place[n];
      if (is_placed_[place[n]] && !std::equal(from, from + 3, to))
        fail_vtk(file_, "two pieces have a node at different places", std::to_string(piece.global_nodes[n]));
      std::copy_n(from, 3, to);
      is_placed_[place[n]] = true;
    }
    for (const auto& [name, values] : piece.point_arrays) {
      std::vector<double>& whole = array_of(whole_.point_arrays, name, numbers_.size());
      for (std::size_t n = 0; n < std::min(values.size(), place.size()); ++n)
        whole[place[n]] = std::max(whole[place[n]], values[n]);
    }
  }

  void add_cells(const VtkCells& piece, const std::vector<std::size_t>& place) {
    const std::size_t cells = whole_.types.size(), ends = whole_.connectivity.size();
    for (const std::uint64_t n : piece.connectivity) {
      if (n >= place.size()) fail_vtk(file_, "a cell of a piece has a point that is not there", std::to_string(n));
      whole_.connectivity.push_back(place[n]);
    }
    for (const std::uint64_t end : piece.offsets) whole_.offsets.push_back(ends + end);
    whole_.types.insert(whole_.types.end(), piece.types.begin(), piece.types.end());
    for (const auto& [name, values] : piece.cell_arrays) {
      std::vector<double>& whole = array_of(whole_.cell_arrays, name, cells);
      whole.insert(whole.end(), values.begin(), values.end());
      whole.resize(whole_.types.size(), 0.0);
    }
  }

  VtkCells& whole_;
  std::vector<std::uint64_t> numbers_;  // of all points, ascending
  std::vector<bool> is_placed_;
  const fs::path& file_;
};

}  // namespace

MeshFile read_pvtu(const fs::path& file) {
  const Index index = read_index(file);
  std::vector<VtkCells> pieces;
  std::vector<std::uint64_t> numbers;
  for (const fs::path& piece : index.pieces) {
    const VtkCells& cells = pieces.emplace_back(read_vtk_cells(piece));
    if (cells.global_nodes.size() * 3 != cells.coordinates.size())
      fail_vtk(piece, "has no array " + std::string(vtk_global_nodes) + ", by which pieces are put together", {},
               "merging the pieces and saving them as .vtu");
    numbers.insert(numbers.end(), cells.global_nodes.begin(), cells.global_nodes.end());
  }
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  VtkCells whole;
  whole.unit = index.unit;
  Merger merger(whole, std::move(numbers), file);
  for (const VtkCells& piece : pieces) merger.add(piece);
  return mesh_of(whole, file);
}

}  // namespace scan2fea
