#include "preproc/pipeline.hpp"

#include "preproc/made_up.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh_by_half.hpp"
#include "preproc/mesh_of_scan.hpp"
#include "preproc/named_parts.hpp"
#include "preproc/stage_descriptions.hpp"
#include "preproc/stage_log.hpp"
#include "preproc/surface/repair/solid_volume.hpp"

#include <algorithm>

namespace scan2fea {
namespace {

// Restored creases are exact, and those that would be found beside them are not: they are kept as far as triangles of
// the wanted size can.
void hand_on_creases(const SurfaceMesh& enriched, const std::vector<FeatureEdge>& creases,
                     std::optional<SimplifyOptions>& simplification) {
  if (creases.empty() || !simplification || simplification->given_features || !simplification->features.angle_deg)
    return;
  simplification->given_features = lines_of(enriched, creases);
  simplification->may_drop_given = true;
}

// What the scanner has seen of the repaired scan; nothing where it has seen all of it.
std::vector<FaceOrigin> origins_of_scan(const PipelineResult& result, const SurfaceMesh* seen) {
  const bool is_repaired =
      std::ranges::any_of(result.repaired.changes, [](const RepairChange& change) { return is_made_up(change.kind); });
  if (seen == nullptr && is_repaired) seen = &*result.given;
  return seen == nullptr ? std::vector<FaceOrigin>() : origins_by_place(result.scan, *seen);
}

// Those of second order are fitted and filled anew: what was slid before is lost.
void require_slidable(const PipelineOptions& options) {
  if (!options.slide || (!options.symmetry && options.order == 1)) return;
  throw WrongUsage({.what = "nodes slide on whole parts of first order only",
                    .where = {},
                    .value = options.symmetry ? "--slide with --symmetry" : "--slide with --order 2",
                    .limit = {},
                    .advice = options.symmetry ? "--symmetry off, or no --slide" : "--order 1, or no --slide"});
}

// Nodes that slide would leave their layers.
void require_layerable(const PipelineOptions& options) {
  const auto refuse = [](const char* value, const char* advice) {
    throw WrongUsage(
        {.what = "layers are made of whole parts only", .where = {}, .value = value, .limit = {}, .advice = advice});
  };
  if (options.layers.empty()) return;
  if (options.symmetry) refuse("--layers with --symmetry", "--symmetry off, or no --layers");
  if (options.slide) refuse("--layers with --slide", "one of both");
  if (!options.simplify || !options.tetrahedralize) refuse("--layers without a mesh of a scan", "scan2fea run");
}

// Sets of what was made up, after the user's own.
void add_made_up_sets(const SurfaceMesh& start, const std::vector<FaceOrigin>& of_start, PipelineResult& result) {
  if (of_start.empty()) return;
  for (NamedSet& set : made_up_sets(carried_origins(result.surface, start, of_start)))
    add_set(std::move(set), {}, result);
}

// `seen`: of a cloud, the faces that close no gap.
void run_stages(SurfaceMesh scan, const SurfaceMesh* seen, const PipelineOptions& options, const Progress& progress,
                StageLog& log, PipelineResult& result) {
  require_slidable(options);
  require_layerable(options);
  const auto stairs = options.simplify ? find_stair_steps(scan) : std::nullopt;
  if (options.repair)
    log.run("repair", [&](StageRecord& record) {
      SurfaceMesh given = scan;
      result.repaired = repair(scan, *options.repair, progress);
      if (!result.repaired.unchanged()) result.given = std::move(given);
      if (*options.repair == RepairOptions{}) result.solid_volume = volume_of_solid(scan, result.repaired);
      describe(result.repaired, record);
      if (options.repair->thickness && result.repaired.count(RepairKind::ThickenedSheet) == 0)
        record.remarks.emplace_back("nothing was thickened: no sheet is open");
    });
  result.scan = std::move(scan);
  PipelineOptions chain = options;
  std::vector<FaceOrigin> origins = origins_of_scan(result, seen);
  SurfaceMesh enriched;  // scans are large: none is copied that the next stage reads only
  if (options.enrich)
    log.run("enrich", [&](StageRecord& record) {
      enriched = result.scan;
      EnrichOptions how = *options.enrich;
      if (options.enrich_domain) how.domain = domain_of(result.scan, *options.enrich_domain, options, progress);
      EnrichResult made = enrich(enriched, how, progress);
      describe(made, record);
      result.primitives = std::move(made.primitives);
      const std::size_t measured = enriched.vertices.size() - made.added;
      if (!options.simplify) result.measured_vertices = measured;
      if (made.added > 0) {
        origins = origins.empty() ? std::vector<FaceOrigin>(enriched.triangles.size(), FaceOrigin::measured)
                                  : carried_origins(enriched, result.scan, origins);
        mark_enriched(enriched, measured, origins);
      }
      hand_on_creases(enriched, made.creases, chain.simplify);
    });
  std::optional<SelectedScan> selected;
  if (!options.sets.empty() || !options.given_sets.empty() || options.name_faces || options.idealise)
    log.run("faces", [&](StageRecord& record) {
      selected = select_parts(options.enrich ? enriched : result.scan, result.reference(), options, progress,
                              chain.simplify, record);
    });
  const SurfaceMesh& start = selected ? selected->mesh : options.enrich ? enriched : result.scan;
  const SelectedScan* const of_sets = selected ? &*selected : nullptr;
  require_sets_of_layers(of_sets, options.layers);
  LayersOf layers_of;
  if (!options.layers.empty())
    layers_of = [&](const SurfaceMesh& surface, const std::vector<FeatureEdge>& lines) {
      return layered_triangles(of_sets, options.layers, surface, lines);
    };
  FilledSurface made = options.symmetry ? mesh_by_half(start, stairs, chain, progress, result, log)
                                        : mesh_of_scan(start, stairs, chain, nullptr, layers_of, progress, result, log);
  if (options.simplify || options.tetrahedralize)
    result.weak_places = checked_for_solvers(made.surface, options.tetrahedralize ? &made.filled.mesh : nullptr,
                                             result.reference(), options, made.flat_tetrahedra);
  result.surface = std::move(made.surface);
  result.features = std::move(made.simplified.features);
  result.line_edges = made.simplified.line_edges;
  if (selected) carry_parts(*selected, options, made.simplified, result);
  add_made_up_sets(options.enrich ? enriched : result.scan, origins, result);
  if (options.tetrahedralize) {
    result.volume_mesh = std::move(made.filled.mesh);
    const std::vector<std::uint32_t>& parent = made.filled.boundary_parent;  // where the boundary was split
    result.volume_mesh->face_sets = parent.empty() ? result.face_sets : carried_sets(result.face_sets, parent);
    if (options.order == 2) measure_sets(result);
  }
}

}  // namespace

PipelineResult run_pipeline(SurfaceMesh scan, const PipelineOptions& options, const Progress& progress,
                            const StageListener& listener) {
  PipelineResult result;
  StageLog log(result.stages, listener, progress);
  run_stages(std::move(scan), nullptr, options, progress, log, result);
  return result;
}

PipelineResult run_pipeline(const PointCloud& cloud, const PipelineOptions& options, const Progress& progress,
                            const StageListener& listener) {
  PipelineResult result;
  StageLog log(result.stages, listener, progress);
  SurfaceMesh scan;
  std::optional<SurfaceMesh> seen;
  log.run("reconstruct", [&](StageRecord& record) {
    ReconstructResult reconstructed = reconstruct(cloud, options.reconstruct, progress);
    describe(reconstructed, record);
    scan = std::move(reconstructed.surface);
    if (reconstructed.gaps > 0 && !reconstructed.is_made_up.empty()) {
      seen = SurfaceMesh{scan.vertices, {}};
      for (std::size_t f = 0; f < scan.triangles.size(); ++f)
        if (!reconstructed.is_made_up[f]) seen->triangles.push_back(scan.triangles[f]);
    }
    result.outliers = std::move(reconstructed.outliers);
    result.bridges = std::move(reconstructed.bridges);
  });
  run_stages(std::move(scan), seen ? &*seen : nullptr, options, progress, log, result);
  return result;
}

}  // namespace scan2fea
