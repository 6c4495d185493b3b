// Connectivity of an oriented manifold triangle surface in flat arrays, for stages that change it.
// A corner table: half-edge 3 f + i runs from corner i of face f to corner i + 1, with its face on its left, so that
// `next`, `prev` and `face` are arithmetic and only origins and opposites are stored (24 bytes a face).
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace scan2fea {

class HalfedgeMesh {
 public:
  using Index = std::uint32_t;
  static constexpr Index none = ~Index{0};  // opposite of a border half-edge; outgoing of a vertex without faces

  // O(n). Throws NotMeshable, naming face or vertex, where the surface is not an oriented manifold (borders are
  // allowed): an edge with three faces or with two that disagree in orientation, fans that touch in one vertex only,
  // a triangle that uses a vertex twice.
  explicit HalfedgeMesh(const SurfaceMesh& mesh);

  // Live faces in order; vertices that no face uses are dropped, the others keep their order.
  SurfaceMesh to_surface() const;

  // Positions, one per vertex, removed ones included; free to be moved.
  std::vector<Vec3> points;

  static Index face(Index h) { return h / 3; }
  static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static Index prev(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
  Index origin(Index h) const { return origin_[h]; }
  Index target(Index h) const { return origin_[next(h)]; }
  Index opposite(Index h) const { return opposite_[h]; }
  bool is_border(Index h) const { return opposite_[h] == none; }

  // A half-edge that starts at v; where v lies on a border, the one from which turning counter-clockwise meets all its
  // faces. `none` where v has no face.
  Index outgoing(Index v) const { return outgoing_[v]; }
  bool is_alive(Index v) const { return outgoing_[v] != none; }
  bool is_border_vertex(Index v) const { return is_border(outgoing_[v]); }
  bool is_face_alive(Index f) const { return origin_[3 * std::size_t{f}] != none; }

  std::size_t vertex_slots() const { return outgoing_.size(); }  // removed ones included
  std::size_t face_slots() const { return origin_.size() / 3; }
  std::size_t face_count() const { return face_count_; }

  Triangle triangle(Index f) const {
    const std::size_t h = 3 * std::size_t{f};
    return {origin_[h], origin_[h + 1], origin_[h + 2]};
  }
  // Twice the area, times the unit normal.
  Vec3 area_vector(Index f) const {
    const Triangle t = triangle(f);
    return (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
  }

  // Half-edges that start at v, counter-clockwise; one per face of v.
  template <class Visit>
  void for_each_outgoing(Index v, Visit visit) const {
    const Index start = outgoing_[v];
    if (start == none) return;
    Index h = start;
    do {
      visit(h);
      h = opposite_[prev(h)];
    } while (h != none && h != start);
  }

  // Neighbours of v, counter-clockwise; at a border, from one end of the fan to the other.
  template <class Visit>
  void for_each_neighbour(Index v, Visit visit) const {
    const Index start = outgoing_[v];
    if (start == none) return;
    Index h = start;
    while (true) {
      visit(target(h));
      const Index p = prev(h);
      h = opposite_[p];
      if (h == start) return;
      if (h == none) return visit(origin_[p]);
    }
  }

  std::size_t valence(Index v) const;  // number of neighbours

  // The half-edge from a to b, or `none`. O(valence of a).
  Index find_halfedge(Index a, Index b) const;
  bool are_neighbours(Index a, Index b) const;

  // The link condition: merging the ends of h keeps the surface manifold and its topology (Dey, Edelsbrunner et al.).
  bool can_collapse(Index h) const;
  // Merges target(h) into origin(h), which stays where it is; removes the one or two faces at h.
  // Precondition: can_collapse(h).
  void collapse(Index h);

  // False at borders, at vertices that would be left with two neighbours, and where the new edge exists already.
  bool can_flip(Index h) const;
  // Replaces the edge by the other diagonal of its two faces; afterwards h is that diagonal. Precondition: can_flip(h).
  void flip(Index h);

  // Puts a new vertex into the face (1 to 3) or on the edge (2 to 4, at a border 1 to 2) and returns it.
  // split_edge: h then ends at the new vertex.
  Index split_face(Index f, const Vec3& point);
  Index split_edge(Index h, const Vec3& point);

 private:
  void build_opposites();
  void build_outgoing();
  void link(Index h, Index o);
  void set_face(Index f, Index a, Index b, Index c);
  Index add_face(Index a, Index b, Index c);
  void remove_face(Index f);
  void set_outgoing(Index v, Index h);

  std::vector<Index> origin_;    // per half-edge; none in removed faces
  std::vector<Index> opposite_;  // per half-edge
  std::vector<Index> outgoing_;  // per vertex
  std::size_t face_count_ = 0;
};

}  // namespace scan2fea
