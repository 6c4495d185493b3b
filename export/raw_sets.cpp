#include "export/raw_sets.hpp"

#include "export/set_names.hpp"
#include "preproc/mesh/sorted_corners.hpp"

#include <algorithm>
#include <map>
#include <numeric>

namespace scan2fea {
namespace {

// Where a number stands in a list of numbers.
class Index {
 public:
  explicit Index(const std::vector<std::uint64_t>& numbers) : numbers_(numbers), order_(numbers.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    const auto less = [&](std::uint32_t a, std::uint32_t b) { return numbers_[a] < numbers_[b]; };
    if (!std::is_sorted(order_.begin(), order_.end(), less)) std::stable_sort(order_.begin(), order_.end(), less);
  }

  std::optional<std::uint32_t> find(std::uint64_t number) const {
    const auto it = std::lower_bound(order_.begin(), order_.end(), number,
                                     [&](std::uint32_t i, std::uint64_t wanted) { return numbers_[i] < wanted; });
    if (it == order_.end() || numbers_[*it] != number) return {};
    return *it;
  }

 private:
  const std::vector<std::uint64_t>& numbers_;
  std::vector<std::uint32_t> order_;
};

// Finds faces by their corners, or by element and face: those of the boundary, and those between two elements, which
// then are added to the mesh's.
class FaceIndex {
 public:
  explicit FaceIndex(TetMesh& mesh) : mesh_(mesh), outer_(mesh.outer_faces()) {}

  std::optional<std::uint32_t> find(const Triangle& corners) {
    if (by_corners_.empty()) {
      for (std::uint32_t i = 0; i < outer_; ++i) add_corners(by_corners_, mesh_.boundary[i], i);
      std::sort(by_corners_.begin(), by_corners_.end());
    }
    if (const auto outer = find_in(by_corners_, corners)) return outer;
    if (inner_.empty()) {
      for (std::uint32_t t = 0; t < mesh_.tetrahedra.size(); ++t)
        for (std::uint8_t k = 0; k < 4; ++k) add_corners(inner_, {t, k}, 4 * t + k);
      std::sort(inner_.begin(), inner_.end());
    }
    const auto inner = find_in(inner_, corners);  // of the element with the smaller number
    if (!inner) return {};
    return between({*inner / 4, static_cast<std::uint8_t>(*inner % 4)});
  }

  // `find_boundary` orders by element and face.
  std::optional<std::uint32_t> find(std::uint32_t element, std::uint8_t face) {
    const auto key = [](const BoundaryFace& f) { return std::pair(f.tetrahedron, f.face); };
    const auto end = mesh_.boundary.begin() + static_cast<std::ptrdiff_t>(outer_);
    const auto it = std::lower_bound(mesh_.boundary.begin(), end, std::pair(element, face),
                                     [&](const BoundaryFace& f, const auto& wanted) { return key(f) < wanted; });
    if (it != end && key(*it) == std::pair(element, face))
      return static_cast<std::uint32_t>(it - mesh_.boundary.begin());
    return between({element, face});
  }

 private:
  using Faces = std::vector<std::pair<Triangle, std::uint32_t>>;

  void add_corners(Faces& faces, BoundaryFace f, std::uint32_t number) const {
    faces.emplace_back(sorted(boundary_triangle(mesh_, f)), number);
  }

  static std::optional<std::uint32_t> find_in(const Faces& faces, const Triangle& corners) {
    const std::pair<Triangle, std::uint32_t> wanted(sorted(corners), 0);
    const auto it = std::lower_bound(faces.begin(), faces.end(), wanted);
    if (it == faces.end() || it->first != wanted.first) return {};
    return it->second;
  }

  std::uint32_t between(BoundaryFace f) {
    const auto [at, is_new] =
        between_.try_emplace({f.tetrahedron, f.face}, static_cast<std::uint32_t>(mesh_.boundary.size()));
    if (is_new) {
      mesh_.boundary.push_back(f);
      ++mesh_.faces_between;
    }
    return at->second;
  }

  TetMesh& mesh_;
  std::size_t outer_;
  Faces by_corners_, inner_;
  std::map<std::pair<std::uint32_t, std::uint8_t>, std::uint32_t> between_;
};

// A name is a line of text.
std::string name_of(const std::string& given) {
  std::string name = given.empty() ? "UNNAMED" : given;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '_');
  return name;
}

void add(std::vector<NamedSet>& sets, const std::string& given, std::vector<std::uint32_t> members) {
  if (is_reserved_set(given)) return;
  const std::string name = name_of(given);
  const std::size_t i = find_set(sets, name);
  if (i == sets.size()) {
    sets.push_back(named_set(name, std::move(members)));
    return;
  }
  members.insert(members.end(), sets[i].members.begin(), sets[i].members.end());
  sets[i] = named_set(sets[i].name, std::move(members));
}

void tell(std::size_t count, const char* what, const std::string& name, std::vector<std::string>& warnings) {
  if (count > 0 && !is_reserved_set(name))
    warnings.push_back("set " + name_of(name) + ": " + std::to_string(count) + " " + what + " left out");
}

std::vector<NamedSet> node_sets(const RawMesh& raw, const FindNode& find_node, std::vector<std::string>& warnings) {
  std::vector<NamedSet> sets;
  for (const RawSet& set : raw.node_sets) {
    std::vector<std::uint32_t> members;
    std::size_t unused = 0;
    for (const std::uint64_t number : set.members) {
      if (const auto node = find_node(number))
        members.push_back(*node);
      else
        ++unused;
    }
    tell(unused, "nodes of no element of the mesh are", set.name, warnings);
    add(sets, set.name, std::move(members));
  }
  return sets;
}

}  // namespace

void add_sets(const RawMesh& raw, const FindNode& find_node, TetMesh& mesh, std::vector<std::string>& warnings) {
  mesh.node_sets = node_sets(raw, find_node, warnings);
  if (raw.element_sets.empty() && raw.face_sets.empty()) return;
  const Index tetrahedra(raw.tetrahedron_numbers), triangles(raw.triangle_numbers);
  FaceIndex all_faces(mesh);
  for (const RawSet& set : raw.element_sets) {
    std::vector<std::uint32_t> elements, faces;
    std::size_t unknown = 0, inside = 0;
    for (const std::uint64_t number : set.members) {
      if (const auto t = tetrahedra.find(number)) {
        elements.push_back(*t);
      } else if (const auto i = triangles.find(number)) {
        Triangle corners;
        std::optional<std::uint32_t> face;
        bool known = true;
        for (std::size_t k = 0; k < 3; ++k) {
          const auto node = find_node(raw.triangles[3 * *i + k]);
          known = known && node;
          corners[k] = node.value_or(0);
        }
        if (known) face = all_faces.find(corners);
        if (face)
          faces.push_back(*face);
        else
          ++inside;
      } else {
        ++unknown;
      }
    }
    tell(unknown, "elements that are neither tetrahedra nor triangles are", set.name, warnings);
    tell(inside, "triangles that are no faces of elements are", set.name, warnings);
    const bool is_empty = elements.empty() && faces.empty();
    if (!elements.empty() || (is_empty && unknown + inside == 0)) add(mesh.element_sets, set.name, std::move(elements));
    if (!faces.empty()) add(mesh.face_sets, set.name, std::move(faces));
  }
  for (const RawFaceSet& set : raw.face_sets) {
    std::vector<std::uint32_t> faces;
    std::size_t inside = 0;
    for (const auto& [number, face] : set.faces) {
      const auto t = tetrahedra.find(number);
      const auto found = t ? all_faces.find(*t, face) : std::nullopt;
      if (found)
        faces.push_back(*found);
      else
        ++inside;
    }
    tell(inside, "faces of elements that are not there are", set.name, warnings);
    add(mesh.face_sets, set.name, std::move(faces));
  }
}

void add_sets(const RawMesh& raw, const FindNode& find_node, NamedSurface& surface,
              std::vector<std::string>& warnings) {
  surface.node_sets = node_sets(raw, find_node, warnings);
  if (raw.element_sets.empty()) return;
  const Index triangles(raw.triangle_numbers);
  for (const RawSet& set : raw.element_sets) {
    std::vector<std::uint32_t> faces;
    std::size_t unknown = 0;
    for (const std::uint64_t number : set.members) {
      if (const auto i = triangles.find(number))
        faces.push_back(*i);
      else
        ++unknown;
    }
    tell(unknown, "elements that are not triangles are", set.name, warnings);
    if (!faces.empty() || unknown == 0) add(surface.face_sets, set.name, std::move(faces));
  }
}

void drop_nodes_of_face_sets(TetMesh& mesh, const std::string& ending) {
  for (const NamedSet& faces : mesh.face_sets) {
    const std::size_t i = find_set(mesh.node_sets, faces.name + ending);
    if (i < mesh.node_sets.size() && mesh.node_sets[i].members == nodes_of_faces(mesh, faces.members))
      mesh.node_sets.erase(mesh.node_sets.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

}  // namespace scan2fea
