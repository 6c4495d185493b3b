#include "preproc/surface/lattice/scale_relaxation.hpp"

#include "preproc/surface/kernel/parallel_blocks.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

// Piecewise constant prolongation underestimates smooth corrections; this makes up for most of it.
constexpr double coarse_correction = 1.4;
constexpr int smoothing_sweeps = 2;
// How strongly nodes on features are held, against edge weights of about 0.6: the distances between their samples are
// what they are.
constexpr double held_mass = 100;

// Per node, the gradient of theta in the node's frame: its differences along the edges, matched modulo 60°.
std::vector<Complex> turning(const GraphLevel& level, const std::vector<Complex>& directions) {
  std::vector<Complex> gradient(level.size());
  for_each_block(level.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const TangentFrame here(level.normals[i]);
      gradient[i] = gradient_at(level, i, here, [&](std::uint32_t j) {
        const Complex relative =
            directions[j] * transport(TangentFrame(level.normals[j]), here) * std::conj(directions[i]);
        return small_angle(sixth_turn(relative).remainder);
      });
    }
  });
  return gradient;
}

// One level of the linear system sum_j w_ij (x_i - x_j) + m_i x_i = b_i.
struct System {
  const GraphLevel* graph = nullptr;
  std::vector<double> mass;
  std::vector<double> rhs;
  std::vector<double> x;
  std::vector<double> before;
};

// See sweep() of the orientation field for the blocks.
void smooth(System& s) {
  const GraphLevel& g = *s.graph;
  const std::vector<double>& before = s.before = s.x;
  for_each_block(g.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      double sum = s.rhs[i], weight = s.mass[i];
      for (std::uint32_t e = g.first[i]; e < g.first[i + 1]; ++e) {
        const std::uint32_t j = g.neighbours[e];
        const double w = static_cast<double>(g.weights[e]);
        sum += w * (j >= first && j < last ? s.x[j] : before[j]);
        weight += w;
      }
      if (weight > 0) s.x[i] = sum / weight;
    }
  });
}

void cycle(std::vector<System>& systems, std::size_t l) {
  System& s = systems[l];
  const GraphLevel& g = *s.graph;
  const bool coarsest = l + 1 == systems.size();
  for (int k = 0; k < (coarsest ? 20 : smoothing_sweeps); ++k) smooth(s);
  if (coarsest) return;
  System& above = systems[l + 1];
  std::fill(above.x.begin(), above.x.end(), 0.0);
  std::fill(above.rhs.begin(), above.rhs.end(), 0.0);
  for (std::size_t i = 0; i < g.size(); ++i) {
    double residual = s.rhs[i] - s.mass[i] * s.x[i];
    for (std::uint32_t e = g.first[i]; e < g.first[i + 1]; ++e)
      residual -= static_cast<double>(g.weights[e]) * (s.x[i] - s.x[g.neighbours[e]]);
    above.rhs[g.parent[i]] += residual;
  }
  cycle(systems, l + 1);
  for (std::size_t i = 0; i < g.size(); ++i) s.x[i] += coarse_correction * above.x[g.parent[i]];
  for (int k = 0; k < smoothing_sweeps; ++k) smooth(s);
}

}  // namespace

void relax_scale(FieldGraph& graph, const OrientationField& orientation, const ScaleRelaxationOptions& options) {
  std::vector<System> systems(graph.levels.size());
  for (std::size_t l = 0; l < systems.size(); ++l) {
    System& s = systems[l];
    const GraphLevel& g = graph.levels[l];
    s.graph = &g;
    s.x.assign(g.size(), 0.0);
    s.rhs.assign(g.size(), 0.0);
    s.mass.assign(g.size(), 0.0);
  }
  GraphLevel& finest = graph.levels.front();
  const std::vector<Complex> turn = turning(finest, orientation.directions);
  for_each_block(finest.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const bool held = !finest.anchor.empty() && finest.anchor[i] != no_sample;
      systems[0].mass[i] = held ? held_mass : options.screening * finest.areas[i] * std::exp(-2 * finest.log_length[i]);
      const TangentFrame here(finest.normals[i]);
      for (std::uint32_t e = finest.first[i]; e < finest.first[i + 1]; ++e) {
        const std::uint32_t j = finest.neighbours[e];
        const Vec3 step = finest.positions[i] - finest.positions[j];
        const Complex s = here.coordinates(step), t = TangentFrame(finest.normals[j]).coordinates(step);
        // (theta_y, -theta_x) . step, the mean of both ends
        const double wanted = 0.5 * (turn[i].imag() * s.real() - turn[i].real() * s.imag() + turn[j].imag() * t.real() -
                                     turn[j].real() * t.imag());
        systems[0].rhs[i] +=
            static_cast<double>(finest.weights[e]) * (wanted - (finest.log_length[i] - finest.log_length[j]));
      }
    }
  });
  for (std::size_t l = 0; l + 1 < systems.size(); ++l)
    for (std::size_t i = 0; i < graph.levels[l].size(); ++i)
      systems[l + 1].mass[graph.levels[l].parent[i]] += systems[l].mass[i];
  for (int k = 0; k < options.cycles; ++k) cycle(systems, 0);
  for (std::size_t i = 0; i < finest.size(); ++i)
    finest.log_length[i] += std::clamp(systems[0].x[i], -options.most_change, options.most_change);
  restrict_log_length(graph);
}

}  // namespace scan2fea
