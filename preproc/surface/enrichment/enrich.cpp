#include "preproc/surface/enrichment/enrich.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/enrichment/cut_creases.hpp"
#include "preproc/surface/enrichment/insertion.hpp"
#include "preproc/surface/enrichment/triharmonic_lift.hpp"
#include "preproc/surface/enrichment/undo_folds.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <string>

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

void lift_the_rest(HalfedgeMesh& mesh, const SurfaceLabels& labels, Index original, const Primitives& found) {
  std::vector<bool> free(mesh.vertex_slots(), false), measured(mesh.vertex_slots(), false);
  for (Index v = 0; v < mesh.vertex_slots(); ++v) {
    if (labels.of(v).size() > 0) continue;
    (v < original ? measured : free)[v] = true;
  }
  triharmonic_lift(mesh, free, measured, {.hold = hold_against(found)});
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
  const CreaseCutResult cut = cut_creases(surface, labels);
  bases.insert(bases.end(), cut.bases.begin(), cut.bases.end());
  Insertion inserted = insert_points(surface, labels, original, options, progress);
  bases.insert(bases.end(), inserted.bases.begin(), inserted.bases.end());
  EnrichResult result = std::move(inserted.result);
  result.added += cut.bases.size();
  if (result.added == 0) return result;
  progress("enrich", 0.8);
  if (options.lifting == Lifting::triharmonic) lift_the_rest(surface, labels, original, found);
  result.not_lifted += undo_folds(surface, labels, bases);
  count_moves(surface, bases, original, result);
  result.creases = creases_of(surface, labels);
  result.primitives = found.list;
  mesh = surface.to_surface();
  return result;
}

}  // namespace scan2fea
