// Where each node lies in the cell of its nearest lattice point: with the orientation field, a lattice of equilateral
// triangles laid on the scan.
// Source: Jakob et al. (2015), section 4, in intrinsic lattice coordinates instead of points of space.
#pragma once

#include "preproc/surface/lattice/orientation_field.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace scan2fea {

// (u, v) stands for u a + v b, a the node's direction times its edge length, b the same turned by 60°.
using LatticeCoordinates = std::array<float, 2>;

// How coordinates at one node become coordinates at its neighbour: `turns` times 60°, then a shift.
struct LatticeStep {
  LatticeCoordinates shift{};
  std::int32_t turns = 0;  // 0 to 5
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

// The step from `from` to `to`. The displacement is measured in the mean of both tangent planes, stretched to the way
// over the line where they meet (the chord would lay too few triangles where the surface bends), in lattice axes
// half-way between the two nodes' and in units of their mean edge length, so that the step back is the inverse.
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

inline LatticeStep inverse(const LatticeStep& step) {
  const int turns = step.turns == 0 ? 0 : 6 - step.turns;
  const LatticeCoordinates back = turned(step.shift, turns);
  return {{-back[0], -back[1]}, turns};
}

inline LatticeCoordinates carried(const LatticeStep& step, const LatticeCoordinates& p) {
  const LatticeCoordinates q = turned(p, step.turns);
  return {q[0] + step.shift[0], q[1] + step.shift[1]};
}

// To the nearest integer, for |x| < 2^22: std::nearbyint is a function call, and sweeps round a lot.
inline float rounded(float x) {
  constexpr float shift = 12582912.0F;  // 1.5 * 2^23, above which floats are integers
  return (x + shift) - shift;
}

// The lattice point nearest to (u, v): round u, v and -u-v, and mend the one with the largest rounding error.
inline LatticeCoordinates nearest_lattice_point(const LatticeCoordinates& p) {
  const float w = -p[0] - p[1];
  const float u = rounded(p[0]), v = rounded(p[1]), rw = rounded(w);
  const float eu = std::abs(u - p[0]), ev = std::abs(v - p[1]), ew = std::abs(rw - w);
  // Which one is the worst is as good as random, so this is arithmetic instead of branches.
  const bool mend_u = (eu > ev) & (eu > ew), mend_v = !mend_u & (ev > ew);
  return {u - static_cast<float>(mend_u) * (u + v + rw), v - static_cast<float>(mend_v) * (u + v + rw)};
}

// Squared length of u a + v b where the edge length is 1.
inline float squared_length(const LatticeCoordinates& p) {
  return p[0] * p[0] + p[0] * p[1] + p[1] * p[1];
}

struct PositionOptions {
  int sweeps = 4;  // of Gauss-Seidel on each level, 1 or more
};

// The residuals of edges whose ends share a lattice point are below this.
inline constexpr std::uint16_t no_shared_point = 256;

struct PositionField {
  std::vector<LatticeCoordinates> offsets;  // per node of the finest level, its coordinates from its nearest point
  // Per edge of the finest level, from the neighbour of the smaller index: by how much its ends disagree about where
  // the lattice point is that they share, in 1/256 of an edge length; `no_shared_point` where they have different ones.
  std::vector<std::uint16_t> residuals;
};

// Sets each node to the running mean of what its neighbours' coordinates predict, each prediction taken at its nearest
// lattice image; coarse to fine. Nodes on features lie where their anchors say, on all levels. Deterministic for any
// number of threads. Linear.
PositionField compute_position_field(const FieldGraph& graph, const OrientationField& orientation,
                                     const PositionOptions& options = {});

}  // namespace scan2fea
