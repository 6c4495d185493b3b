#include "preproc/surface/position_field.hpp"

#include "preproc/surface/parallel_blocks.hpp"

#include <cmath>

namespace scan2fea {
namespace {

constexpr double two_over_sqrt3 = 1.1547005383792515;

// Per edge, the step from the neighbour to the node; 12 bytes, since sweeps read all of them.
struct EdgeStep {
  LatticeCoordinates shift;
  float weight;
  std::int32_t turns;
};

LatticeNode node(const GraphLevel& level, const std::vector<Complex>& directions, std::size_t i) {
  return {level.positions[i], level.normals[i], directions[i], std::exp(level.log_length[i])};
}

std::vector<EdgeStep> edge_steps(const GraphLevel& level, const std::vector<Complex>& directions) {
  std::vector<EdgeStep> steps(level.neighbours.size());
  std::vector<double> lengths(level.size());
  for_each_block(level.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) lengths[i] = std::exp(level.log_length[i]);
  });
  for_each_block(level.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const LatticeNode here(level.positions[i], level.normals[i], directions[i], lengths[i]);
      for (std::uint32_t e = level.first[i]; e < level.first[i + 1]; ++e) {
        const std::uint32_t j = level.neighbours[e];
        const LatticeStep step = lattice_step({level.positions[j], level.normals[j], directions[j], lengths[j]}, here);
        steps[e] = {step.shift, level.weights[e], step.turns};
      }
    }
  });
  return steps;
}

LatticeCoordinates wrapped(const LatticeCoordinates& p) {
  const LatticeCoordinates q = nearest_lattice_point(p);
  return {p[0] - q[0], p[1] - q[1]};
}

// See sweep() of the orientation field for the blocks.
void sweep(const GraphLevel& level, const std::vector<EdgeStep>& steps, std::vector<LatticeCoordinates>& offsets) {
  const std::vector<LatticeCoordinates> before = offsets;
  for_each_block(level.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      LatticeCoordinates mean = offsets[i];
      float weight = 0;
      for (std::uint32_t e = level.first[i]; e < level.first[i + 1]; ++e) {
        const std::uint32_t j = level.neighbours[e];
        const EdgeStep& step = steps[e];
        const LatticeCoordinates& other = j >= first && j < last ? offsets[j] : before[j];
        const LatticeCoordinates predicted = turned(other, step.turns);
        const LatticeCoordinates change =
            wrapped({predicted[0] + step.shift[0] - mean[0], predicted[1] + step.shift[1] - mean[1]});
        weight += step.weight;
        const float share = step.weight / weight;
        mean[0] += share * change[0];
        mean[1] += share * change[1];
      }
      offsets[i] = wrapped(mean);
    }
  });
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
  const Complex carry = transport(from.frame, to.frame);
  // The direction of `from` in `to`'s frame relative to that of `to`: a multiple of 60° and a remainder of at most 30°.
  const Complex relative = from.direction * carry * std::conj(to.direction);
  static const std::array<Complex, 6> sixths{
      Complex(1, 0),  std::polar(1.0, M_PI / 3),     std::polar(1.0, 2 * M_PI / 3),
      Complex(-1, 0), std::polar(1.0, 4 * M_PI / 3), std::polar(1.0, 5 * M_PI / 3)};
  int turns = 0;
  {
    const double c = relative.real(), s = relative.imag();
    // Sector tests instead of an arctangent: lines at odd multiples of 30°.
    constexpr double half_sqrt3 = 0.8660254037844386;
    if (std::abs(c) >= half_sqrt3) {
      turns = c > 0 ? 0 : 3;
    } else if (s > 0) {
      turns = c > 0 ? 1 : 2;
    } else {
      turns = c > 0 ? 5 : 4;
    }
  }
  const Complex remainder = relative * std::conj(sixths[static_cast<std::size_t>(turns)]);
  Complex half = Complex(1 + remainder.real(), remainder.imag());  // bisects 1 and the remainder
  half /= std::abs(half);

  const Vec3 step = to.position - from.position;
  Complex d = to.frame.coordinates(step) + from.frame.coordinates(step) * carry;
  const double length = std::abs(d);
  if (!(length > 0)) return {turns, {0, 0}};
  d *= step.norm() / (length * 0.5 * (from.edge_length + to.edge_length));
  d *= std::conj(to.direction * half);
  const double v = d.imag() * two_over_sqrt3;
  return {turns, {static_cast<float>(d.real() - 0.5 * v), static_cast<float>(v)}};
}

LatticeCoordinates nearest_lattice_point(const LatticeCoordinates& p) {
  const float w = -p[0] - p[1];
  float u = std::nearbyint(p[0]), v = std::nearbyint(p[1]);
  const float rw = std::nearbyint(w);
  const float eu = std::abs(u - p[0]), ev = std::abs(v - p[1]), ew = std::abs(rw - w);
  if (eu > ev && eu > ew)
    u = -v - rw;
  else if (ev > ew)
    v = -u - rw;
  return {u, v};
}

PositionField compute_position_field(const FieldGraph& graph, const OrientationField& orientation,
                                     const PositionOptions& options) {
  std::vector<std::vector<Complex>> directions{orientation.directions.front()};
  for (std::size_t l = 0; l + 1 < graph.levels.size(); ++l)
    directions.push_back(restricted_directions(graph.levels[l], directions[l], graph.levels[l + 1]));

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
    const std::vector<EdgeStep> steps = edge_steps(level, directions[l]);
    const int sweeps = coarsest ? 5 * options.sweeps : options.sweeps;
    for (int s = 0; s < sweeps; ++s) sweep(level, steps, offsets);
  }
  return {std::move(offsets)};
}

}  // namespace scan2fea
