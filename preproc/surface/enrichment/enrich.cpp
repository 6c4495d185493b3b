#include "preproc/surface/enrichment/enrich.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/enrichment/clear_surface.hpp"
#include "preproc/surface/enrichment/curved_volume.hpp"
#include "preproc/surface/enrichment/cut_creases.hpp"
#include "preproc/surface/enrichment/insertion.hpp"
#include "preproc/surface/enrichment/triharmonic_lift.hpp"
#include "preproc/surface/enrichment/unfold.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"
#include "preproc/surface/primitives/point_normals.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
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
  if (!(options.separation > 0 && options.separation < options.placement_distance && options.placement_distance <= 1))
    refuse("distance of new points out of range", options.placement_distance,
           "above the separation, which is above 0, and at most 1");
}

Primitives primitives_of(const SurfaceMesh& mesh, const EnrichOptions& options, const Progress& progress) {
  if (options.primitives) return find_primitives(mesh, {}, progress);
  // The noise is asked for all the same.
  constexpr std::size_t neighbours_per_point = 20;
  const PointNormals points =
      own_side_normals(mesh.vertices, nearest_on_surface(mesh, neighbours_per_point), vertex_normals(mesh));
  Primitives none;
  none.noise = points.noise;
  none.spacing = points.spacing;
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
      if (mesh.points[v] != targets[v] && !clear.move_without_fold(v, targets[v]) && sweep + 1 == sweeps)
        clear.move_without_fold(v, 0.5 * (mesh.points[v] + targets[v]));
}

void lift_the_rest(const HalfedgeMesh& scan, HalfedgeMesh& mesh, ClearSurface& clear, const SurfaceLabels& labels,
                   const Insertion& inserted, const Primitives& found) {
  const auto original = static_cast<Index>(scan.vertex_slots());
  std::vector<bool> free(mesh.vertex_slots(), false), measured(mesh.vertex_slots(), false);
  for (Index v = 0; v < mesh.vertex_slots(); ++v) {
    if (labels.of(v).size() > 0 || (v >= inserted.first && inserted.in_gap[v - inserted.first])) continue;
    (v < original ? measured : free)[v] = true;
  }
  // Solved all at once, then gone to one by one, as far as nothing meets.
  const std::vector<Vec3> before = mesh.points;
  triharmonic_lift(mesh, free, measured, {.hold = hold_against(found), .solves = 2, .creases = inserted.on_crease});
  std::vector<Vec3> targets = std::exchange(mesh.points, before);
  move_all(mesh, clear, targets);
  // On parts the few without a primitive lie between some, and creases fare no better for it.
  if (!found.list.empty()) return;
  // Where measured points stay the new ones have it all.
  if (hold_against(found) > 0)
    for (Index v = 0; v < original; ++v) free[v] = measured[v];
  for (Index v = 0; v < mesh.vertex_slots(); ++v) free[v] = free[v] && !inserted.on_crease[v];
  move_all(mesh, clear, with_curved_volume(mesh, free, curved_volume(scan)));
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

// Numbered as in `to_surface`, which drops vertices without faces.
std::vector<FeatureEdge> creases_of(const HalfedgeMesh& mesh, const SurfaceLabels& labels) {
  std::vector<Index> number(mesh.vertex_slots(), 0);
  for (Index v = 0, alive = 0; v < mesh.vertex_slots(); ++v)
    if (mesh.is_alive(v)) number[v] = alive++;
  std::vector<FeatureEdge> edges;
  for (Index h = 0; h < 3 * mesh.face_slots(); ++h)
    if (mesh.is_face_alive(HalfedgeMesh::face(h)) && !mesh.is_border(h) && h < mesh.opposite(h) && labels.is_crease(h))
      edges.push_back(feature_edge(number[mesh.origin(h)], number[mesh.target(h)]));
  std::sort(edges.begin(), edges.end());
  return edges;
}

// Takes away chains that end freely and are short: where a part's crease ends, it ends at others, or runs out in a
// rounding. `shortest` in model units.
void drop_spurs(const std::vector<Vec3>& points, double shortest, std::vector<FeatureEdge>& edges) {
  std::vector<std::vector<std::size_t>> at(points.size());
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (const Index v : edges[e]) at[v].push_back(e);
  std::vector<bool> dropped(edges.size(), false);
  const auto degree = [&](Index v) {
    return std::count_if(at[v].begin(), at[v].end(), [&](std::size_t e) { return !dropped[e]; });
  };
  for (bool any = true; any;) {
    any = false;
    for (Index start = 0; start < points.size(); ++start) {
      if (at[start].empty() || degree(start) != 1) continue;
      std::vector<std::size_t> chain;
      double length = 0;
      for (Index v = start; length < shortest;) {
        const auto next = std::find_if(at[v].begin(), at[v].end(), [&](std::size_t e) {
          return !dropped[e] && (chain.empty() || e != chain.back());
        });
        if (next == at[v].end()) break;
        chain.push_back(*next);
        length += (points[edges[*next][0]] - points[edges[*next][1]]).norm();
        v = edges[*next][0] == v ? edges[*next][1] : edges[*next][0];
        if (degree(v) != 2) break;
      }
      if (length >= shortest) continue;
      for (const std::size_t e : chain) dropped[e] = any = true;
    }
  }
  std::vector<FeatureEdge> kept;
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (!dropped[e]) kept.push_back(edges[e]);
  edges = std::move(kept);
}

// Nothing, and the mesh as it was, where what came out can't be a finer surface of the same body.
std::optional<EnrichResult> enriched(SurfaceMesh& mesh, const EnrichOptions& options, const Progress& progress) {
  const Primitives found = primitives_of(mesh, options, progress);
  HalfedgeMesh surface(mesh);
  SurfaceLabels labels(surface, found);
  ClearSurface clear(surface, std::max(mean_edge_length(mesh), 1e-300));
  const HalfedgeMesh scan = surface;
  const auto original = static_cast<Index>(scan.vertex_slots());
  std::vector<Vec3> bases = scan.points;
  const CreaseCutResult cut = cut_creases(surface, labels, clear);
  unfold(surface, labels, clear);
  bases.insert(bases.end(), cut.bases.begin(), cut.bases.end());
  const Insertion inserted = insert_points(surface, labels, clear, original, options, progress);
  bases.insert(bases.end(), inserted.bases.begin(), inserted.bases.end());
  EnrichResult result = inserted.result;
  result.added += cut.bases.size();
  if (result.added == 0) return result;
  progress("enrich", 0.8);
  if (options.lifting == Lifting::triharmonic) lift_the_rest(scan, surface, clear, labels, inserted, found);
  unfold(surface, labels, clear);
  // Sharp edges that are put back add more than parabolas have.
  if (options.lifting == Lifting::triharmonic && found.list.empty() && !may_be_finer(surface, scan)) return {};
  count_moves(surface, bases, original, result);
  result.creases = creases_of(surface, labels);
  result.primitives = found.list;
  mesh = surface.to_surface();
  drop_spurs(mesh.vertices, 0.04 * bounding_box(mesh.vertices).diagonal(), result.creases);
  return result;
}

}  // namespace

EnrichOptions EnrichOptions::literal() {
  EnrichOptions options;
  options.primitives = false;
  options.lifting = Lifting::shepard;
  options.place_by = StarObjective::a_entropy;
  options.placement_distance = 1;
  options.separation = 0.05;
  return options;
}

EnrichResult enrich(SurfaceMesh& mesh, const EnrichOptions& options, const Progress& progress) {
  check(options);
  return enriched(mesh, options, progress).value_or(EnrichResult{.gave_up = true});
}

}  // namespace scan2fea
