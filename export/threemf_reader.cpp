#include "export/raw_mesh.hpp"
#include "export/threemf.hpp"
#include "export/vtk_xml.hpp"
#include "export/zip_entries.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/input_file.hpp"
#include "preproc/mesh/length_unit.hpp"

#include <Eigen/Geometry>
#include <fast_float/fast_float.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>

namespace scan2fea {
namespace {

using vtk_xml::Tag;
using Transform = Eigen::Affine3d;

struct Component {
  std::string object;
  Transform transform = Transform::Identity();
};

struct Object {
  std::string name;
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Component> components;
};

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : file_(path) {}

  MeshFile read() {
    const std::string model = model_text();
    read_model(model);
    for (const Component& item : items_) add(item.object, item.transform, 0);
    return assemble(raw_, file_.path());
  }

 private:
  // The part that is the model: of parts that others refer to, the one that is not in a folder of its own is the root.
  std::string model_text() const {
    const std::vector<ZipEntry> entries = zip_entries(file_);
    const ZipEntry* model = nullptr;
    for (const ZipEntry& entry : entries)
      if (entry.name.ends_with(".model") && (model == nullptr || entry.name == "3D/3dmodel.model")) model = &entry;
    if (model == nullptr) file_.fail("a ZIP without a 3D model");
    return content_of(*model, file_);
  }

  double real(const std::string& text) const {
    double value = 0;
    const auto result = fast_float::from_chars(text.data(), text.data() + text.size(), value);
    if (result.ec != std::errc() || result.ptr != text.data() + text.size())
      file_.fail("not a number", text.substr(0, 40));
    return value;
  }

  std::uint32_t index(const std::string& text) const {
    std::uint32_t value = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
    if (result.ec != std::errc() || result.ptr != text.data() + text.size())
      file_.fail("not an index", text.substr(0, 40));
    return value;
  }

  // Twelve numbers, a row for each column of the matrix, as points are rows.
  Transform transform_of(const Tag& tag) const {
    Transform transform = Transform::Identity();
    const std::string text = tag.attribute("transform");
    if (text.empty()) return transform;
    std::vector<double> m;
    for (std::size_t begin = 0; begin < text.size() && m.size() < 13;) {
      const std::size_t end = std::min(text.find(' ', begin), text.size());
      if (end > begin) m.push_back(real(text.substr(begin, end - begin)));
      begin = end + 1;
    }
    if (m.size() != 12) file_.fail("a transformation of other than twelve numbers", text.substr(0, 80));
    for (Eigen::Index r = 0; r < 3; ++r)
      for (Eigen::Index c = 0; c < 4; ++c) transform(r, c) = m[static_cast<std::size_t>(3 * c + r)];
    return transform;
  }

  void read_model(std::string_view text) {
    bool is_model = false;
    Object* object = nullptr;
    for (std::size_t position = 0;;) {
      const std::optional<Tag> tag = vtk_xml::next_tag(text, position);
      if (!tag) break;
      position = tag->end;
      const std::string name = tag->name.substr(tag->name.find(':') + 1);  // without its name space
      if (name == "model") {
        is_model = true;
        raw_.unit = length_unit(tag->attribute("unit", "millimeter")).value_or("");
      } else if (name == "object") {
        object = &objects_[tag->attribute("id")];
        object->name = tag->attribute("name");
      } else if (name == "item") {
        items_.push_back({tag->attribute("objectid"), transform_of(*tag)});
      } else if (object != nullptr && name == "vertex") {
        object->vertices.emplace_back(real(tag->attribute("x")), real(tag->attribute("y")), real(tag->attribute("z")));
      } else if (object != nullptr && name == "triangle") {
        object->triangles.push_back(
            {index(tag->attribute("v1")), index(tag->attribute("v2")), index(tag->attribute("v3"))});
      } else if (object != nullptr && name == "component") {
        object->components.push_back({tag->attribute("objectid"), transform_of(*tag)});
      }
    }
    if (!is_model) file_.fail("a 3D model that is not XML of 3MF");
  }

  // An object within itself would have no end, and objects doubled again and again not soon one.
  void add(const std::string& id, const Transform& transform, int depth) {
    constexpr int deepest = 16;
    constexpr std::size_t most_parts = 100000;
    if (depth > deepest || ++parts_ > most_parts) file_.fail("objects that are made of one another without end");
    const auto it = objects_.find(id);
    if (it == objects_.end()) file_.fail("an object that is not there", id);
    const Object& object = it->second;
    const std::size_t first = raw_.nodes.size();
    if ((first + object.vertices.size()) / 64 > file_.bytes().size())
      file_.fail("more copies of objects than the file's size allows");
    const bool mirrored = transform.linear().determinant() < 0;
    for (const Vec3& p : object.vertices) {
      raw_.node_numbers.push_back(raw_.nodes.size());
      raw_.nodes.push_back(transform * p);
    }
    auto* members =
        object.name.empty() || object.triangles.empty() ? nullptr : &members_of(raw_.element_sets, object.name);
    for (const auto& t : object.triangles) {
      for (const std::size_t k : mirrored ? std::array<std::size_t, 3>{0, 2, 1} : std::array<std::size_t, 3>{0, 1, 2}) {
        if (t[k] >= object.vertices.size())
          file_.fail("vertex index out of range", std::to_string(t[k]), std::to_string(object.vertices.size()));
        raw_.triangles.push_back(first + t[k]);
      }
      raw_.triangle_numbers.push_back(raw_.triangle_numbers.size());
      if (members != nullptr) members->push_back(raw_.triangle_numbers.back());
    }
    for (const Component& component : object.components)
      add(component.object, transform * component.transform, depth + 1);
  }

  InputFile file_;
  std::map<std::string, Object> objects_;
  std::vector<Component> items_;
  std::size_t parts_ = 0;
  RawMesh raw_;
};

}  // namespace

MeshFile read_3mf(const std::filesystem::path& file) {
  return Reader(file).read();
}

}  // namespace scan2fea
