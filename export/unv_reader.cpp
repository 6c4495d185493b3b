#include "export/line_reader.hpp"
#include "export/raw_mesh.hpp"
#include "export/unv.hpp"
#include "preproc/mesh/length_unit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace scan2fea {
namespace {

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file), lines_(file_) {}

  MeshFile read() {
    bool any = false;
    while (next_dataset()) {
      any = true;
      if (dataset_ == "164")
        read_units();
      else if (dataset_ == "2411" || dataset_ == "781")
        read_nodes();
      else if (dataset_ == "15")
        read_old_nodes();
      else if (dataset_ == "2412" || dataset_ == "780")
        read_elements();
      else if (std::find(of_groups.begin(), of_groups.end(), dataset_) != of_groups.end())
        read_groups();
      pass_over_rest();
    }
    if (!any) file_.fail("not a universal file: no dataset begins with -1");
    raw_.has_own_numbers = true;
    return assemble(raw_, file_.path());
  }

 private:
  static constexpr std::array<std::string_view, 9> of_groups{"2429", "2430", "2431", "2432", "2435",
                                                             "2452", "2467", "2477", "752"};

  bool is_mark() const { return without_blanks(lines_.line()) == "-1"; }

  bool next_dataset() {
    while (lines_.next())
      if (is_mark()) {
        if (!lines_.next()) return false;
        dataset_ = without_blanks(lines_.line());
        return true;
      }
    return false;
  }

  // To the mark at the dataset's end, which may have been read already.
  void pass_over_rest() {
    while (!ended_ && lines_.next()) ended_ = is_mark();
    if (!ended_) file_.fail("the dataset has no end: the file is truncated", std::string(dataset_));
    ended_ = false;
  }

  bool next_line() {
    if (!lines_.next()) file_.fail("the dataset has no end: the file is truncated", std::string(dataset_));
    ended_ = is_mark();
    return !ended_;
  }

  void require_line() {
    if (!next_line()) lines_.fail("the dataset ends within an entry", std::string(dataset_));
  }

  std::uint64_t integer(std::size_t field) const { return lines_.count(lines_.field(10 * field, 10)); }

  void read_units() {
    require_line();
    require_line();
    const std::vector<std::string_view> words = words_of(lines_.line());
    const double factor = words.empty() ? 0 : lines_.real(words.front());
    for (const char* unit : {"um", "mm", "cm", "m", "in", "ft"})
      if (std::abs(factor * metres(unit) - 1) < 1e-4) raw_.unit = unit;
  }

  void add_node(std::uint64_t number, const std::vector<std::string_view>& words, std::size_t first) {
    if (words.size() < first + 3) lines_.fail("a point without three coordinates");
    raw_.node_numbers.push_back(number);
    raw_.nodes.emplace_back(lines_.real(words[first]), lines_.real(words[first + 1]), lines_.real(words[first + 2]));
  }

  void read_nodes() {
    while (next_line()) {
      const std::uint64_t number = integer(0);
      require_line();
      add_node(number, words_of(lines_.line()), 0);
    }
  }

  void read_old_nodes() {
    while (next_line()) add_node(integer(0), words_of(lines_.line()), 4);
  }

  void read_elements() {
    while (next_line()) {
      const std::uint64_t number = integer(0), type = integer(1);
      const std::uint64_t nodes = integer(dataset_ == "2412" ? 5 : 7);
      if (nodes > 100) lines_.fail("an element of more nodes than any has", std::to_string(nodes));
      if (type == 11 || (type >= 21 && type <= 24)) require_line();  // beams have a line of orientations
      std::vector<std::uint64_t> n;
      while (n.size() < nodes) {
        require_line();
        const std::size_t in_line = std::min<std::size_t>(8, nodes - n.size());
        for (std::size_t k = 0; k < in_line; ++k) n.push_back(integer(k));
      }
      add_element(number, type, n);
    }
  }

  void add_element(std::uint64_t number, std::uint64_t type, const std::vector<std::uint64_t>& n) {
    // Linear and parabolic triangles of shells, membranes, plane stress and strain.
    static constexpr std::array<std::uint64_t, 8> linear{41, 51, 61, 74, 81, 91, 31, 1000},
        parabolic{42, 52, 62, 72, 82, 92, 32, 1000};
    const auto is = [&](const auto& list) { return std::find(list.begin(), list.end(), type) != list.end(); };
    if (type == 111 && n.size() == 4) {
      add_tetrahedron(number, n);
    } else if (type == 118 && n.size() == 10) {
      add_tetrahedron(number, {n[0], n[2], n[4], n[9], n[1], n[3], n[5], n[6], n[7], n[8]});
    } else if ((is(linear) && n.size() == 3) || (is(parabolic) && n.size() == 6)) {
      const std::size_t step = n.size() / 3;
      raw_.triangles.insert(raw_.triangles.end(), {n[0], n[step], n[2 * step]});
      raw_.triangle_numbers.push_back(number);
    } else if (type >= 101 && type <= 119) {
      lines_.fail("element is not a tetrahedron of first or second order", "type " + std::to_string(type));
    } else {
      ++raw_.passed_over;
    }
  }

  void add_tetrahedron(std::uint64_t number, const std::vector<std::uint64_t>& nodes) {
    if (raw_.has_other_order(nodes.size() == 10)) lines_.fail(mixed_orders);
    raw_.add_tetrahedron(number, nodes);
  }

  // A head of eight numbers, the last of which counts the members; a name; members, each of four numbers (of two in old
  // files), two (four) to a line.
  void read_groups() {
    const std::size_t numbers_each = dataset_ >= "2435" && dataset_.size() == 4 ? 4 : 2;
    while (next_line()) {
      const std::vector<std::string_view> head = words_of(lines_.line());
      if (head.empty()) continue;
      const std::uint64_t members = lines_.count(head.back());
      require_line();
      const std::string name(without_blanks(lines_.line()));
      RawSet nodes{name, {}}, elements{name, {}};
      for (std::uint64_t read = 0; read < members;) {
        require_line();
        const std::size_t in_line = words_of(lines_.line()).size() / numbers_each;
        if (in_line == 0) lines_.fail("a group has fewer members than its head says", name);
        for (std::size_t k = 0; k < in_line && read < members; ++k, ++read) {
          const std::uint64_t entity = integer(numbers_each * k), number = integer(numbers_each * k + 1);
          if (entity == 7) nodes.members.push_back(number);
          if (entity == 8) elements.members.push_back(number);
        }
      }
      if (!nodes.members.empty()) raw_.node_sets.push_back(std::move(nodes));
      if (!elements.members.empty()) raw_.element_sets.push_back(std::move(elements));
    }
  }

  InputFile file_;
  LineReader lines_;
  std::string_view dataset_;
  bool ended_ = false;
  RawMesh raw_;
};

}  // namespace

MeshFile read_unv(const std::filesystem::path& file) {
  return Reader(file).read();
}

}  // namespace scan2fea
