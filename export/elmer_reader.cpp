#include "export/elmer.hpp"
#include "export/line_reader.hpp"
#include "export/raw_mesh.hpp"
#include "export/set_names.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <map>

namespace scan2fea {
namespace {

using Numbers = std::map<std::uint64_t, std::vector<std::uint64_t>>;  // members of a body or a boundary

class Reader {
 public:
  explicit Reader(const std::filesystem::path& header) : header_(header), folder_(header.parent_path()) {}

  MeshFile read() {
    const InputFile header(header_);  // its counts say nothing that the other files don't
    read_names();
    read_nodes();
    read_elements();
    read_boundary();
    add_sets(bodies_, "body");
    add_sets(boundaries_, "boundary");
    return assemble(raw_, header_);
  }

 private:
  void read_names() {
    if (!std::filesystem::exists(folder_ / "mesh.names")) return;
    const InputFile file(folder_ / "mesh.names");
    std::string kind = "body";
    for (LineReader lines(file); lines.next();) {
      const std::vector<std::string_view> words = words_of(lines.line());
      if (const auto unit = unit_in_comment(lines.line())) raw_.unit = *unit;
      if (lines.line().find("boundaries") != std::string_view::npos) kind = "boundary";  // as ElmerGrid heads them
      if (words.size() == 5 && words[0] == "!" && words[3] == "is")
        names_[{std::string(words[1]), lines.count(words[2])}] = words[4];
      else if (words.size() == 4 && words[0] == "$" && words[2] == "=")
        names_.emplace(std::pair(kind, lines.count(words[3])), words[1]);  // unless a comment of ours named it
    }
  }

  void read_nodes() {
    const InputFile file(folder_ / "mesh.nodes");
    for (LineReader lines(file); lines.next();) {
      const std::vector<std::string_view> words = words_of(lines.line());
      if (words.empty()) continue;
      if (words.size() < 5) lines.fail("a node without three coordinates");
      raw_.node_numbers.push_back(lines.count(words[0]));
      raw_.nodes.emplace_back(lines.real(words[2]), lines.real(words[3]), lines.real(words[4]));
    }
  }

  void read_elements() {
    const InputFile file(folder_ / "mesh.elements");
    for (LineReader lines(file); lines.next();) {
      const std::vector<std::string_view> words = words_of(lines.line());
      if (words.empty()) continue;
      const std::uint64_t type = words.size() < 3 ? 0 : lines.count(words[2]);
      const std::size_t nodes = type == 504 ? 4 : type == 510 ? 10 : type == 303 ? 3 : 0;
      if (nodes == 0 || words.size() < 3 + nodes)
        lines.fail("element is not a tetrahedron of first or second order", "type " + std::to_string(type));
      const std::uint64_t number = 2 * lines.count(words[0]);
      bodies_[lines.count(words[1])].push_back(number);
      if (nodes == 3) {
        for (std::size_t k = 3; k < 6; ++k) raw_.triangles.push_back(lines.count(words[k]));
        raw_.triangle_numbers.push_back(number);
        continue;
      }
      if (raw_.has_other_order(nodes == 10)) lines.fail(mixed_orders);
      for (std::size_t k = 3; k < 3 + nodes; ++k)
        (k < 7 ? raw_.corners : raw_.mid_edges).push_back(lines.count(words[k]));
      raw_.tetrahedron_numbers.push_back(number);
    }
  }

  void read_boundary() {
    const InputFile file(folder_ / "mesh.boundary");
    for (LineReader lines(file); lines.next();) {
      const std::vector<std::string_view> words = words_of(lines.line());
      if (words.size() < 8) continue;
      const std::uint64_t type = lines.count(words[4]);
      if (type != 303 && type != 306) {
        ++raw_.passed_over;
        continue;
      }
      for (std::size_t k = 5; k < 8; ++k) raw_.triangles.push_back(lines.count(words[k]));
      raw_.triangle_numbers.push_back(2 * lines.count(words[0]) + 1);
      boundaries_[lines.count(words[1])].push_back(raw_.triangle_numbers.back());
    }
  }

  // Numbers without a name are sets where there are several.
  void add_sets(const Numbers& numbers, const std::string& kind) {
    for (const auto& [number, members] : numbers) {
      const auto name = names_.find({kind, number});
      if (name == names_.end() && numbers.size() == 1) continue;
      const std::string text = name == names_.end() ? kind + "_" + std::to_string(number) : name->second;
      for (const std::string& part : split_part_name(text)) {
        auto& all = members_of(raw_.element_sets, part);
        all.insert(all.end(), members.begin(), members.end());
      }
    }
  }

  std::filesystem::path header_, folder_;
  std::map<std::pair<std::string, std::uint64_t>, std::string> names_;
  Numbers bodies_, boundaries_;
  RawMesh raw_;
};

}  // namespace

MeshFile read_elmer(const std::filesystem::path& file) {
  return Reader(file).read();
}

}  // namespace scan2fea
