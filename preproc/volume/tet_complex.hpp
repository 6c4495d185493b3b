// A tetrahedral mesh that can be changed locally: what every move of the optimisation works on.
#pragma once

#include "preproc/mesh/tet_mesh.hpp"
#include "preproc/volume/face_links.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

// Elements have slots that are reused, links to their face neighbours, and a cached quality. Boundary triangles are
// links too, so a move cannot lose one: `replace` hands them from the old element to the new.
class TetComplex {
 public:
  // A link is an element, or a boundary triangle with this bit set.
  static constexpr std::uint32_t boundary_bit = std::uint32_t{1} << 31;

  struct Element {
    Tetrahedron corners;
    std::array<std::uint32_t, 4> link;  // across the face opposite each corner
    double quality;                     // goal_quality; below any other where the slot is free
    std::uint32_t version;              // changes whenever the slot's corners or their places do
    std::uint32_t tried;                // bits that the moves set, cleared when this or a face neighbour changes
  };

  // Of a first-order mesh with positive tetrahedra. Nodes of the boundary are fixed.
  explicit TetComplex(const TetMesh& mesh);

  // Nodes that no element uses are dropped, unless fixed or among the first `kept`; the others keep their order.
  TetMesh to_mesh(std::size_t kept) const;

  std::size_t slot_count() const { return elements_.size(); }
  bool alive(std::uint32_t t) const { return elements_[t].corners[0] != no_link; }
  const Element& element(std::uint32_t t) const { return elements_[t]; }
  double quality(std::uint32_t t) const { return elements_[t].quality; }
  void mark_tried(std::uint32_t t, std::uint32_t bit) { elements_[t].tried |= bit; }

  std::size_t node_count() const { return nodes_.size(); }
  const Vec3& node(std::uint32_t v) const { return nodes_[v]; }
  bool fixed(std::uint32_t v) const { return fixed_[v]; }
  // False for a node that insertion removed.
  bool used(std::uint32_t v) const { return element_of_[v] != no_link; }

  // The elements around a node, in a fixed order.
  void star(std::uint32_t v, std::vector<std::uint32_t>& elements) const;

  // The elements around the edge from corner i to corner j of element t, and the vertices between them: element k is
  // (a, b, vertices[k], vertices[k + 1]), positive. False on a boundary edge, and where there are more than fit.
  struct Ring {
    static constexpr std::size_t capacity = 7;
    std::uint32_t a, b;
    std::size_t size;
    std::array<std::uint32_t, capacity> elements;
    std::array<std::uint32_t, capacity> vertices;
  };
  bool ring(std::uint32_t t, std::size_t i, std::size_t j, Ring& ring) const;

  std::uint32_t add_node(const Vec3& place);
  // `around` is the node's star.
  void move_node(std::uint32_t v, const Vec3& place, std::span<const std::uint32_t> around);

  // Replaces elements by others that fill the same space, given with their qualities. O(size of the cavity squared).
  struct Fresh {
    Tetrahedron corners;
    double quality;
  };
  void replace(std::span<const std::uint32_t> old, std::span<const Fresh> fresh);
  // The slots of the last replacement's elements.
  std::span<const std::uint32_t> fresh_slots() const { return slots_; }

  // A set of elements for the caller's own walks: `begin_marks` empties it. Const walks use it too.
  void begin_marks() const { ++mark_; }
  void mark(std::uint32_t t) const { mark_of_[t] = mark_; }
  bool marked(std::uint32_t t) const { return mark_of_[t] == mark_; }
  void unmark(std::uint32_t t) const { mark_of_[t] = 0; }

 private:
  // A face that waits for its other side: an element's, known by that element's corner, or a boundary triangle.
  struct OpenFace {
    Triangle key;  // sorted corners
    std::uint32_t link;
    std::uint32_t corner;
  };
  void open_outer_faces(std::span<const std::uint32_t> old);
  void open_or_close(std::uint32_t t, std::uint32_t corner);
  std::uint32_t take_slot();

  std::vector<Vec3> nodes_;
  std::vector<bool> fixed_;
  std::vector<std::uint32_t> element_of_;  // one element around each node
  std::vector<Element> elements_;
  std::vector<std::uint32_t> free_;
  std::size_t triangle_count_ = 0;
  mutable std::uint32_t mark_ = 0;
  mutable std::vector<std::uint32_t> mark_of_;
  std::vector<OpenFace> open_;  // scratch of `replace`
  std::vector<std::uint32_t> slots_;
};

// The corner of an element at which a node stands.
inline std::size_t corner_of(const Tetrahedron& t, std::uint32_t v) {
  return v == t[0] ? 0u : v == t[1] ? 1u : v == t[2] ? 2u : 3u;
}

}  // namespace scan2fea
