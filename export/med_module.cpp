#include "export/med_module.hpp"

#include <cstdlib>
#include <cstring>
#include <map>
#include <med.h>
#include <numeric>
#include <stdexcept>

namespace scan2fea {
namespace {

constexpr const char* mesh_name = "mesh";

void require(bool good, const char* what) {
  if (!good) throw std::runtime_error(what);
}

// An open file; closing one that was written may fail, too.
class MedFile {
 public:
  explicit MedFile(med_idt id) : id_(id) { require(id_ >= 0, "the file cannot be opened"); }
  ~MedFile() {
    if (id_ >= 0) MEDfileClose(id_);
  }
  MedFile(const MedFile&) = delete;
  MedFile& operator=(const MedFile&) = delete;

  med_idt id() const { return id_; }
  void close() {
    const med_err result = MEDfileClose(id_);
    id_ = -1;
    require(result >= 0, "the file cannot be closed");
  }

 private:
  med_idt id_;
};

// Text in a field of the library: padded, not more than fits.
std::string padded(std::string text, std::size_t size) {
  text.resize(size, ' ');
  return text;
}

// Numbers of families of nodes are above zero, those of elements below.
void write_families(med_idt file, const MedFamilies& families, int sign, int& count) {
  for (std::size_t f = 0; f < families.groups.size(); ++f) {
    ++count;
    std::string groups;
    for (const std::string& group : families.groups[f]) groups += padded(group, MED_LNAME_SIZE);
    const std::string name = "FAM_" + std::to_string(sign * count);
    require(MEDfamilyCr(file, mesh_name, name.c_str(), sign * count, static_cast<med_int>(families.groups[f].size()),
                        groups.c_str()) >= 0,
            "a family cannot be written");
  }
}

std::vector<med_int> numbers_of(const MedFamilies& families, int sign, int first) {
  std::vector<med_int> numbers;
  numbers.reserve(families.family.size());
  for (const std::uint32_t f : families.family)
    numbers.push_back(f == 0 ? 0 : static_cast<med_int>(sign * (first + static_cast<int>(f))));
  return numbers;
}

// Numbers that begin at 1 are MED's own.
void write_numbers(med_idt file, med_entity_type entity, med_geometry_type type, med_int count, std::uint64_t first) {
  if (first == 1) return;
  std::vector<med_int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), static_cast<med_int>(first));
  require(MEDmeshEntityNumberWr(file, mesh_name, MED_NO_DT, MED_NO_IT, entity, type, count, numbers.data()) >= 0,
          "the numbers of nodes or elements cannot be written");
}

std::string write(const MedMesh& mesh) {
  med_memfile image MED_MEMFILE_INIT;
  MedFile file(MEDmemFileOpen("mesh.med", &image, MED_FALSE, MED_ACC_CREAT));
  const std::string axes = padded("X", MED_SNAME_SIZE) + padded("Y", MED_SNAME_SIZE) + padded("Z", MED_SNAME_SIZE);
  std::string units;
  for (int k = 0; k < 3; ++k) units += padded(mesh.unit, MED_SNAME_SIZE);
  const bool volume = mesh.cells.front().type >= med_tetrahedron_4;
  require(MEDmeshCr(file.id(), mesh_name, 3, volume ? 3 : 2, MED_UNSTRUCTURED_MESH,
                    mesh.description.substr(0, MED_COMMENT_SIZE).c_str(), "", MED_SORT_DTIT, MED_CARTESIAN,
                    axes.c_str(), units.c_str()) >= 0,
          "the mesh cannot be written");
  const auto points = static_cast<med_int>(mesh.coordinates.size() / 3);
  require(MEDmeshNodeCoordinateWr(file.id(), mesh_name, MED_NO_DT, MED_NO_IT, MED_UNDEF_DT, MED_FULL_INTERLACE, points,
                                  mesh.coordinates.data()) >= 0,
          "the nodes cannot be written");
  require(MEDfamilyCr(file.id(), mesh_name, "FAMILLE_ZERO", 0, 0, "") >= 0, "a family cannot be written");
  int families = 0;
  const auto of_nodes = numbers_of(mesh.nodes, 1, families);
  write_families(file.id(), mesh.nodes, 1, families);
  require(MEDmeshEntityFamilyNumberWr(file.id(), mesh_name, MED_NO_DT, MED_NO_IT, MED_NODE, MED_NONE, points,
                                      of_nodes.data()) >= 0,
          "the families of nodes cannot be written");
  write_numbers(file.id(), MED_NODE, MED_NONE, points, mesh.first_node);
  std::uint64_t first_element = mesh.first_element;
  for (const MedCells& cells : mesh.cells) {
    const auto count = static_cast<med_int>(cells.families.family.size());
    if (count == 0) continue;
    const std::vector<med_int> nodes(cells.nodes.begin(), cells.nodes.end());
    require(MEDmeshElementConnectivityWr(file.id(), mesh_name, MED_NO_DT, MED_NO_IT, MED_UNDEF_DT, MED_CELL, cells.type,
                                         MED_NODAL, MED_FULL_INTERLACE, count, nodes.data()) >= 0,
            "the elements cannot be written");
    const auto numbers = numbers_of(cells.families, -1, families);
    write_families(file.id(), cells.families, -1, families);
    require(MEDmeshEntityFamilyNumberWr(file.id(), mesh_name, MED_NO_DT, MED_NO_IT, MED_CELL, cells.type, count,
                                        numbers.data()) >= 0,
            "the families of elements cannot be written");
    if (mesh.first_element != 1) write_numbers(file.id(), MED_CELL, cells.type, count, first_element);
    first_element += static_cast<std::uint64_t>(count);
  }
  file.close();
  std::string bytes(static_cast<const char*>(image.app_image_ptr), image.app_image_size);
  std::free(image.app_image_ptr);
  return bytes;
}

std::string text_of(const char* field, std::size_t size) {
  std::string text(field, strnlen(field, size));
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

using Groups = std::map<med_int, std::vector<std::string>>;  // by the family's number

Groups read_groups(med_idt file, const char* mesh, std::size_t bytes) {
  Groups groups;
  const med_int families = MEDnFamily(file, mesh);
  for (int f = 1; f <= families; ++f) {
    const med_int count = MEDnFamilyGroup(file, mesh, f);
    require(count >= 0 && static_cast<std::size_t>(count) <= bytes / MED_LNAME_SIZE,
            "a family promises more groups than the file holds");
    std::vector<char> names(static_cast<std::size_t>(count) * MED_LNAME_SIZE + 1);
    char name[MED_NAME_SIZE + 1] = {};
    med_int number = 0;
    if (MEDfamilyInfo(file, mesh, f, name, &number, names.data()) < 0)
      continue;  // a family with attributes, of old files
    for (med_int g = 0; g < count; ++g)
      groups[number].push_back(text_of(names.data() + static_cast<std::size_t>(g) * MED_LNAME_SIZE, MED_LNAME_SIZE));
  }
  return groups;
}

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path)
      : bytes_(std::filesystem::file_size(path)), file_(MEDfileOpen(path.c_str(), MED_ACC_RDONLY)) {
    require(MEDnMesh(file_.id()) > 0 && MEDmeshnAxis(file_.id(), 1) == 3, "the file holds no mesh in three dimensions");
  }

  void read(MedMesh& mesh) {
    med_int space = 0, dimension = 0, steps = 0;
    med_mesh_type type{};
    med_sorting_type sorting{};
    med_axis_type axes{};
    char description[MED_COMMENT_SIZE + 1] = {}, time_unit[MED_SNAME_SIZE + 1] = {};
    char axis_names[3 * MED_SNAME_SIZE + 1] = {}, axis_units[3 * MED_SNAME_SIZE + 1] = {};
    require(MEDmeshInfo(file_.id(), 1, name_, &space, &dimension, &type, description, time_unit, &sorting, &steps,
                        &axes, axis_names, axis_units) >= 0 &&
                type == MED_UNSTRUCTURED_MESH,
            "the first mesh is not an unstructured one");
    require(MEDmeshComputationStepInfo(file_.id(), name_, 1, &step_, &iteration_, &time_) >= 0, "the mesh has no step");
    mesh.unit = text_of(axis_units, MED_SNAME_SIZE);
    groups_ = read_groups(file_.id(), name_, bytes_);
    const std::size_t points = count(MED_NODE, MED_NONE, MED_COORDINATE, 3 * sizeof(double));
    mesh.coordinates.resize(3 * points);
    require(points > 0 && MEDmeshNodeCoordinateRd(file_.id(), name_, step_, iteration_, MED_FULL_INTERLACE,
                                                  mesh.coordinates.data()) >= 0,
            "the nodes cannot be read");
    mesh.nodes = families(MED_NODE, MED_NONE, points);
    for (const int solid : {MED_HEXA8, MED_HEXA20, MED_HEXA27, MED_PENTA6, MED_PENTA15, MED_PYRA5, MED_PYRA13})
      require(count(MED_CELL, solid, MED_CONNECTIVITY, 0) == 0, "elements are not tetrahedra");
    for (const int wanted : {med_tetrahedron_4, med_tetrahedron_10, med_triangle_3, med_triangle_6})
      read_cells(mesh, wanted);
  }

 private:
  // Refuses more than the file's bytes can be, each entity taking so many.
  std::size_t count(med_entity_type entity, med_geometry_type type, med_data_type data, std::size_t bytes_each) const {
    med_bool changed{}, transformed{};
    const med_int n = MEDmeshnEntity(file_.id(), name_, step_, iteration_, entity, type, data,
                                     data == MED_CONNECTIVITY ? MED_NODAL : MED_NO_CMODE, &changed, &transformed);
    if (n <= 0) return 0;
    require(bytes_each == 0 || static_cast<std::size_t>(n) <= bytes_ / bytes_each,
            "the file promises more than it holds");
    return static_cast<std::size_t>(n);
  }

  MedFamilies families(med_entity_type entity, med_geometry_type type, std::size_t members) const {
    MedFamilies result;
    result.family.resize(members, 0);
    if (count(entity, type, MED_FAMILY_NUMBER, 1) != members) return result;  // of family zero, all of them
    std::vector<med_int> numbers(members);
    if (MEDmeshEntityFamilyNumberRd(file_.id(), name_, step_, iteration_, entity, type, numbers.data()) < 0)
      return result;
    std::map<med_int, std::uint32_t> known;
    for (std::size_t i = 0; i < members; ++i) {
      const auto groups = groups_.find(numbers[i]);
      if (groups == groups_.end()) continue;
      const auto [it, is_new] = known.emplace(numbers[i], static_cast<std::uint32_t>(result.groups.size()) + 1);
      if (is_new) result.groups.push_back(groups->second);
      result.family[i] = it->second;
    }
    return result;
  }

  void read_cells(MedMesh& mesh, int type) const {
    const auto per_cell = static_cast<std::size_t>(type % 100);
    const std::size_t cells = count(MED_CELL, type, MED_CONNECTIVITY, per_cell * sizeof(med_int));
    if (cells == 0) return;
    std::vector<med_int> nodes(per_cell * cells);
    require(MEDmeshElementConnectivityRd(file_.id(), name_, step_, iteration_, MED_CELL, type, MED_NODAL,
                                         MED_FULL_INTERLACE, nodes.data()) >= 0,
            "the elements cannot be read");
    mesh.cells.push_back({type, {nodes.begin(), nodes.end()}, families(MED_CELL, type, cells)});
  }

  std::size_t bytes_;
  MedFile file_;
  char name_[MED_NAME_SIZE + 1] = {};
  med_int step_ = 0, iteration_ = 0;
  med_float time_ = 0;
  Groups groups_;
};

template <class Do>
void guarded(const Do& what, std::string& failure) {
  try {
    what();
    failure.clear();
  } catch (const std::exception& error) {
    failure = error.what();
  } catch (...) {
    failure = "unknown error";
  }
}

}  // namespace

extern "C" WriteByMed scan2fea_write_by_med;
extern "C" ReadByMed scan2fea_read_by_med;

void scan2fea_write_by_med(const MedMesh& mesh, std::string& bytes, std::string& failure) {
  guarded([&] { bytes = write(mesh); }, failure);
}

void scan2fea_read_by_med(const std::filesystem::path& file, MedMesh& mesh, std::string& failure) {
  guarded(
      [&] {
        med_bool hdf{}, med{};
        require(MEDfileCompatibility(file.c_str(), &hdf, &med) >= 0 && hdf == MED_TRUE && med == MED_TRUE,
                "not a MED file of a version that is known");
        Reader(file).read(mesh);
      },
      failure);
}

}  // namespace scan2fea
