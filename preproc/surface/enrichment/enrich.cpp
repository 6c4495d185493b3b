#include "preproc/surface/enrichment/enrich.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/enrichment/clear_surface.hpp"
#include "preproc/surface/enrichment/cut_creases.hpp"
#include "preproc/surface/enrichment/insertion.hpp"
#include "preproc/surface/enrichment/triharmonic_lift.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

void check(const EnrichOptions& options) {
  const auto refuse = [](const char* what, double value, const char* limit) {
    throw WrongUsage({.what = what, .where = {}, .value = std::to_string(value), .limit = limit, .advice = {}});
  };
  if (options.sampling_radius && !(*options.sampling_radius > 0 && std::isfinite(*options.sampling_radius)))
    refuse("sampling radius is not positive", *options.sampling_radius, "> 0");
  if (options.most_neighbours < 3 || options.most_neighbours > 20)
    refuse("number of neighbours out of range", static_cast<double>(options.most_neighbours), "3 to 20");
  if (!(options.empty_sector_deg >= 60 && options.empty_sector_deg <= 180))
    refuse("empty sector out of range", options.empty_sector_deg, "60 to 180 degrees");
}

Primitives primitives_of(const SurfaceMesh& mesh, const EnrichOptions& options, const Progress& progress) {
  if (options.primitives) return find_primitives(mesh, {}, progress);
  Primitives none;
  none.labels.assign(mesh.vertices.size(), no_primitive);
  return none;
}

// Noise of a twentieth of the spacing is held by 5 (triharmonic_lift.hpp), less noise more firmly: its square is what
// the energy of the bends that it makes goes with. Below a fiftieth points stay where they are.
double hold_against(const Primitives& found) {
  constexpr double usual_noise = 0.05, usual_hold = 5, least_noise = 0.02;
  const double noise = found.spacing > 0 ? found.noise / found.spacing : 0;
  return noise > least_noise ? usual_hold * std::pow(usual_noise / noise, 2) : 0;
}

void move_all(HalfedgeMesh& mesh, ClearSurface& clear, const std::vector<Vec3>& targets) {
  constexpr int sweeps = 3;
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (Index v = 0; v < targets.size(); ++v)
      if (mesh.points[v] != targets[v] && !clear.move(v, targets[v]) && sweep + 1 == sweeps)
        clear.move(v, 0.5 * (mesh.points[v] + targets[v]));
}

void lift_the_rest(HalfedgeMesh& mesh, ClearSurface& clear, const SurfaceLabels& labels, Index original,
                   const Insertion& inserted, const Primitives& found) {
  std::vector<bool> free(mesh.vertex_slots(), false), measured(mesh.vertex_slots(), false);
  for (Index v = 0; v < mesh.vertex_slots(); ++v) {
    if (labels.of(v).size() > 0 || (v >= inserted.first && inserted.in_gap[v - inserted.first])) continue;
    (v < original ? measured : free)[v] = true;
  }
  // Solved all at once, then gone to one by one, as far as nothing meets.
  const std::vector<Vec3> before = mesh.points;
  triharmonic_lift(mesh, free, measured, {.hold = hold_against(found), .creases = inserted.on_crease});
  std::vector<Vec3> targets = std::exchange(mesh.points, before);
  move_all(mesh, clear, targets);
}

void count_moves(const HalfedgeMesh& mesh, const std::vector<Vec3>& bases, Index original, EnrichResult& result) {
  for (Index v = 0; v < mesh.vertex_slots(); ++v) {
    const double move = (mesh.points[v] - bases[v]).norm();
    if (v < original)
      result.largest_correction = std::max(result.largest_correction, move);
    else
      result.largest_height = std::max(result.largest_height, move);
  }
}

std::vector<FeatureEdge> creases_of(const HalfedgeMesh& mesh, const SurfaceLabels& labels) {
  std::vector<FeatureEdge> edges;
  for (Index h = 0; h < 3 * mesh.face_slots(); ++h)
    if (mesh.is_face_alive(HalfedgeMesh::face(h)) && !mesh.is_border(h) && h < mesh.opposite(h) && labels.is_crease(h))
      edges.push_back(feature_edge(mesh.origin(h), mesh.target(h)));
  std::sort(edges.begin(), edges.end());
  return edges;
}

}  // namespace

EnrichResult enrich(SurfaceMesh& mesh, const EnrichOptions& options, const Progress& progress) {
  check(options);
  const Primitives found = primitives_of(mesh, options, progress);
  HalfedgeMesh surface(mesh);
  SurfaceLabels labels(surface, found);
  const auto original = static_cast<Index>(surface.vertex_slots());
  std::vector<Vec3> bases = surface.points;
  ClearSurface clear(surface, std::max(mean_edge_length(mesh), 1e-300));
  const CreaseCutResult cut = cut_creases(surface, labels, clear);
  bases.insert(bases.end(), cut.bases.begin(), cut.bases.end());
  const Insertion inserted = insert_points(surface, labels, clear, original, options, progress);
  bases.insert(bases.end(), inserted.bases.begin(), inserted.bases.end());
  EnrichResult result = inserted.result;
  result.added += cut.bases.size();
  if (result.added == 0) return result;
  progress("enrich", 0.8);
  if (options.lifting == Lifting::triharmonic) lift_the_rest(surface, clear, labels, original, inserted, found);
  count_moves(surface, bases, original, result);
  result.creases = creases_of(surface, labels);
  result.primitives = found.list;
  mesh = surface.to_surface();
  return result;
}

}  // namespace scan2fea
