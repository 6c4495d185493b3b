#include "export/bdf.hpp"
#include "export/line_reader.hpp"
#include "export/raw_mesh.hpp"
#include "export/raw_sets.hpp"
#include "export/set_names.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <algorithm>
#include <map>

namespace scan2fea {
namespace {

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file), lines_(file_) {}

  MeshFile read() {
    while (next_card() && fields_.front() != "ENDDATA") take_card();
    name_sets();
    raw_.has_own_numbers = true;
    MeshFile read = assemble(raw_, file_.path());
    if (auto* mesh = std::get_if<TetMesh>(&read.mesh)) drop_nodes_of_face_sets(*mesh, "");
    if (includes_) read.warnings.emplace_back("the files that INCLUDE names are not read");
    return read;
  }

 private:
  // The card's name and its fields, continuations among them; the line of `lines_` is then its last one.
  bool next_card() {
    fields_.clear();
    while (next_line()) {
      if (is_continuation()) {
        if (!fields_.empty()) add_fields();
        continue;
      }
      if (!fields_.empty()) {
        lines_.put_back();
        return true;
      }
      add_fields();
    }
    return !fields_.empty();
  }

  // Comments are passed over; those that name a set are kept.
  bool next_line() {
    while (lines_.next()) {
      const std::string_view line = without_blanks(lines_.line());
      if (line.starts_with('$')) {
        take_comment(line.substr(1));
        continue;
      }
      if (!line.empty()) return true;
    }
    return false;
  }

  bool is_continuation() const {
    const char first = lines_.line().empty() ? ' ' : lines_.line().front();
    return first == '+' || first == '*' || first == ' ' || first == '\t' || first == ',';
  }

  // Eight fields of eight characters or four of sixteen, or what commas part; the last field of a line, behind these,
  // only points to the continuation. The first line's first field is the card's name.
  void add_fields() {
    std::string_view line = lines_.line();
    line = line.substr(0, line.find('$'));
    const bool is_first = fields_.empty();
    if (const std::size_t comma = line.find(','); comma != std::string_view::npos) {
      std::size_t count = 0;
      for (std::size_t begin = 0; begin <= line.size() && count < 9; ++count) {
        const std::size_t end = std::min(line.find(',', begin), line.size());
        if (count > 0 || is_first) fields_.push_back(upper_case(without_blanks(line.substr(begin, end - begin))));
        begin = end + 1;
      }
      if (is_first && fields_.front().ends_with('*')) fields_.front().pop_back();
      pad(8);
      return;
    }
    std::string name = upper_case(without_blanks(line.substr(0, 8)));
    const bool is_large = name.starts_with('*') || name.ends_with('*');
    if (name.ends_with('*')) name.pop_back();
    if (is_first) fields_.push_back(name);
    const std::size_t width = is_large ? 16 : 8;
    for (std::size_t column = 8; column < 72; column += width)
      fields_.push_back(
          upper_case(without_blanks(column < line.size() ? line.substr(column, width) : std::string_view{})));
  }

  // To a whole line of fields.
  void pad(std::size_t per_line) {
    while ((fields_.size() - 1) % per_line != 0) fields_.emplace_back();
  }

  std::string_view field(std::size_t i) const { return i < fields_.size() ? std::string_view(fields_[i]) : ""; }

  void take_card() {
    const std::string& name = fields_.front();
    if (name == "GRID")
      take_grid();
    else if (name == "CTETRA")
      take_tetrahedron();
    else if (name == "CTRIA3" || name == "CTRIA6" || name == "CTRIAR")
      take_triangle();
    else if (name == "SET1")
      take_set();
    else if (name == "PLOAD4")
      take_load();
    else if (name == "CHEXA" || name == "CPENTA" || name == "CPYRAM")
      lines_.fail("elements are not tetrahedra", name, {}, "a mesh of CTETRA");
    else if (name == "INCLUDE")
      includes_ = true;
    else if (name.starts_with("CQUAD") || name == "CBAR" || name == "CBEAM" || name == "CROD")
      ++raw_.passed_over;
  }

  void take_grid() {
    if (!field(2).empty() && lines_.count(field(2)) != 0)
      lines_.fail("a point in another coordinate system than the basic one", std::string(field(2)), {},
                  "the mesh in basic coordinates");
    raw_.node_numbers.push_back(lines_.count(field(1)));
    raw_.nodes.emplace_back(lines_.real(field(3)), lines_.real(field(4)), lines_.real(field(5)));
  }

  void take_tetrahedron() {
    std::vector<std::uint64_t> nodes;
    for (std::size_t i = 3; i < 13; ++i)
      if (!field(i).empty()) nodes.push_back(lines_.count(field(i)));
    if (nodes.size() != 4 && nodes.size() != 10)
      lines_.fail("a CTETRA of other than four or ten nodes", std::to_string(nodes.size()));
    if (raw_.has_other_order(nodes.size() == 10)) lines_.fail(mixed_orders);
    raw_.add_tetrahedron(lines_.count(field(1)), nodes);
    by_property_[lines_.count(field(2))].push_back(raw_.tetrahedron_numbers.back());
  }

  void take_triangle() {
    for (std::size_t i = 3; i < 6; ++i) raw_.triangles.push_back(lines_.count(field(i)));
    raw_.triangle_numbers.push_back(lines_.count(field(1)));
    by_property_[lines_.count(field(2))].push_back(raw_.triangle_numbers.back());
  }

  void take_set() {
    auto& members = by_set_[lines_.count(field(1))];
    std::uint64_t last = 0;
    bool is_range = false;
    for (std::size_t i = 2; i < fields_.size(); ++i) {
      if (fields_[i].empty()) continue;
      if (fields_[i] == "THRU") {
        is_range = true;
        continue;
      }
      const std::uint64_t number = lines_.count(fields_[i]);
      if (is_range)
        ranges_.push_back({lines_.count(field(1)), last, number});
      else
        members.push_back(number);
      is_range = false;
      last = number;
    }
  }

  void take_load() {
    RawLoad& load = loads_.emplace_back();
    load.set = lines_.count(field(1));
    load.element = lines_.count(field(2));
    if (!field(8).empty() && field(8) != "THRU") load.opposite = lines_.count(field(8));
  }

  // "SET1 11 is FIXED"
  void take_comment(std::string_view comment) {
    if (const auto unit = unit_in_comment(comment)) raw_.unit = *unit;
    const std::vector<std::string_view> words = words_of(comment);
    if (words.size() != 4 || words[2] != "is") return;
    for (const char* card : {"SET1", "PLOAD4", "PSOLID", "PSHELL"})
      if (words[0] == card) names_[{card[0] == 'P' && card[1] == 'S' ? "P" : card, lines_.count(words[1])}] = words[3];
  }

  std::string name_of(const std::string& card, std::uint64_t number, const std::string& otherwise) const {
    const auto it = names_.find({card, number});
    return it == names_.end() ? otherwise + std::to_string(number) : it->second;
  }

  void name_sets() {
    add_ranges();
    for (auto& [number, members] : by_set_) {
      // A set of faces names its nodes by the same number.
      const bool of_faces = names_.contains({"PLOAD4", number}) && !names_.contains({"SET1", number});
      raw_.node_sets.push_back({of_faces ? names_.at({"PLOAD4", number}) : name_of("SET1", number, "SET_"), members});
    }
    // One property for all is none.
    for (const auto& [number, members] : by_property_) {
      if (by_property_.size() == 1 && !names_.contains({"P", number})) continue;
      if (number == 1 && !names_.contains({"P", number}) && !names_.empty()) continue;  // of the elements in no set
      for (const std::string& name : split_part_name(name_of("P", number, "PROPERTY_"))) {
        auto& all = members_of(raw_.element_sets, name);
        all.insert(all.end(), members.begin(), members.end());
      }
    }
    add_loads();
  }

  void add_ranges() {
    for (const Range& range : ranges_)
      for (const std::uint64_t n : raw_.node_numbers)
        if (n > range.first && n <= range.last) by_set_[range.set].push_back(n);
  }

  // The face that lies opposite to a corner.
  void add_loads() {
    std::map<std::uint64_t, std::size_t> index;
    for (std::size_t t = 0; t < raw_.tetrahedron_numbers.size(); ++t) index.emplace(raw_.tetrahedron_numbers[t], t);
    std::map<std::uint64_t, RawFaceSet> sets;
    for (const RawLoad& load : loads_) {
      RawFaceSet& set = sets[load.set];
      set.name = name_of("PLOAD4", load.set, "LOAD_");
      const auto t = index.find(load.element);
      if (t == index.end()) continue;
      for (std::uint8_t f = 0; f < 4; ++f) {
        const auto& face = tetrahedron_faces[f];
        const auto opposite = static_cast<std::size_t>(6 - face[0] - face[1] - face[2]);
        if (raw_.corners[4 * t->second + opposite] == load.opposite) set.faces.emplace_back(load.element, f);
      }
    }
    for (auto& [number, set] : sets) raw_.face_sets.push_back(std::move(set));
  }

  struct RawLoad {
    std::uint64_t set = 0, element = 0, opposite = 0;
  };
  struct Range {
    std::uint64_t set, first, last;
  };

  InputFile file_;
  LineReader lines_;
  std::vector<std::string> fields_;
  RawMesh raw_;
  std::map<std::uint64_t, std::vector<std::uint64_t>> by_property_, by_set_;
  std::vector<Range> ranges_;
  std::vector<RawLoad> loads_;
  std::map<std::pair<std::string, std::uint64_t>, std::string> names_;
  bool includes_ = false;
};

}  // namespace

MeshFile read_bdf(const std::filesystem::path& file) {
  return Reader(file).read();
}

}  // namespace scan2fea
