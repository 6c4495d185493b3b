#include "preproc/surface/lattice/orientation_field.hpp"

#include "preproc/mesh/splitmix64.hpp"
#include "preproc/surface/kernel/parallel_blocks.hpp"

#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

using SmallComplex =
    std::complex<float>;  // two per edge: half the memory traffic of a sweep, and enough for a direction

// Per edge, what e^{6 i theta} of the neighbour is multiplied with to be compared with the node's own.
std::vector<SmallComplex> transports(const GraphLevel& level) {
  const std::vector<Complex> gradient = log_length_gradient(level);
  std::vector<SmallComplex> result(level.neighbours.size());
  for_each_block(level.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const TangentFrame here(level.normals[i]);
      for (std::uint32_t e = level.first[i]; e < level.first[i + 1]; ++e) {
        const std::uint32_t j = level.neighbours[e];
        if (j > i) continue;  // the other end does both
        const TangentFrame there(level.normals[j]);
        const Complex carried = transport(there, here);
        const Vec3 step = level.positions[i] - level.positions[j];
        // grad theta . step = (J grad phi) . step, the mean of both ends, each in its own plane.
        const Complex a = gradient[i], b = gradient[j];
        const Complex s = here.coordinates(step), t = there.coordinates(step);
        const double turn =
            0.5 * (a.real() * s.imag() - a.imag() * s.real() + b.real() * t.imag() - b.imag() * t.real());
        result[e] = SmallComplex(sixth_power(unit(carried * Complex(1, turn))));
        result[level.mate(static_cast<std::uint32_t>(i), e)] = std::conj(result[e]);
      }
    }
  });
  return result;
}

// A starting direction that differs from node to node but not from run to run.
Complex arbitrary_direction(std::size_t node) {
  return std::polar(1.0, static_cast<double>(splitmix64(node) & 0xffffU) * (2 * std::numbers::pi / 65536));
}

Complex guide(const GraphLevel& level, std::size_t node) {
  return level.guide.empty() ? Complex(0) : level.guide[node];
}

// Gauss-Seidel inside fixed blocks, the values of other blocks taken from before the sweep: the same for any number of
// threads, and nearly as fast to converge, since blocks are contiguous in space.
void sweep(const GraphLevel& level, const std::vector<SmallComplex>& carried, std::vector<Complex>& before,
           std::vector<Complex>& z) {
  before = z;
  for_each_block(level.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      Complex sum = guide(level, i);
      for (std::uint32_t e = level.first[i]; e < level.first[i + 1]; ++e) {
        const std::uint32_t j = level.neighbours[e];
        const Complex& other = j >= first && j < last ? z[j] : before[j];
        sum += static_cast<double>(level.weights[e]) * Complex(carried[e]) * other;
      }
      if (std::norm(sum) > 1e-18) z[i] = unit(sum);
    }
  });
}

// The smoothest field of all on the coarsest level, by inverse iteration in effect: sweeps without making each value
// unit (which would freeze singularities where the start has put them), the whole scaled back after each. Guided nodes
// set the scale where there are some: then it is a linear system instead.
void solve_coarsest(const GraphLevel& level, const std::vector<SmallComplex>& carried, int sweeps,
                    std::vector<Complex>& z) {
  for (std::size_t i = 0; i < level.size(); ++i) z[i] = arbitrary_direction(i);
  for (int s = 0; s < sweeps; ++s) {
    double squares = 0;
    for (std::size_t i = 0; i < level.size(); ++i) {
      Complex sum = guide(level, i);
      double weight = std::abs(sum);
      for (std::uint32_t e = level.first[i]; e < level.first[i + 1]; ++e) {
        const double w = static_cast<double>(level.weights[e]);
        weight += w;
        sum += w * Complex(carried[e]) * z[level.neighbours[e]];
      }
      if (weight > 0) z[i] = sum / weight;
      squares += std::norm(z[i]);
    }
    const double scale = std::sqrt(static_cast<double>(level.size()) / squares);
    if (level.guide.empty() && std::isfinite(scale))
      for (Complex& value : z) value *= scale;
  }
  for (Complex& value : z) value = unit(value);
}

}  // namespace

std::vector<Complex> log_length_gradient(const GraphLevel& level) {
  std::vector<Complex> gradient(level.size());
  for_each_block(level.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      gradient[i] = gradient_at(level, i, TangentFrame(level.normals[i]),
                                [&](std::uint32_t j) { return level.log_length[j] - level.log_length[i]; });
    }
  });
  return gradient;
}

OrientationField compute_orientation_field(const FieldGraph& graph, const OrientationOptions& options) {
  std::vector<Complex> above, z, before;  // e^{6 i theta} of the coarser level and of this one
  for (std::size_t l = graph.levels.size(); l-- > 0;) {
    const GraphLevel& level = graph.levels[l];
    const std::vector<SmallComplex> carried = transports(level);
    z.resize(level.size());
    if (l + 1 == graph.levels.size()) {
      // The coarsest level starts from arbitrary directions, so it needs many sweeps; it has so few nodes that they
      // cost nothing.
      solve_coarsest(level, carried, 20 * options.sweeps, z);
    } else {
      const GraphLevel& coarse = graph.levels[l + 1];
      for_each_block(level.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
          const std::uint32_t p = level.parent[i];
          z[i] = sixth_power(transport(TangentFrame(coarse.normals[p]), TangentFrame(level.normals[i]))) * above[p];
        }
      });
      for (int s = 0; s < options.sweeps; ++s) sweep(level, carried, before, z);
    }
    above.swap(z);
  }
  for_each_block(above.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) above[i] = std::polar(1.0, std::arg(above[i]) / 6);
  });
  return {std::move(above)};
}

}  // namespace scan2fea
