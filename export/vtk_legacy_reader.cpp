#include "preproc/mesh/unit_comment.hpp"
#include "export/vtk.hpp"
#include "export/vtk_cells.hpp"
#include "preproc/mesh/byte_order.hpp"
#include "preproc/mesh/input_file.hpp"
#include "preproc/mesh/text_scanner.hpp"

#include <bit>
#include <optional>

namespace scan2fea {
namespace {

// Bytes of a value of VTK's types; 0 for what is none.
std::size_t size_of(std::string_view type) {
  if (type == "char" || type == "unsigned_char") return 1;
  if (type == "short" || type == "unsigned_short") return 2;
  if (type == "int" || type == "unsigned_int" || type == "float" || type == "vtkIdType") return 4;
  if (type == "long" || type == "unsigned_long" || type == "double" || type == "vtktypeint64") return 8;
  return 0;
}

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : file_(path), scanner_(file_) {}

  MeshFile read() {
    read_head();
    for (;;) {
      if (!scanner_.skip_space()) break;
      const std::string keyword(scanner_.word());
      if (is_keyword(keyword, "points"))
        read_points();
      else if (is_keyword(keyword, "polygons"))
        read_cells(vtk_polygon);
      else if (is_keyword(keyword, "triangle_strips"))
        read_cells(vtk_triangle_strip);
      else if (is_keyword(keyword, "vertices") || is_keyword(keyword, "lines"))
        read_cells(passed_over);
      else if (is_keyword(keyword, "cells"))
        read_cells({});
      else if (is_keyword(keyword, "cell_types"))
        read_types();
      else if (is_keyword(keyword, "metadata"))
        pass_over_metadata();
      else if (is_keyword(keyword, "cell_data") || is_keyword(keyword, "point_data") || is_keyword(keyword, "field"))
        break;  // of no set that we know
      else
        scanner_.fail(scanner_.position(), "not a keyword of VTK's legacy format", keyword.substr(0, 40));
    }
    if (cells_.types.size() != cells_.offsets.size())
      file_.fail("as many cell types as cells are wanted", std::to_string(cells_.types.size()),
                 std::to_string(cells_.offsets.size()));
    return mesh_of(cells_, path());
  }

 private:
  static constexpr std::uint64_t passed_over = 0;  // VTK's empty cell

  const std::filesystem::path& path() const { return file_.path(); }

  // Three lines and the kind of the data set.
  void read_head() {
    if (!file_.bytes().starts_with("# vtk DataFile Version")) file_.fail("not a file of VTK's legacy format");
    const std::string_view bytes = file_.bytes();
    const std::size_t title = bytes.find('\n'),
                      mode = title == std::string_view::npos ? title : bytes.find('\n', title + 1);
    if (mode == std::string_view::npos) file_.fail("the file is truncated");
    if (const auto unit = unit_in_comment(bytes.substr(title, mode - title))) cells_.unit = *unit;
    scanner_ = TextScanner(file_, bytes.data() + mode + 1);
    next_word("the file is truncated");
    if (!is_keyword(word_, "ascii") && !is_keyword(word_, "binary"))
      fail("neither ASCII nor BINARY", std::string(word_));
    binary_ = is_keyword(word_, "binary");
    next_word("the file is truncated");
    if (!is_keyword(word_, "dataset")) fail("no data set", std::string(word_));
    next_word("the file is truncated");
    if (!is_keyword(word_, "polydata") && !is_keyword(word_, "unstructured_grid"))
      fail("neither a surface nor an unstructured grid", std::string(word_), "saving it as .vtp or .vtu");
  }

  [[noreturn]] void fail(std::string what, std::string value = {}, std::string advice = {}) const {
    scanner_.fail(scanner_.position(), std::move(what), std::move(value), {}, std::move(advice));
  }

  std::string_view next_word(const char* otherwise) {
    if (!scanner_.skip_space()) file_.fail(otherwise);
    word_ = scanner_.word();
    return word_;
  }

  // A count of values each of which takes a byte or more.
  std::uint64_t count() {
    if (!scanner_.skip_space()) file_.fail("the file is truncated");
    const std::int64_t value = scanner_.integer();
    if (value < 0 || static_cast<std::uint64_t>(value) > scanner_.bytes_left())
      fail("promises more than the file holds", std::to_string(value));
    return static_cast<std::uint64_t>(value);
  }

  // Values as numbers; those in binary begin behind the end of the line and are big-endian.
  template <class Value>
  std::vector<Value> values(std::uint64_t wanted, std::string_view type) {
    std::vector<Value> result;
    if (!binary_) {
      for (std::uint64_t i = 0; i < wanted; ++i) {
        if (!scanner_.skip_space()) file_.fail("the file is truncated");
        if constexpr (std::is_floating_point_v<Value>) {
          result.push_back(scanner_.number());
        } else {
          const std::int64_t value = scanner_.integer();
          if (value < 0) fail("a negative number", std::to_string(value));
          result.push_back(static_cast<Value>(value));
        }
      }
      return result;
    }
    const std::size_t size = size_of(type);
    if (size == 0) fail("a type that is not known", std::string(type));
    scanner_.skip_line();
    if (wanted > scanner_.bytes_left() / size) file_.fail("the file is truncated");
    const char* at = scanner_.position();
    for (std::uint64_t i = 0; i < wanted; ++i, at += size) result.push_back(value_at<Value>(at, type, size));
    scanner_ = TextScanner(file_, at);
    return result;
  }

  template <class Value>
  Value value_at(const char* at, std::string_view type, std::size_t size) const {
    constexpr std::endian order = std::endian::big;
    if constexpr (std::is_floating_point_v<Value>) {
      if (type == "float") return load<float>(at, order);
      if (type == "double") return load<double>(at, order);
    }
    std::int64_t value = 0;
    if (size == 1) value = static_cast<unsigned char>(*at);
    if (size == 2) value = load<std::int16_t>(at, order);
    if (size == 4) value = load<std::int32_t>(at, order);
    if (size == 8) value = load<std::int64_t>(at, order);
    if (!std::is_floating_point_v<Value> && value < 0)
      file_.fail_at_byte(at, "a negative number", std::to_string(value));
    return static_cast<Value>(value);
  }

  void read_points() {
    const std::uint64_t points = count();
    const std::string type(next_word("the file is truncated"));
    if (!cells_.coordinates.empty()) fail("points a second time");
    cells_.coordinates = values<double>(3 * points, type);
  }

  // `type`: of all cells; none where CELL_TYPES tells. Up to version 4 each cell is the count of its points and these;
  // from 5 on there are offsets, one more than cells, and points.
  void read_cells(std::optional<std::uint64_t> type) {
    const std::uint64_t cells = count(), numbers = count();
    const TextScanner before = scanner_;
    std::uint64_t begun = cells_.connectivity.size(), made = 0;
    if (next_word("the file is truncated") == "OFFSETS") {
      const std::string offset_type(next_word("the file is truncated"));
      const auto offsets = values<std::uint64_t>(cells, offset_type);
      if (next_word("the file is truncated") != "CONNECTIVITY") fail("no CONNECTIVITY behind OFFSETS");
      const std::string point_type(next_word("the file is truncated"));
      const auto points = values<std::uint64_t>(numbers, point_type);
      cells_.connectivity.insert(cells_.connectivity.end(), points.begin(), points.end());
      for (std::size_t c = 1; c < offsets.size(); ++c, ++made) {
        if (offsets[c] > points.size()) fail("a cell has a wrong offset");
        cells_.offsets.push_back(begun + offsets[c]);
      }
    } else {
      scanner_ = before;
      const auto all = values<std::uint64_t>(numbers, "int");
      for (std::size_t i = 0; i < all.size(); i += all[i] + 1, ++made) {
        if (all[i] >= all.size() - i) fail("a cell has more points than there are");
        cells_.connectivity.insert(cells_.connectivity.end(), all.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                   all.begin() + static_cast<std::ptrdiff_t>(i + 1 + all[i]));
        cells_.offsets.push_back(cells_.connectivity.size());
      }
      if (made != cells) fail("a wrong number of cells", std::to_string(made));
    }
    if (type) cells_.types.resize(cells_.types.size() + made, *type);
  }

  void read_types() {
    const std::uint64_t cells = count();
    for (const std::uint64_t type : values<std::uint64_t>(cells, "int")) cells_.types.push_back(type);
  }

  // Up to an empty line.
  void pass_over_metadata() {
    const std::string_view rest(scanner_.position(), scanner_.bytes_left());
    const std::size_t end = std::min(rest.find("\n\n"), rest.size());
    scanner_ = TextScanner(file_, rest.data() + end);
  }

  InputFile file_;
  TextScanner scanner_;
  std::string_view word_;
  bool binary_ = false;
  VtkCells cells_;
};

}  // namespace

MeshFile read_vtk_legacy(const std::filesystem::path& file) {
  return Reader(file).read();
}

}  // namespace scan2fea
