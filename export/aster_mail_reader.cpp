#include "export/aster_mail.hpp"
#include "export/line_reader.hpp"
#include "export/raw_mesh.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <unordered_map>

namespace scan2fea {
namespace {

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file), lines_(file_) {}

  MeshFile read() {
    for (std::string section = next_word(); section != "FIN"; section = next_word()) {
      if (section.empty()) file_.fail("the file has no FIN: it is truncated");
      read_section(upper_case(section));
    }
    return assemble(raw_, file_.path());
  }

 private:
  // The next word of the file, `=` being one; empty at its end.
  std::string next_word() {
    while (word_ >= words_.size()) {
      if (!lines_.next()) return {};
      std::string_view line = lines_.line();
      const std::size_t comment = line.find('%');
      if (comment != std::string_view::npos) {
        if (const auto unit = unit_in_comment(line.substr(comment))) raw_.unit = *unit;
        line = line.substr(0, comment);
      }
      words_.clear();
      for (const std::string_view word : words_of(line)) {
        const std::size_t equals = word.find('=');
        if (equals == std::string_view::npos) {
          words_.emplace_back(word);
          continue;
        }
        if (equals > 0) words_.emplace_back(word.substr(0, equals));
        words_.emplace_back("=");
        if (equals + 1 < word.size()) words_.emplace_back(word.substr(equals + 1));
      }
      word_ = 0;
    }
    return words_[word_++];
  }

  std::string word_of_section() {
    std::string word = next_word();
    if (word.empty()) file_.fail("a section has no FINSF: the file is truncated");
    return word;
  }

  void read_section(const std::string& section) {
    if (section == "TITRE") return pass_over();
    const std::vector<std::string> head = head_of_section();
    if (section == "COOR_3D")
      read_nodes();
    else if (section == "TETRA4" || section == "TETRA10")
      read_elements(section == "TETRA10" ? 10 : 4, true);
    else if (section == "TRIA3" || section == "TRIA6")
      read_elements(section == "TRIA6" ? 6 : 3, false);
    else if (section == "GROUP_MA" || section == "GROUP_NO")
      read_group(head, section == "GROUP_NO");
    else if (section.starts_with("HEXA") || section.starts_with("PENTA") || section.starts_with("PYRAM"))
      lines_.fail("elements are not tetrahedra", section, {}, "a mesh of TETRA4 or TETRA10");
    else
      pass_over();
  }

  void pass_over() {
    while (next_datum() != "FINSF") {
    }
  }

  // The section's `NOM = x` and other such pairs, by their names and values; the word behind stays to be read.
  std::vector<std::string> head_of_section() {
    std::vector<std::string> head;
    for (;;) {
      const std::string word = word_of_section();
      const std::string behind = word == "FINSF" ? "" : word_of_section();
      if (behind != "=") {
        pending_ = {word};
        if (word != "FINSF") pending_.push_back(behind);
        return head;
      }
      head.push_back(upper_case(word));
      head.push_back(word_of_section());
    }
  }

  // Of the section's data; `FINSF` behind the last.
  std::string next_datum() {
    if (pending_.empty()) return word_of_section();
    std::string word = pending_.front();
    pending_.erase(pending_.begin());
    return word;
  }

  static std::uint64_t number_of(std::unordered_map<std::string, std::uint64_t>& numbers, const std::string& name) {
    return numbers.try_emplace(name, numbers.size() + 1).first->second;
  }

  void read_nodes() {
    for (std::string name = next_datum(); name != "FINSF"; name = next_datum()) {
      raw_.node_numbers.push_back(number_of(nodes_, name));
      Vec3& p = raw_.nodes.emplace_back();
      for (int k = 0; k < 3; ++k) p[k] = lines_.real(next_datum());
    }
  }

  void read_elements(std::size_t nodes, bool solid) {
    for (std::string name = next_datum(); name != "FINSF"; name = next_datum()) {
      if (solid && raw_.has_other_order(nodes == 10)) lines_.fail(mixed_orders);
      (solid ? raw_.tetrahedron_numbers : raw_.triangle_numbers).push_back(number_of(elements_, name));
      for (std::size_t k = 0; k < nodes; ++k) {
        const std::string node = next_datum();
        if (node == "FINSF") lines_.fail("an element has too few nodes", name);
        const std::uint64_t number = number_of(nodes_, node);
        if (solid)
          (k < 4 ? raw_.corners : raw_.mid_edges).push_back(number);
        else if (k < 3)
          raw_.triangles.push_back(number);
      }
    }
  }

  // The name is a parameter, or the first word.
  void read_group(const std::vector<std::string>& head, bool of_nodes) {
    std::string name;
    for (std::size_t i = 0; i + 1 < head.size(); i += 2)
      if (head[i] == "NOM") name = head[i + 1];
    if (name.empty()) name = next_datum();
    if (name == "FINSF") lines_.fail("a group without a name");
    std::vector<std::uint64_t> members;
    for (std::string member = next_datum(); member != "FINSF"; member = next_datum())
      members.push_back(number_of(of_nodes ? nodes_ : elements_, member));
    auto& all = members_of(of_nodes ? raw_.node_sets : raw_.element_sets, name);
    all.insert(all.end(), members.begin(), members.end());
  }

  InputFile file_;
  LineReader lines_;
  std::vector<std::string> words_, pending_;
  std::size_t word_ = 0;
  std::unordered_map<std::string, std::uint64_t> nodes_, elements_;
  RawMesh raw_;
};

}  // namespace

MeshFile read_mail(const std::filesystem::path& file) {
  return Reader(file).read();
}

}  // namespace scan2fea
