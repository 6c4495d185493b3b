#include "preproc/volume/tet_complex.hpp"

#include "preproc/mesh/sorted_corners.hpp"
#include "preproc/volume/tet_quality.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace scan2fea {
namespace {

constexpr Tetrahedron no_corners{no_link, no_link, no_link, no_link};

}  // namespace

TetComplex::TetComplex(const TetMesh& mesh)
    : nodes_(mesh.nodes),
      fixed_(mesh.nodes.size(), false),
      element_of_(mesh.nodes.size(), no_link),
      triangle_count_(mesh.boundary.size()),
      mark_of_(mesh.tetrahedra.size(), 0) {
  std::vector<Triangle> triangles;
  triangles.reserve(mesh.boundary.size());
  for (const BoundaryFace f : mesh.boundary) {
    triangles.push_back(boundary_triangle(mesh, f));
    for (const std::uint32_t v : triangles.back()) fixed_[v] = true;
  }
  const FaceLinks links = link_faces(mesh.tetrahedra, triangles, mesh.nodes.size());
  elements_.reserve(mesh.tetrahedra.size());
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const Tetrahedron& corners = mesh.tetrahedra[t];
    Element element{corners, links.neighbour[t],
                    goal_quality(nodes_[corners[0]], nodes_[corners[1]], nodes_[corners[2]], nodes_[corners[3]]), 0, 0};
    for (std::size_t k = 0; k < 4; ++k)
      if (links.triangle[t][k] != no_link) element.link[k] = boundary_bit | links.triangle[t][k];
    elements_.push_back(element);
    for (const std::uint32_t v : corners) element_of_[v] = t;
  }
}

TetMesh TetComplex::to_mesh(std::size_t kept) const {
  TetMesh mesh;
  std::vector<std::uint32_t> renumbered(nodes_.size(), no_link);
  for (std::size_t v = 0; v < nodes_.size(); ++v) {
    if (v >= kept && !fixed_[v] && element_of_[v] == no_link) continue;
    renumbered[v] = static_cast<std::uint32_t>(mesh.nodes.size());
    mesh.nodes.push_back(nodes_[v]);
  }
  mesh.boundary.resize(triangle_count_);
  mesh.tetrahedra.reserve(elements_.size());
  for (const Element& element : elements_) {
    if (element.corners[0] == no_link) continue;
    const auto t = static_cast<std::uint32_t>(mesh.tetrahedra.size());
    Tetrahedron corners = element.corners;
    for (std::uint32_t& v : corners) v = renumbered[v];
    mesh.tetrahedra.push_back(corners);
    for (std::size_t k = 0; k < 4; ++k)
      if (element.link[k] & boundary_bit)
        mesh.boundary[element.link[k] & ~boundary_bit] = {t, face_of_opposite_corner[k]};
  }
  return mesh;
}

void TetComplex::star(std::uint32_t v, std::vector<std::uint32_t>& elements) const {
  elements.clear();
  begin_marks();
  elements.push_back(element_of_[v]);
  mark(elements.back());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const Element& element = elements_[elements[i]];
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t n = element.link[k];
      if (element.corners[k] == v || (n & boundary_bit) || marked(n)) continue;
      mark(n);
      elements.push_back(n);
    }
  }
}

bool TetComplex::ring(std::uint32_t t, std::size_t i, std::size_t j, Ring& ring) const {
  // The third corner k such that (i, j, k, l) is an even permutation.
  static constexpr std::array<std::array<std::uint8_t, 4>, 4> third{
      {{0, 2, 3, 1}, {3, 0, 0, 2}, {1, 3, 0, 0}, {2, 0, 1, 0}}};
  const std::size_t k = third[i][j], l = 6 - i - j - k;
  const Tetrahedron& first = elements_[t].corners;
  ring.a = first[i];
  ring.b = first[j];
  // Each element is left through the face opposite its earlier ring vertex, until the first comes again.
  std::uint32_t behind = first[k], ahead = first[l], element = t;
  for (ring.size = 0; ring.size < Ring::capacity;) {
    ring.elements[ring.size] = element;
    ring.vertices[ring.size++] = behind;
    const std::uint32_t next = elements_[element].link[corner_of(elements_[element].corners, behind)];
    if (next == t) return true;
    if (next & boundary_bit) return false;
    const Tetrahedron& c = elements_[next].corners;
    behind = ahead;
    // The corner that is none of a, b and `behind`; exclusive or, since each of the three is there once.
    ahead = c[0] ^ c[1] ^ c[2] ^ c[3] ^ ring.a ^ ring.b ^ behind;
    element = next;
  }
  return false;
}

std::uint32_t TetComplex::add_node(const Vec3& place) {
  nodes_.push_back(place);
  fixed_.push_back(false);
  element_of_.push_back(no_link);
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

void TetComplex::move_node(std::uint32_t v, const Vec3& place, std::span<const std::uint32_t> around) {
  nodes_[v] = place;
  for (const std::uint32_t t : around) {
    Element& element = elements_[t];
    const Tetrahedron& c = element.corners;
    element.quality = goal_quality(nodes_[c[0]], nodes_[c[1]], nodes_[c[2]], nodes_[c[3]]);
    element.tried = 0;
    ++element.version;
    if (const std::uint32_t n = element.link[corner_of(c, v)]; !(n & boundary_bit)) elements_[n].tried = 0;
  }
}

void TetComplex::replace(std::span<const std::uint32_t> old, std::span<const Fresh> fresh) {
  open_outer_faces(old);
  for (const std::uint32_t t : old) {
    for (const std::uint32_t v : elements_[t].corners) element_of_[v] = no_link;
    elements_[t].corners = no_corners;
    elements_[t].quality = -std::numeric_limits<double>::infinity();
    ++elements_[t].version;
  }
  free_.insert(free_.end(), old.rbegin(), old.rend());

  slots_.clear();
  for (const Fresh& f : fresh) {
    const std::uint32_t t = take_slot();
    slots_.push_back(t);
    Element& element = elements_[t];
    element.corners = f.corners;
    element.quality = f.quality;
    element.tried = 0;
    ++element.version;
    for (const std::uint32_t v : f.corners) element_of_[v] = t;
    for (std::uint32_t k = 0; k < 4; ++k) open_or_close(t, k);
  }
  assert(open_.empty());
}

void TetComplex::open_outer_faces(std::span<const std::uint32_t> old) {
  open_.clear();
  begin_marks();
  for (const std::uint32_t t : old) mark(t);
  for (const std::uint32_t t : old) {
    const Element& element = elements_[t];
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t n = element.link[k];
      if (n & boundary_bit) {
        open_.push_back({sorted(face_opposite(element.corners, k)), n, 0});
      } else if (!marked(n)) {
        const auto& back = elements_[n].link;
        const auto corner = static_cast<std::uint32_t>(std::find(back.begin(), back.end(), t) - back.begin());
        open_.push_back({sorted(face_opposite(element.corners, k)), n, corner});
        elements_[n].tried = 0;
      }
    }
  }
}

void TetComplex::open_or_close(std::uint32_t t, std::uint32_t corner) {
  const Triangle key = sorted(face_opposite(elements_[t].corners, corner));
  for (OpenFace& other : open_) {
    if (other.key != key) continue;
    elements_[t].link[corner] = other.link;
    if (!(other.link & boundary_bit)) elements_[other.link].link[other.corner] = t;
    other = open_.back();
    open_.pop_back();
    return;
  }
  open_.push_back({key, t, corner});
}

std::uint32_t TetComplex::take_slot() {
  if (free_.empty()) {
    elements_.push_back({no_corners, {}, 0, 0, 0});
    mark_of_.push_back(0);
    return static_cast<std::uint32_t>(elements_.size() - 1);
  }
  const std::uint32_t t = free_.back();
  free_.pop_back();
  return t;
}

}  // namespace scan2fea
