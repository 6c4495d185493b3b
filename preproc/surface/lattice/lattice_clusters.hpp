// Which nodes of the refined scan become one vertex of the lattice.
#pragma once

#include "preproc/mesh/union_find.hpp"
#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/lattice/position_field.hpp"

#include <cstdint>
#include <limits>
#include <vector>

namespace scan2fea {

struct ExtractedLattice {
  SurfaceMesh mesh;
  std::vector<std::uint32_t> vertex_of_node;  // per vertex of the refined scan, the vertex of `mesh` that it belongs to
  FeatureNet net;                             // empty without features
  bool contracted = false;                    // see extract_lattice
};

// Disjoint sets of nodes, each with the mean of its nodes' lattice points. The nodes of a sample, on whatever side of a
// feature, are one set at its place from the start; two such sets never become one.
class LatticeClusters {
 public:
  // Each node by itself, but for samples. References are kept.
  LatticeClusters(const FieldGraph& graph, const OrientationField& orientation, const PositionField& position);

  std::size_t size() const { return next_.size(); }  // number of nodes
  // The set's member with the smallest number.
  std::uint32_t find(std::uint32_t node) { return sets_.find(node); }
  // Of a root:
  double cells(std::uint32_t root) const { return cells_[root]; }  // area, in cells of the lattice
  bool is_anchored(std::uint32_t root) const { return is_anchored_[root]; }
  Vec3 point(std::uint32_t root) const { return points_[root] / counts_[root]; }

  // Gives all nodes of the set to the neighbouring set whose lattice point is nearest. False where there is no other,
  // and for a sample's.
  bool dissolve(std::uint32_t root);

 private:
  struct Join {
    std::uint32_t a, b;
  };

  void join_anchored(const std::vector<Vec3>& anchors);
  std::vector<Join> joins_by_residual(const PositionField& position) const;
  void join_if_near(const Join& join);
  void dissolve_small();
  std::uint32_t merge(std::uint32_t a, std::uint32_t b);
  template <class Visit>
  void for_each_neighbour_set(std::uint32_t root, const Visit& visit);

  const GraphLevel* graph_;
  UnionFind sets_;
  std::vector<std::uint32_t> next_;  // the members of a set, in a ring
  std::vector<Vec3> points_;         // per root, sum of lattice points
  std::vector<double> counts_;       // per root, of how many
  std::vector<double> lengths_;
  std::vector<double> cells_;
  std::vector<bool> is_anchored_;
};

// The refined scan as it was before it was cut along its features. `welded`: per vertex of `cut`, the vertex that it is
// a copy of. Faces keep their order.
SurfaceMesh welded_scan(const SurfaceMesh& cut, const std::vector<std::uint32_t>& welded);

}  // namespace scan2fea
