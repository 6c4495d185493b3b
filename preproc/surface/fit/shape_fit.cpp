#include "preproc/surface/fit/shape_fit.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/fit/feature_fit.hpp"
#include "preproc/surface/fit/fitter.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace scan2fea {
namespace {

// Until the surface has come to lie about where it will be, vertices on features stay where the curves were sampled.
constexpr int rounds_before_sliding = 2;

void check(const SurfaceMesh& mesh, const ReferenceSurface& scan, const ShapeFitOptions& options) {
  const auto require = [](bool held, const char* what, double value, const char* limit) {
    if (!held)
      throw WrongUsage(
          {.what = what, .where = "shape and fit", .value = std::to_string(value), .limit = limit, .advice = ""});
  };
  require(options.fidelity_of_diagonal > 0 && options.fidelity_of_diagonal < 0.1, "fidelity out of range",
          options.fidelity_of_diagonal, "0 to 0.1 of the diagonal");
  require(options.hold_faces_below >= 0 && options.hold_faces_below <= 1, "size of faces to hold out of range",
          options.hold_faces_below, "0 to 1 of the mean");
  require(options.rounds >= 1, "too few rounds", options.rounds, "at least 1");
  require(options.sweeps >= 1, "too few sweeps", options.sweeps, "at least 1");
  require(!options.lift_tail_of_diagonal || *options.lift_tail_of_diagonal > 0, "tail distance out of range",
          options.lift_tail_of_diagonal.value_or(0), "above 0");
  require(options.constraints.empty() || options.constraints.size() == mesh.vertices.size(),
          "constraints for another number of vertices", static_cast<double>(options.constraints.size()),
          "none, or one a vertex");
  if (mesh.triangles.empty() || scan.mesh.triangles.empty()) {
    throw InvalidInput({.what = "no triangles to fit", .where = "", .value = "", .limit = "", .advice = ""});
  }
}

// Where the RMS distance is below this part of the mean edge, and changes by less than that from one location to the
// next, the samples lie about where they will, and only the shape has something to gain: in so many rounds more, at
// whose end they are located once. Larger triangles, which are farther from the scan, lost 0.002 in the mean edge
// ratio.
constexpr double settled_of_edge = 0.0125, settled_change = 0.005;
constexpr int first_settled_round = 3, rounds_when_settled = 2;
// Longer steps than before, and more of them, as nothing else moves: the same shape after fewer rounds.
constexpr int sweeps_when_settled = 4;
constexpr double over_relaxation_when_settled = 1.75;
// Six rounds then do more than eight without.
constexpr double over_relaxation = 1.5;

// The rounds; after_sweep(round) moves what the sweeps leave alone.
template <class AfterSweep>
ShapeFitResult run_rounds(Fitter& fitter, const ShapeFitOptions& options, const Progress& progress,
                          const AfterSweep& after_sweep) {
  // Before this round the distances are those of the start, not of what the triangles can reach.
  constexpr int first_dialled_round = 2;
  constexpr double loosest = 0.01;  // of the diagonal
  ShapeFitResult result;
  result.fidelity_of_diagonal = options.fidelity_of_diagonal;
  bool is_settled = false;
  int last = options.rounds - 1;
  for (int round = 0; round <= last; ++round) {
    progress("shape and fit", static_cast<double>(round) / options.rounds);
    const int dialled = round - first_dialled_round;
    const bool is_dialled = options.fidelity_of_residual && dialled >= 0 && dialled < options.rounds_of_dialling;
    if (is_dialled)
      result.fidelity_of_diagonal = fitter.set_fidelity_by_residual(*options.fidelity_of_residual, loosest, result);
    if (!is_settled || round == last) {
      const double before = result.rms_distance;
      fitter.locate_samples(result);
      if (!is_settled && !is_dialled && round >= first_settled_round &&
          result.rms_distance < settled_of_edge * fitter.mean_edge() &&
          std::abs(result.rms_distance - before) <= settled_change * before) {
        is_settled = true;
        last = std::min(last, round + rounds_when_settled);
      }
    }
    for (int s = 0; s < (is_settled ? sweeps_when_settled : options.sweeps); ++s) {
      result.largest_step = fitter.sweep(is_settled ? over_relaxation_when_settled : over_relaxation);
      after_sweep(round);
    }
  }
  return result;
}

}  // namespace

ShapeFitResult optimise_shape_and_fit(SurfaceMesh& mesh, const ReferenceSurface& scan, const ShapeFitOptions& options,
                                      const Progress& progress) {
  check(mesh, scan, options);
  Fitter fitter(mesh, scan, options, {});
  return run_rounds(fitter, options, progress, [](int) {});
}

ShapeFitResult optimise_shape_and_fit(SurfaceMesh& mesh, FeatureNet& net, const ReferenceSurface& scan,
                                      const ShapeFitOptions& options, const Progress& progress) {
  if (net.empty()) return optimise_shape_and_fit(mesh, scan, options, progress);
  check(mesh, scan, options);
  CutMesh cut(mesh, net);
  const ShapeFitOptions cut_options = cut.options_for(options, scan);
  Fitter fitter(cut.mesh(), scan, cut_options, cut.patch_of_vertex());
  const ShapeFitResult result = run_rounds(fitter, options, progress, [&](int round) {
    if (round >= rounds_before_sliding) slide_all(fitter, cut, net, options.constraints);
  });
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) mesh.vertices[v] = cut.mesh().vertices[v];
  return result;
}

}  // namespace scan2fea
