// Where each node lies in the cell of its nearest lattice point: with the orientation field, a lattice of equilateral
// triangles laid on the scan.
// Source: Jakob et al. (2015), section 4, in intrinsic lattice coordinates instead of points of space.
#pragma once

#include "preproc/surface/orientation_field.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace scan2fea {

// (u, v) stands for u a + v b, a the node's direction times its edge length, b the same turned by 60°.
using LatticeCoordinates = std::array<float, 2>;

// How coordinates at one node become coordinates at its neighbour: `turns` times 60°, then a shift.
struct LatticeStep {
  int turns = 0;  // 0 to 5
  LatticeCoordinates shift{};
};

// A node as the lattice sees it.
struct LatticeNode {
  LatticeNode(const Vec3& at, const Vec3& normal, const Complex& along, double length)
      : position(at), frame(normal), direction(along), edge_length(length) {}

  Vec3 position;
  TangentFrame frame;
  Complex direction;
  double edge_length;
};

// The step from `from` to `to`. The displacement is measured in the mean of both tangent planes, stretched to its true
// length, in lattice axes half-way between the two nodes' and in units of their mean edge length, so that the step back
// is the inverse.
LatticeStep lattice_step(const LatticeNode& from, const LatticeNode& to);

// Turning by 60° is an integer map in these coordinates: (u, v) -> (-v, u + v).
inline LatticeCoordinates turned(const LatticeCoordinates& p, int turns) {
  const auto [u, v] = p;
  switch (turns) {
    case 1:
      return {-v, u + v};
    case 2:
      return {-u - v, u};
    case 3:
      return {-u, -v};
    case 4:
      return {v, -u - v};
    case 5:
      return {u + v, -u};
    default:
      return p;
  }
}

inline LatticeCoordinates carried(const LatticeStep& step, const LatticeCoordinates& p) {
  const LatticeCoordinates q = turned(p, step.turns);
  return {q[0] + step.shift[0], q[1] + step.shift[1]};
}

// The lattice point nearest to (u, v): round u, v and -u-v, and mend the one with the largest rounding error.
LatticeCoordinates nearest_lattice_point(const LatticeCoordinates& p);

// Squared length of u a + v b where the edge length is 1.
inline float squared_length(const LatticeCoordinates& p) {
  return p[0] * p[0] + p[0] * p[1] + p[1] * p[1];
}

struct PositionOptions {
  int sweeps = 4;  // of Gauss-Seidel on each level, 1 or more
};

// Per node of the finest level, its coordinates relative to its nearest lattice point.
struct PositionField {
  std::vector<LatticeCoordinates> offsets;
};

// Sets each node to the running mean of what its neighbours' coordinates predict, each prediction taken at its nearest
// lattice image; coarse to fine. Deterministic for any number of threads. Linear.
PositionField compute_position_field(const FieldGraph& graph, const OrientationField& orientation,
                                     const PositionOptions& options = {});

}  // namespace scan2fea
