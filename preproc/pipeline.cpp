#include "preproc/pipeline.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/surface/kernel/canonical_frame.hpp"
#include "preproc/surface/repair/solid_volume.hpp"
#include "preproc/surface/simplification/voxel_options.hpp"
#include "preproc/tetrahedra_search.hpp"
#include "preproc/volume/mid_edge_nodes.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <sys/resource.h>

namespace scan2fea {
namespace {

// Linux keeps a high-water mark of resident memory that can be set back, which gives each stage its own peak.
void restart_peak_memory() {
  std::ofstream("/proc/self/clear_refs") << 5;
}

std::uint64_t peak_memory_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    unsigned long long kilobytes = 0;
    if (std::sscanf(line.c_str(), "VmHWM: %llu kB", &kilobytes) == 1) return kilobytes * 1024;
  }
  return 0;
}

// Times stages and hands their records on.
class StageLog {
 public:
  StageLog(std::vector<StageRecord>& records, const StageListener& listener) : records_(records), listener_(listener) {}

  template <class Work>
  void run(const std::string& name, Work work) {
    restart_peak_memory();
    const auto start = std::chrono::steady_clock::now();
    StageRecord record;
    record.name = name;
    work(record);
    record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    record.peak_bytes = peak_memory_bytes();
    records_.push_back(record);
    if (listener_) listener_(records_.back());
  }

 private:
  std::vector<StageRecord>& records_;
  const StageListener& listener_;
};

std::string rounded(double value) {
  return error_text(value, 4);
}

void describe(const ReconstructResult& result, StageRecord& record) {
  record.changes = {{"points_kept", static_cast<double>(result.kept)},
                    {"points_repeated", static_cast<double>(result.repeated)},
                    {"points_thinned", static_cast<double>(result.thinned)},
                    {"points_merged", static_cast<double>(result.merged)},
                    {"outliers", static_cast<double>(result.outliers.size())},
                    {"points_off_surface", static_cast<double>(result.off_surface)},
                    {"faces_made", static_cast<double>(result.surface.triangles.size())},
                    {"gaps_closed", static_cast<double>(result.gaps)},
                    {"made_up_area", result.made_up_area},
                    {"bridges", static_cast<double>(result.bridges.size())},
                    {"noise", result.noise},
                    {"spacing", result.spacing},
                    {"largest_distance_of_points", result.distances.largest},
                    {"rms_distance_of_points", result.distances.rms}};
  record.remarks.push_back(result.choice);
  if (result.thinned > 0)
    record.remarks.push_back("of the points one in each cell of " + rounded(result.cell) + " was taken");
  if (result.distances.largest > 0)
    record.remarks.push_back("the given points but outliers lie within " + rounded(result.distances.largest) +
                             " of the surface, the farthest at " + error_text(result.distances.farthest));
  if (!result.outliers.empty())
    record.remarks.push_back(std::to_string(result.outliers.size()) + " outliers were left out, the first at " +
                             error_text(result.outliers.front()));
  for (const Bridge& bridge : result.bridges)
    record.remarks.push_back("at " + error_text(bridge.place) + " the surface spans " + rounded(bridge.length) +
                             " between points " + rounded(bridge.spacing) +
                             " apart from their own: a gap, or a hole that was bridged");
}

// Of all changes of one kind.
struct ChangeGroup {
  std::size_t count = 0;
  double area = 0, volume = 0;
  const RepairChange* largest = nullptr;
};

std::string describe(RepairKind kind, const ChangeGroup& group) {
  std::string text(name(kind));
  if (group.count > 1) text += ": " + std::to_string(group.count) + ", the largest";
  text += " at " + error_text(group.largest->place);
  if (group.largest->size > 0) text += ", size " + rounded(group.largest->size);
  if (group.area > 0) text += "; area " + rounded(group.area) + (group.count > 1 ? " together" : "");
  if (group.volume > 0) text += ", volume " + rounded(group.volume);
  return text;
}

// What is lost and made up first, since a person must know of it.
void describe(const RepairResult& result, StageRecord& record) {
  std::map<RepairKind, ChangeGroup> groups;
  double lost_area = 0, lost_volume = 0, made_up_area = 0;
  for (const RepairChange& change : result.changes) {
    ChangeGroup& group = groups[change.kind];
    ++group.count;
    group.area += change.area;
    group.volume += change.volume;
    if (!group.largest || change.size > group.largest->size) group.largest = &change;
    if (is_lost(change.kind)) lost_area += change.area, lost_volume += change.volume;
    if (is_made_up(change.kind)) made_up_area += change.area;
  }
  for (const auto& [kind, group] : groups)
    record.changes.emplace_back(std::string(scan2fea::name(kind)), static_cast<double>(group.count));
  if (result.intersecting_pairs > 0)
    record.changes.emplace_back("intersecting_pairs_before", static_cast<double>(result.intersecting_pairs));
  record.changes.emplace_back("faces_removed", static_cast<double>(result.faces_removed));
  record.changes.emplace_back("faces_added", static_cast<double>(result.faces_added));
  record.changes.emplace_back("lost_area", lost_area);
  record.changes.emplace_back("lost_volume", lost_volume);
  record.changes.emplace_back("made_up_area", made_up_area);
  record.changes.emplace_back("bodies", static_cast<double>(result.bodies));
  if (result.bodies > 1)
    record.remarks.push_back(std::to_string(result.bodies) +
                             " bodies that are not joined: a solver finds the system singular unless each is held");
  for (const bool wanted : {true, false})
    for (const auto& [kind, group] : groups)
      // A dropped vertex changes no surface.
      if (kind != RepairKind::UnusedVertex && (is_lost(kind) || is_made_up(kind)) == wanted)
        record.remarks.push_back(describe(kind, group));
}

void describe(const EnrichResult& result, StageRecord& record) {
  record.changes = {{"sampling_radius", result.sampling_radius},
                    {"vertices_added", static_cast<double>(result.added)},
                    {"primitives", static_cast<double>(result.primitives.size())},
                    {"crease_edges", static_cast<double>(result.creases.size())},
                    {"on_primitives", static_cast<double>(result.on_primitives)},
                    {"not_lifted", static_cast<double>(result.not_lifted)},
                    {"domain_vertices", static_cast<double>(result.domain_vertices)},
                    {"content", static_cast<double>(result.content)},
                    {"largest_height", result.largest_height},
                    {"largest_correction", result.largest_correction}};
}

// What an engineer looks for in a part: round things, since faces are many and told by the eye.
void describe_primitives(const std::vector<Primitive>& primitives, StageRecord& record) {
  for (const Primitive& primitive : primitives)
    if (primitive.use != PrimitiveUse::face) record.remarks.push_back(describe(primitive));
}

// Of what is made in another frame, places and lengths in the scan's.
class InScan {
 public:
  explicit InScan(const std::optional<CanonicalFrame>& frame) : frame_(frame) {}
  Vec3 place(const Vec3& p) const { return frame_ ? frame_->place_of(p) : p; }
  double unit() const { return frame_ ? frame_->unit() : 1; }

 private:
  const std::optional<CanonicalFrame>& frame_;
};

// What became of the sharp edges of the scan. Gates may name the figures, so that they are there even where all are 0.
void describe_features(const SimplifyResult& result, const InScan& in_scan, StageRecord& record) {
  std::size_t unsupported = 0;
  for (const UnsupportedCreases& dropped : result.unsupported_creases) unsupported += dropped.edges;
  record.changes.emplace_back("feature_edges_before", static_cast<double>(result.feature_edges));
  record.changes.emplace_back("feature_edges_unsupported", static_cast<double>(unsupported));
  record.changes.emplace_back("feature_edges_too_fine", static_cast<double>(result.feature_edges_too_fine));
  record.changes.emplace_back("feature_edges_after", static_cast<double>(result.feature_edges_kept));
  for (const UnsupportedCreases& dropped : result.unsupported_creases)
    record.remarks.push_back(std::to_string(dropped.edges) + " sharp edges in " + std::to_string(dropped.networks) +
                             (dropped.networks == 1 ? " place, " : " places, the longest ") + "at " +
                             error_text(in_scan.place(dropped.place)) +
                             ", are not kept as creases: " + describe(dropped.fault));
  if (result.feature_edges_too_fine > 0)
    record.remarks.push_back(
        std::to_string(result.feature_edges_too_fine) +
        " edges of creases are too short, or their faces too small, for triangles of the wanted size");
  if (!result.feature_remark.empty()) record.remarks.push_back(result.feature_remark);
}

void describe(const SimplifyResult& result, const InScan& in_scan, StageRecord& record) {
  record.changes = {{"faces_before", static_cast<double>(result.faces_before)},
                    {"faces_after", static_cast<double>(result.faces_after)},
                    {"crossings_mended", static_cast<double>(result.crossings_mended)}};
  describe_features(result, in_scan, record);
  if (!result.size_remark.empty()) record.remarks.push_back(result.size_remark);
  if (result.largest_deviation > 0)
    record.changes.emplace_back("largest_deviation", in_scan.unit() * result.largest_deviation);
  if (result.largest_deviation > result.aimed_deviation)
    record.remarks.push_back("the deviation is " + rounded(in_scan.unit() * result.largest_deviation) + ", not " +
                             rounded(in_scan.unit() * result.aimed_deviation) +
                             " as aimed at; smaller triangles (--faces, --edge-length) come nearer");
  if (result.method == SimplifyMethod::collapse && result.fallback_reason.empty())
    record.remarks.emplace_back("made by --method collapse, which --objective and --cost ask for");
  if (!result.fallback_reason.empty())
    record.remarks.push_back("the lattice gave way to collapse: " + result.fallback_reason);
}

// Beside what came out, the best that the surface allows, and where it is set.
void describe(const TetrahedralizeResult& result, const InScan& in_scan, StageRecord& record) {
  record.changes = {{"tetrahedra", static_cast<double>(result.mesh.tetrahedra.size())},
                    {"tetrahedra_estimated", static_cast<double>(result.estimated_tetrahedra)},
                    {"nodes", static_cast<double>(result.mesh.nodes.size())},
                    {"surface_allows_min_dihedral_deg", result.bound.min_dihedral_deg},
                    {"surface_allows_scaled_jacobian", result.bound.scaled_jacobian}};
  record.remarks.clear();
  if (const auto& at = result.bound.min_dihedral_at)
    record.remarks.push_back("the surface bounds the dihedral angle at " + error_text(in_scan.place(*at)));
  if (const auto& at = result.bound.scaled_jacobian_at)
    record.remarks.push_back("the surface bounds the scaled Jacobian at " + error_text(in_scan.place(*at)));
}

// What was gained, and the same figures of the mesh that stands now as of the first.
void describe(const RenewalResult& renewal, const InScan& in_scan, StageRecord& record) {
  const FilledSurface& made = renewal.made;
  if (renewal.gained()) describe(made.filled, in_scan, record);
  record.changes.insert(record.changes.begin(), {{"surfaces_made", static_cast<double>(renewal.rounds)},
                                                 {"min_dihedral_before_deg", renewal.min_dihedral_before_deg},
                                                 {"min_dihedral_after_deg", renewal.min_dihedral_after_deg},
                                                 {"faces_after", static_cast<double>(made.surface.triangles.size())}});
  if (made.simplified.largest_deviation > 0)
    record.changes.emplace_back("largest_deviation", in_scan.unit() * made.simplified.largest_deviation);
}

// Between two sides whose triangles are as wide as half of the wall there are nodes everywhere only if those inside are
// about as near to one another.
void need_nodes_in_walls(TetrahedralizeOptions& options) {
  constexpr double of_surface = 1.3;
  if (options.interior_size.unit == InteriorSize::Unit::of_surface)
    options.interior_size.value = std::min(options.interior_size.value, of_surface);
}

// Where a mesh is no use to any solver there is none; but who asks for the paper's collapse gets its needles, too, and
// is told.
std::vector<WeakPlace> checked_for_solvers(const SurfaceMesh& surface, const TetMesh* volume_mesh,
                                           const SurfaceMesh& scan, const PipelineOptions& options) {
  std::vector<WeakPlace> places = find_weak_places(surface, volume_mesh, scan);
  const bool is_told_only =
      !options.tetrahedralize && options.simplify && options.simplify->method == SimplifyMethod::collapse;
  for (const WeakPlace& place : places)
    if (place.is_unusable && !is_told_only)
      throw NotMeshable({.what = "no solver takes the mesh that came out: " + place.what,
                         .where = {},
                         .value = std::to_string(place.value),
                         .limit = "half a degree",
                         .advice = "smaller triangles (--deviation, --faces), or --feature-angle off",
                         .at = place.at});
  return places;
}

// The middle of what is left.
Progress in_half_of_the_time(const Progress& progress) {
  const Progress::Clock::time_point now = Progress::Clock::now();
  return progress.until(progress.end(), now + (progress.end() - now) / 2);
}

void note_left_out(const Progress& stage, const char* what, StageRecord& record, PipelineResult& result) {
  if (!stage.ran_short()) return;
  result.left_out.emplace_back(what);
  record.remarks.push_back("the time limit left out " + result.left_out.back());
}

// The stages that work on a scan in its own frame, so that the mesh is the same wherever the scan lies. Boxes and balls
// of the user's are no part of it: with them, and where only tetrahedra are made, it stays where it is.
class MeshMaker {
 public:
  MeshMaker(const SurfaceMesh& scan, const std::optional<StairSteps>& stairs, const PipelineOptions& options,
            PipelineResult& result, StageLog& log)
      : scan_(scan),
        options_(options),
        simplification_(options.simplify.value_or(SimplifyOptions{})),
        tetrahedralization_(options.tetrahedralize.value_or(TetrahedralizeOptions{})),
        result_(result),
        log_(log) {
    place();
    adapt(stairs);
  }

  FilledSurface run(const Progress& progress);

 private:
  void place();
  void take_lengths_to_frame();
  void adapt(std::optional<StairSteps> stairs);
  void simplify(const Progress& progress);
  void tetrahedralize(const Progress& progress);
  void bring_back();
  const SurfaceMesh& scan() const { return placed_ ? *placed_ : scan_; }

  const SurfaceMesh& scan_;
  const PipelineOptions& options_;
  SimplifyOptions simplification_;
  TetrahedralizeOptions tetrahedralization_;
  PipelineResult& result_;
  StageLog& log_;
  std::optional<CanonicalFrame> frame_;
  std::optional<SurfaceMesh> placed_;
  std::optional<Simplification> search_;
  std::string voxel_remark_;
  FilledSurface made_;
  InScan in_scan_{frame_};
};

void MeshMaker::place() {
  const SizeLimits& limits = simplification_.limits;
  if (options_.simplify && simplification_.method == SimplifyMethod::lattice && limits.boxes.empty() &&
      limits.balls.empty() && surface_area(scan_) > 0) {
    frame_.emplace(scan_, placed_.emplace());
    if (simplification_.given_features)
      for (Vec3& p : simplification_.given_features->points) p = frame_->to_frame(p);
  }
  take_lengths_to_frame();
}

void MeshMaker::take_lengths_to_frame() {
  const double unit = in_scan_.unit();
  TargetSize& size = simplification_.size;
  if (auto* edge = std::get_if<MeanEdgeLength>(&size)) edge->length /= unit;
  if (auto* bound = std::get_if<LargestDeviation>(&size)) {
    // A bound is in parts of the box that everyone sees; an aim is the same however the scan lies, to the last bit.
    const bool is_aim = bound->unit == LargestDeviation::Unit::of_diagonal && !bound->required;
    size = in_model_units(size, bounding_box((is_aim ? scan() : scan_).vertices));
    if (!is_aim) std::get<LargestDeviation>(size).distance /= unit;
  }
  if (tetrahedralization_.max_volume) *tetrahedralization_.max_volume /= unit * unit * unit;
  InteriorSize& inside = tetrahedralization_.interior_size;
  if (inside.unit == InteriorSize::Unit::model) inside.value /= unit;
}

void MeshMaker::adapt(std::optional<StairSteps> stairs) {
  if (!stairs) return;
  for (double& step : stairs->size) step /= in_scan_.unit();
  voxel_remark_ = adapt_to_voxels(stairs, simplification_);
}

FilledSurface MeshMaker::run(const Progress& progress) {
  try {
    simplify(progress);
    if (options_.tetrahedralize) tetrahedralize(progress);
  } catch (Error& error) {
    ErrorParts parts = error.parts();
    if (parts.at) parts.at = in_scan_.place(*parts.at);
    error.amend(std::move(parts));
    throw;
  }
  bring_back();
  return std::move(made_);
}

void MeshMaker::simplify(const Progress& progress) {
  if (!options_.simplify) {
    made_.surface = scan();
    return;
  }
  log_.run("simplify", [&](StageRecord& record) {
    search_.emplace(scan(), simplification_);
    const Progress in_time = options_.tetrahedralize ? in_half_of_the_time(progress) : progress.until(progress.end());
    made_.simplified = search_->run(made_.surface, in_time);
    describe(made_.simplified, in_scan_, record);
    if (!voxel_remark_.empty()) record.remarks.push_back(voxel_remark_);
    note_left_out(in_time, "better edge lengths and places of the surface", record, result_);
    if (simplification_.given_features && simplification_.given_features->segments.empty())
      record.remarks.emplace_back("the file of features has no lines: no edges are kept");
  });
}

void MeshMaker::tetrahedralize(const Progress& progress) {
  if (search_) checked_for_solvers(made_.surface, nullptr, scan(), options_);  // else the mesher fails on it
  if (simplification_.limits.elements_across) need_nodes_in_walls(tetrahedralization_);
  log_.run("tetrahedralize", [&](StageRecord& record) {
    const Progress in_time = progress.until(progress.end());
    made_.filled = scan2fea::tetrahedralize(made_.surface, tetrahedralization_, in_time);
    describe(made_.filled, in_scan_, record);
    note_left_out(in_time, "better tetrahedra", record, result_);
  });
  if (!search_ || !worth_renewing(simplification_, made_)) return;
  log_.run("renewal", [&](StageRecord& record) {
    const Progress in_time = progress.until(progress.end());
    RenewalResult renewal = renew_where_poor(*search_, simplification_, tetrahedralization_, std::move(made_), in_time);
    describe(renewal, in_scan_, record);
    note_left_out(in_time, "renewal of the surface around poor tetrahedra", record, result_);
    made_ = std::move(renewal.made);
  });
}

void MeshMaker::bring_back() {
  if (!frame_) return;
  frame_->bring_back(made_.surface.vertices, scan_);
  frame_->bring_back(made_.filled.mesh.nodes, scan_);
  frame_->bring_back(made_.simplified.features.points, scan_);
  made_.simplified.largest_deviation *= frame_->unit();
  made_.simplified.aimed_deviation *= frame_->unit();
}

}  // namespace

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

void run_stages(SurfaceMesh scan, const PipelineOptions& options, const Progress& progress, StageLog& log,
                PipelineResult& result) {
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
  SurfaceMesh enriched;  // scans are large: none is copied that the next stage reads only
  if (options.enrich)
    log.run("enrich", [&](StageRecord& record) {
      enriched = result.scan;
      EnrichResult made = enrich(enriched, *options.enrich, progress);
      describe(made, record);
      describe_primitives(made.primitives, record);
      result.primitives = std::move(made.primitives);
      if (!options.simplify) result.measured_vertices = enriched.vertices.size() - made.added;
      hand_on_creases(enriched, made.creases, chain.simplify);
    });
  FilledSurface made = MeshMaker(options.enrich ? enriched : result.scan, stairs, chain, result, log).run(progress);
  if (options.simplify || options.tetrahedralize)
    result.weak_places = checked_for_solvers(made.surface, options.tetrahedralize ? &made.filled.mesh : nullptr,
                                             result.reference(), options);
  result.surface = std::move(made.surface);
  result.features = std::move(made.simplified.features);
  if (options.tetrahedralize) {
    result.volume_mesh = std::move(made.filled.mesh);
    if (options.order == 2)
      log.run("second order", [&](StageRecord& record) {
        const std::size_t corners = result.volume_mesh->nodes.size();
        add_mid_edge_nodes(*result.volume_mesh);
        const CurveResult curved = curve_mid_edge_nodes(*result.volume_mesh, TriangleTree(result.scan));
        record.changes = {{"nodes_added", static_cast<double>(result.volume_mesh->nodes.size() - corners)},
                          {"curved_edges", static_cast<double>(curved.curved)},
                          {"straight_edges_too_far", static_cast<double>(curved.too_far)},
                          {"straight_edges_for_validity", static_cast<double>(curved.invalid)},
                          {"least_jacobian_of_straight", curved.least_jacobian},
                          {"curved_volume", curved.volume}};
      });
  }
}

}  // namespace

PipelineResult run_pipeline(SurfaceMesh scan, const PipelineOptions& options, const Progress& progress,
                            const StageListener& listener) {
  PipelineResult result;
  StageLog log(result.stages, listener);
  run_stages(std::move(scan), options, progress, log, result);
  return result;
}

PipelineResult run_pipeline(const PointCloud& cloud, const PipelineOptions& options, const Progress& progress,
                            const StageListener& listener) {
  PipelineResult result;
  StageLog log(result.stages, listener);
  SurfaceMesh scan;
  log.run("reconstruct", [&](StageRecord& record) {
    ReconstructResult reconstructed = reconstruct(cloud, options.reconstruct, progress);
    describe(reconstructed, record);
    scan = std::move(reconstructed.surface);
    result.outliers = std::move(reconstructed.outliers);
  });
  run_stages(std::move(scan), options, progress, log, result);
  return result;
}

}  // namespace scan2fea
