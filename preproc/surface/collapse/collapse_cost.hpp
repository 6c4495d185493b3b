// The predictors of `collapse`: what contracting an edge would cost. Source: [1], section 3 (bending energy; README.md
// lists the sources); quadrics: Garland and Heckbert, 1997.
#pragma once

#include "preproc/surface/collapse/collapse_options.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <array>
#include <vector>

namespace scan2fea {

// The faces that stay around the merged vertex of a contraction, as the half-edges opposite to it, counter-clockwise:
// a cycle, but for a border, where they are the faces of one end and then those of the other.
void merged_rim(const HalfedgeMesh& mesh, HalfedgeMesh::Index h, std::vector<HalfedgeMesh::Index>& rim);

class CollapsePredictor {
 public:
  using Index = HalfedgeMesh::Index;

  // Keeps a reference to the mesh, and reads it as it is when asked.
  CollapsePredictor(const HalfedgeMesh& mesh, CollapseCost cost, std::vector<double> sizing);

  // The cost of contracting h to its midpoint. Not the same for h and its opposite to the last digit: ask for the one
  // of lower index.
  double operator()(Index h) const;

  // To be told before the mesh merges `removed` into `kept`.
  void merge(Index kept, Index removed);

  // Whether contractions two edges away change the cost: a key in the queue is then only a guess.
  bool sees_far() const { return cost_ == CollapseCost::bending_energy; }

 private:
  // x A x + 2 b x + c over points relative to centre_; upper triangle of A by rows.
  struct Quadric {
    std::array<double, 6> a{};
    Vec3 b = Vec3::Zero();
    double c = 0;
  };

  void build_quadrics();
  double bending_energy(Index h) const;
  double quadric_error(Index h) const;
  double sized_length(Index h) const;

  const HalfedgeMesh& mesh_;
  CollapseCost cost_;
  std::vector<double> sizing_;
  std::vector<Quadric> quadrics_;
  Vec3 centre_ = Vec3::Zero();
  double flat_energy_ = 0;  // times the edge's squared length: gives flat parts an order, by length
  mutable std::vector<Index> rim_;
  mutable std::vector<Vec3> normals_;
};

}  // namespace scan2fea
