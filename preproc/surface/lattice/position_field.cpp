#include "preproc/surface/lattice/position_field.hpp"

#include "preproc/surface/kernel/parallel_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

constexpr double two_over_sqrt3 = 2 / std::numbers::sqrt3;
constexpr double sharpest_fold = 0.5;  // 1 + the cosine of 120°, beyond which normals say nothing about lengths

LatticeNode node(const GraphLevel& level, const std::vector<Complex>& directions, std::size_t i) {
  return {level.positions[i], level.normals[i], directions[i], std::exp(level.log_length[i])};
}

// Per edge, the step from the neighbour to the node.
std::vector<LatticeStep> edge_steps(const GraphLevel& level, const std::vector<Complex>& directions) {
  std::vector<LatticeStep> steps(level.neighbours.size());
  std::vector<double> lengths(level.size());
  for_each_block(level.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) lengths[i] = std::exp(level.log_length[i]);
  });
  for_each_block(level.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const LatticeNode here(level.positions[i], level.normals[i], directions[i], lengths[i]);
      for (std::uint32_t e = level.first[i]; e < level.first[i + 1]; ++e) {
        const std::uint32_t j = level.neighbours[e];
        if (j > i) continue;  // the other end does both
        steps[e] = lattice_step({level.positions[j], level.normals[j], directions[j], lengths[j]}, here);
        steps[level.mate(static_cast<std::uint32_t>(i), e)] = inverse(steps[e]);
      }
    }
  });
  return steps;
}

LatticeCoordinates wrapped(const LatticeCoordinates& p) {
  const LatticeCoordinates q = nearest_lattice_point(p);
  return {p[0] - q[0], p[1] - q[1]};
}

bool is_anchored(const GraphLevel& level, std::size_t node) {
  return !level.anchor.empty() && level.anchor[node] != no_sample;
}

// Coordinates from the anchor: the lattice point there is not to be moved.
void set_anchored(const FieldGraph& graph, const GraphLevel& level, const std::vector<Complex>& directions,
                  std::vector<LatticeCoordinates>& offsets) {
  if (level.anchor.empty()) return;
  for (std::size_t i = 0; i < level.size(); ++i) {
    if (!is_anchored(level, i)) continue;
    const Vec3 from_anchor = level.positions[i] - graph.anchors[level.anchor[i]];
    const Complex d = TangentFrame(level.normals[i]).coordinates(from_anchor) * std::exp(-level.log_length[i]) *
                      std::conj(directions[i]);
    const double v = d.imag() * two_over_sqrt3;
    offsets[i] = {static_cast<float>(d.real() - 0.5 * v), static_cast<float>(v)};
  }
}

// See sweep() of the orientation field for the blocks.
void sweep(const GraphLevel& level, const std::vector<LatticeStep>& steps, std::vector<LatticeCoordinates>& before,
           std::vector<LatticeCoordinates>& offsets) {
  before = offsets;
  for_each_block(level.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (is_anchored(level, i)) continue;
      LatticeCoordinates mean = offsets[i];
      float weight = 0;
      for (std::uint32_t e = level.first[i]; e < level.first[i + 1]; ++e) {
        const std::uint32_t j = level.neighbours[e];
        const LatticeStep& step = steps[e];
        const LatticeCoordinates& other = j >= first && j < last ? offsets[j] : before[j];
        const LatticeCoordinates predicted = turned(other, step.turns);
        const LatticeCoordinates change =
            wrapped({predicted[0] + step.shift[0] - mean[0], predicted[1] + step.shift[1] - mean[1]});
        weight += level.weights[e];
        const float share = level.weights[e] / weight;
        mean[0] += share * change[0];
        mean[1] += share * change[1];
      }
      offsets[i] = wrapped(mean);
    }
  });
}

std::vector<std::uint16_t> residuals_of(const GraphLevel& level, const std::vector<LatticeStep>& steps,
                                        const std::vector<LatticeCoordinates>& offsets) {
  std::vector<std::uint16_t> residuals(steps.size(), no_shared_point);
  for_each_block(level.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      for (std::uint32_t e = level.first[i]; e < level.first[i + 1]; ++e) {
        const std::uint32_t j = level.neighbours[e];
        if (j > i) continue;
        const LatticeCoordinates predicted = carried(steps[e], offsets[j]);
        const LatticeCoordinates change{predicted[0] - offsets[i][0], predicted[1] - offsets[i][1]};
        const LatticeCoordinates image = nearest_lattice_point(change);
        if (image[0] == 0 && image[1] == 0)
          residuals[e] = static_cast<std::uint16_t>(
              std::min<float>(no_shared_point - 1, std::sqrt(squared_length(change)) * no_shared_point));
      }
  });
  return residuals;
}

// A level's directions as means of the finer level's, so that all levels describe the same lattice.
std::vector<Complex> restricted_directions(const GraphLevel& fine, const std::vector<Complex>& directions,
                                           const GraphLevel& coarse) {
  std::vector<Complex> sums(coarse.size());
  for (std::size_t i = 0; i < fine.size(); ++i) {
    const std::uint32_t p = fine.parent[i];
    Complex z = directions[i] * transport(TangentFrame(fine.normals[i]), TangentFrame(coarse.normals[p]));
    z *= z;
    sums[p] += fine.areas[i] * z * z * z;
  }
  for (Complex& z : sums) z = std::polar(1.0, std::arg(z) / 6);
  return sums;
}

}  // namespace

LatticeStep lattice_step(const LatticeNode& from, const LatticeNode& to) {
  const Complex scaled_carry = scaled_transport(from.frame, to.frame);
  const Complex carry = unit(scaled_carry);
  // The direction of `from` in `to`'s frame relative to that of `to`: a multiple of 60° and a remainder of at most 30°.
  const Complex relative = from.direction * carry * std::conj(to.direction);
  const auto [turns, remainder] = sixth_turn(relative);
  Complex half = Complex(1 + remainder.real(), remainder.imag());  // bisects 1 and the remainder
  half *= 1 / length(half);

  const Vec3 step = to.position - from.position;
  Complex d = to.frame.coordinates(step) + from.frame.coordinates(step) * carry;
  const double projected = length(d);
  if (!(projected > 0)) return {{0, 0}, turns};
  // The chord, unfolded along the line where the tangent planes meet: longer by 1 / cos(half the angle between them).
  const double unfolding = std::sqrt(2 / std::max(length(scaled_carry), sharpest_fold));
  d *= step.norm() * unfolding / (projected * 0.5 * (from.edge_length + to.edge_length));
  d *= std::conj(to.direction * half);
  const double v = d.imag() * two_over_sqrt3;
  return {{static_cast<float>(d.real() - 0.5 * v), static_cast<float>(v)}, turns};
}

PositionField compute_position_field(const FieldGraph& graph, const OrientationField& orientation,
                                     const PositionOptions& options) {
  std::vector<std::vector<Complex>> directions{orientation.directions};
  for (std::size_t l = 0; l + 1 < graph.levels.size(); ++l)
    directions.push_back(restricted_directions(graph.levels[l], directions[l], graph.levels[l + 1]));

  std::vector<LatticeStep> steps;
  std::vector<LatticeCoordinates> before;
  std::vector<LatticeCoordinates> offsets(graph.levels.back().size(), LatticeCoordinates{0, 0});
  for (std::size_t l = graph.levels.size(); l-- > 0;) {
    const GraphLevel& level = graph.levels[l];
    const bool coarsest = l + 1 == graph.levels.size();
    if (!coarsest) {
      const GraphLevel& coarse = graph.levels[l + 1];
      std::vector<LatticeCoordinates> finer(level.size());
      for_each_block(level.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
          const std::uint32_t p = level.parent[i];
          finer[i] = wrapped(
              carried(lattice_step(node(coarse, directions[l + 1], p), node(level, directions[l], i)), offsets[p]));
        }
      });
      offsets = std::move(finer);
    }
    set_anchored(graph, level, directions[l], offsets);
    steps = edge_steps(level, directions[l]);
    const int sweeps = coarsest ? 5 * options.sweeps : options.sweeps;
    for (int s = 0; s < sweeps; ++s) sweep(level, steps, before, offsets);
  }
  std::vector<std::uint16_t> residuals = residuals_of(graph.levels.front(), steps, offsets);
  return {std::move(offsets), std::move(residuals)};
}

}  // namespace scan2fea
