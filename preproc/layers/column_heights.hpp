// How high the layers may be at each vertex.
#pragma once

#include "preproc/layers/layer_directions.hpp"
#include "preproc/layers/layer_heights.hpp"
#include "quality/triangle_tree.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

// A first layer's height over an edge of its triangle, at least: elements so flat have dihedral angles of half a
// degree, which solvers refuse, and curved ones may lose half of theirs.
inline constexpr double flattest_straight = 0.01, flattest_curved = 0.02;

// Throws NotMeshable where a first layer is flatter. `unit`: of lengths here, in those that messages show.
void require_high_layers(const SurfaceMesh& surface, const LayeredTriangles& layered, double flattest, double unit);

// The height of all layers together behind each vertex of a surface: as asked for, and lower where there is no room for
// it. It falls to zero where layers taper off, by at most 0.6 for one along the surface.
class ColumnHeights {
 public:
  // `tree` holds the surface's triangles. A fifth of a wall stays free of layers. Keeps references.
  ColumnHeights(const SurfaceMesh& surface, const TriangleTree& tree, const VertexStars& stars,
                const LayeredTriangles& layered, const LayerDirections& directions, double flattest);

  double at(std::uint32_t vertex) const { return height_[vertex]; }
  double asked(std::uint32_t vertex) const { return asked_[vertex]; }
  // What there is room for, whatever tapers off beside it.
  double room(std::uint32_t vertex) const { return room_[vertex]; }
  // Behind so much lower layers there are none: they taper off.
  bool has_layers(std::uint32_t vertex) const { return height_[vertex] > 0; }

  // Lower behind each of these groups of vertices than its highest column is, and around them as far as it must be.
  // Below a tenth of what was asked for, and where the first one would be flatter than `flattest`, there are none.
  // False where none had layers any more.
  bool lower_at(const std::vector<std::vector<std::uint32_t>>& groups);
  // No layers behind these vertices.
  void drop(const std::vector<std::uint32_t>& vertices);

 private:
  void keep_walls(const TriangleTree& tree);
  void settle();
  bool drop_lowest();
  void taper();

  const SurfaceMesh& surface_;
  const VertexStars& stars_;
  const LayeredTriangles& layered_;
  std::vector<bool> has_way_;
  std::vector<double> asked_, room_, lowest_, height_;
};

}  // namespace scan2fea
