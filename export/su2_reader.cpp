#include "export/line_reader.hpp"
#include "export/raw_mesh.hpp"
#include "export/set_names.hpp"
#include "export/su2.hpp"
#include "preproc/mesh/unit_comment.hpp"

namespace scan2fea {
namespace {

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file), lines_(file_) {}

  MeshFile read() {
    while (next_line()) {
      const std::string_view line = lines_.line();
      const std::size_t equals = line.find('=');
      if (equals == std::string_view::npos) lines_.fail("not a keyword of SU2", std::string(line.substr(0, 40)));
      take(std::string(without_blanks(line.substr(0, equals))), without_blanks(line.substr(equals + 1)));
    }
    return assemble(raw_, file_.path());
  }

 private:
  // Comments and empty lines are passed over.
  bool next_line() {
    while (lines_.next()) {
      const std::string_view line = without_blanks(lines_.line());
      if (line.starts_with('%')) {
        if (const auto unit = unit_in_comment(line)) raw_.unit = *unit;
      } else if (!line.empty()) {
        return true;
      }
    }
    return false;
  }

  std::vector<std::string_view> next_words() {
    if (!next_line()) file_.fail("the file is truncated");
    return words_of(lines_.line());
  }

  void take(const std::string& key, std::string_view value) {
    if (key == "NDIME" && lines_.count(value) != 3) lines_.fail("not three-dimensional", std::string(value), "3");
    if (key == "NZONE" && lines_.count(value) != 1) lines_.fail("several zones", std::string(value), "1");
    if (key == "NPOIN") read_points(lines_.count(words_of(value).empty() ? value : words_of(value).front()));
    if (key == "NELEM") read_elements(lines_.count(value));
    if (key == "MARKER_TAG") marker_ = value;
    if (key == "MARKER_ELEMS") read_marker(lines_.count(value));
  }

  // Points are numbered by their order; what stands behind the coordinates is their number again.
  void read_points(std::uint64_t points) {
    for (std::uint64_t n = 0; n < points; ++n) {
      const auto words = next_words();
      if (words.size() < 3) lines_.fail("a point without three coordinates");
      raw_.node_numbers.push_back(n);
      raw_.nodes.emplace_back(lines_.real(words[0]), lines_.real(words[1]), lines_.real(words[2]));
    }
  }

  void read_elements(std::uint64_t elements) {
    for (std::uint64_t e = 0; e < elements; ++e) {
      const auto words = next_words();
      if (words.size() < 5 || words[0] != "10")
        lines_.fail("element is not a tetrahedron", "VTK type " + std::string(words[0]), {}, "a mesh of tetrahedra");
      for (std::size_t k = 1; k < 5; ++k) raw_.corners.push_back(lines_.count(words[k]));
      raw_.tetrahedron_numbers.push_back(2 * e);
    }
  }

  void read_marker(std::uint64_t elements) {
    std::vector<std::uint64_t> members;
    for (std::uint64_t e = 0; e < elements; ++e) {
      const auto words = next_words();
      if (words.size() < 4 || words[0] != "5") {
        ++raw_.passed_over;
        continue;
      }
      for (std::size_t k = 1; k < 4; ++k) raw_.triangles.push_back(lines_.count(words[k]));
      raw_.triangle_numbers.push_back(2 * raw_.triangle_numbers.size() + 1);
      members.push_back(raw_.triangle_numbers.back());
    }
    for (const std::string& name : split_part_name(marker_)) {
      auto& all = members_of(raw_.element_sets, name);
      all.insert(all.end(), members.begin(), members.end());
    }
  }

  InputFile file_;
  LineReader lines_;
  std::string marker_;
  RawMesh raw_;
};

}  // namespace

MeshFile read_su2(const std::filesystem::path& file) {
  return Reader(file).read();
}

}  // namespace scan2fea
