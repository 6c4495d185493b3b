// Steps that change a surface, each taken only if the surface does not run through itself afterwards.
#pragma once

#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace scan2fea {

// Of the angle between two faces' normals: below, they are a fold, which no part has but at a knife's edge.
inline constexpr double fold_cosine = -0.3;

// Knows where the faces of a changing mesh are, by a grid. Keeps a reference to the mesh, and must be told of changes
// that it does not make itself.
class ClearSurface {
 public:
  using Index = HalfedgeMesh::Index;

  // `cell`: of the grid, about as long as the edges will be, > 0.
  ClearSurface(HalfedgeMesh& mesh, double cell);

  // Moves a vertex if none of its faces then meets another or has no area, and none of its edges next to no length;
  // false, and nothing changed, otherwise.
  bool move(Index v, const Vec3& place);

  // The same, and none of its faces comes to lie upon one beside it: a surface that is fitted later runs through itself
  // there.
  bool move_without_fold(Index v, const Vec3& place);

  // Whether the two faces that a flip would make meet no others. Where it says so, the edge must be flipped next.
  bool clear_to_flip(Index h);

  // A vertex was put on a face or an edge, in the plane of what it splits.
  void vertex_added(Index v);

 private:
  struct Cells {
    std::int32_t low[3] = {0, 0, 0}, high[3] = {-1, -1, -1};
  };

  Cells cells_of(const Vec3& low, const Vec3& high) const;
  template <class Visit>
  void for_each_cell(const Cells& cells, Visit visit) const;
  void put(Index face, const Cells& cells);
  void put_star(Index v);
  bool meets_others(const Triangle& t, Index face, Index without) const;
  std::vector<double> bends_around(Index v) const;

  HalfedgeMesh& mesh_;
  double cell_;
  std::unordered_map<std::uint64_t, std::vector<Index>> faces_in_;
  std::vector<Cells> cells_;  // per face, those that it is in
};

}  // namespace scan2fea
