#include "export/cdb.hpp"
#include "export/line_reader.hpp"
#include "export/raw_mesh.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

namespace scan2fea {
namespace {

// "(3i9,6e21.13e3)": how many integers of which width, and the width of reals.
struct Format {
  std::size_t integers = 0, integer_width = 0, real_width = 0;
};

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file), lines_(file_) {}

  MeshFile read() {
    while (lines_.next()) {
      const std::string line = upper_case(without_blanks(lines_.line()));
      if (const auto unit = unit_in_comment(lines_.line())) raw_.unit = *unit;
      if (line.starts_with("NBLOCK"))
        read_nodes();
      else if (line.starts_with("EBLOCK"))
        read_elements(line);
      else if (line.starts_with("CMBLOCK"))
        read_component(line);
      else if (line.starts_with("/UNITS,") && raw_.unit.empty())
        take_unit(line.substr(7));
    }
    raw_.has_own_numbers = true;
    return assemble(raw_, file_.path());
  }

 private:
  void take_unit(const std::string& label) {
    static constexpr std::array<std::pair<std::string_view, const char*>, 7> units{
        {{"SI", "m"}, {"MKS", "m"}, {"CGS", "cm"}, {"MPA", "mm"}, {"UMKS", "um"}, {"BIN", "in"}, {"BFT", "ft"}}};
    for (const auto& [name, unit] : units)
      if (label == name) raw_.unit = unit;
  }

  void require_line() {
    if (!lines_.next()) file_.fail("a block has no end: the file is truncated");
  }

  Format read_format() {
    require_line();
    const std::string text = upper_case(lines_.line());
    Format format;
    const auto number_at = [&](std::size_t& i) {
      std::size_t number = 0;
      for (; i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])) != 0 && number < 1000; ++i)
        number = 10 * number + static_cast<std::size_t>(text[i] - '0');
      return number;
    };
    for (std::size_t i = 0; i < text.size(); ++i) {
      const std::size_t repeat = std::max<std::size_t>(number_at(i), 1);
      if (i >= text.size()) break;
      const char kind = text[i];
      if (kind != 'I' && kind != 'E' && kind != 'F') continue;
      ++i;
      const std::size_t width = number_at(i);
      if (kind == 'I' && format.real_width == 0) {
        format.integers += repeat;
        format.integer_width = width;
      } else if (kind != 'I' && format.real_width == 0) {
        format.real_width = width;
        break;
      }
    }
    if (format.integer_width == 0 || format.integers == 0)
      lines_.fail("not a format of integers", std::string(lines_.line().substr(0, 40)));
    return format;
  }

  // Until a line that begins with -1 or with a letter.
  bool ends_block() const {
    const std::string_view line = without_blanks(lines_.line());
    return line.starts_with("-1") || (!line.empty() && std::isalpha(static_cast<unsigned char>(line.front())) != 0);
  }

  void read_nodes() {
    const Format format = read_format();
    if (format.real_width == 0) lines_.fail("a format without reals");
    for (require_line(); !ends_block(); require_line()) {
      raw_.node_numbers.push_back(lines_.count(lines_.field(0, format.integer_width)));
      Vec3& p = raw_.nodes.emplace_back();
      for (std::size_t k = 0; k < 3; ++k)
        p[static_cast<Eigen::Index>(k)] = lines_.real(
            lines_.field(format.integers * format.integer_width + k * format.real_width, format.real_width));
    }
  }

  // Of the long form, whose first eleven numbers are of the element: the ninth counts nodes, the last is its number.
  void read_elements(const std::string& command) {
    if (command.find("SOLID") == std::string::npos)
      lines_.fail("an EBLOCK of the short form", {}, {}, "CDWRITE with blocked format of solids");
    const Format format = read_format();
    for (require_line(); !ends_block(); require_line()) {
      const auto integer = [&](std::size_t i) {
        return lines_.count(lines_.field(i * format.integer_width, format.integer_width));
      };
      const std::uint64_t count = integer(8), number = integer(10);
      if (count > 20) lines_.fail("an element of more than 20 nodes", std::to_string(count));
      std::vector<std::uint64_t> nodes;
      for (std::size_t k = 0; k < std::min<std::uint64_t>(count, 8); ++k) nodes.push_back(integer(11 + k));
      if (count > 8) require_line();
      for (std::size_t k = 8; k < count; ++k) nodes.push_back(integer(k - 8));
      add_element(number, nodes);
    }
  }

  void add_element(std::uint64_t number, const std::vector<std::uint64_t>& n) {
    const bool triangle = n.size() >= 4 && n[2] == n[3] && (n.size() == 4 || (n.size() == 8 && n[6] == n[2]));
    if (triangle || n.size() == 3) {
      raw_.triangles.insert(raw_.triangles.end(), n.begin(), n.begin() + 3);
      raw_.triangle_numbers.push_back(number);
    } else if (n.size() == 4 || n.size() == 10) {
      add_tetrahedron(number, n);
    } else if (n.size() == 8 && n[2] == n[3] && n[4] == n[5] && n[5] == n[6] && n[6] == n[7]) {
      add_tetrahedron(number, {n[0], n[1], n[2], n[4]});
    } else if (n.size() < 3) {
      ++raw_.passed_over;
    } else {
      lines_.fail("element is not a tetrahedron of first or second order", std::to_string(n.size()) + " nodes");
    }
  }

  void add_tetrahedron(std::uint64_t number, const std::vector<std::uint64_t>& nodes) {
    if (raw_.has_other_order(nodes.size() == 10)) lines_.fail(mixed_orders);
    raw_.add_tetrahedron(number, nodes);
  }

  // CMBLOCK,NAME,NODE,COUNT; a negative number ends a range that the one before it begins.
  void read_component(const std::string& command) {
    std::vector<std::string> words;
    for (std::size_t begin = 0; begin <= command.size();) {
      const std::size_t end = std::min(command.find(',', begin), command.size());
      words.emplace_back(without_blanks(std::string_view(command).substr(begin, end - begin)));
      begin = end + 1;
    }
    if (words.size() < 4) lines_.fail("a CMBLOCK without name, kind and count");
    const bool of_nodes = words[2].starts_with("NODE");
    const std::uint64_t count = lines_.count(words[3].substr(0, words[3].find('!')));
    const Format format = read_format();
    std::vector<std::uint64_t> members;
    std::uint64_t last = 0;
    for (std::uint64_t read = 0; read < count;) {
      require_line();
      for (std::size_t k = 0; k < format.integers && read < count; ++k, ++read) {
        const std::string_view field = without_blanks(lines_.field(k * format.integer_width, format.integer_width));
        if (field.empty()) lines_.fail("a component has fewer members than it says", words[1]);
        if (field.front() != '-') {
          last = lines_.count(field);
          members.push_back(last);
          continue;
        }
        const std::uint64_t end = lines_.count(field.substr(1));
        for (const auto* numbers : of_nodes ? std::vector{&raw_.node_numbers}
                                            : std::vector{&raw_.tetrahedron_numbers, &raw_.triangle_numbers})
          for (const std::uint64_t n : *numbers)
            if (n > last && n <= end) members.push_back(n);
      }
    }
    auto& all = members_of(of_nodes ? raw_.node_sets : raw_.element_sets, words[1]);
    all.insert(all.end(), members.begin(), members.end());
  }

  InputFile file_;
  LineReader lines_;
  RawMesh raw_;
};

}  // namespace

MeshFile read_cdb(const std::filesystem::path& file) {
  return Reader(file).read();
}

}  // namespace scan2fea
