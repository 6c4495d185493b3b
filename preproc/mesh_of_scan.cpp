#include "preproc/mesh_of_scan.hpp"

#include "preproc/add_layers.hpp"
#include "preproc/layers/column_heights.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/mirrored_surface.hpp"
#include "preproc/second_order.hpp"
#include "preproc/slide_boundary.hpp"
#include "preproc/stage_descriptions.hpp"
#include "preproc/surface/curved/fit_curves.hpp"
#include "preproc/surface/fit/preserve_volume.hpp"
#include "preproc/surface/kernel/canonical_frame.hpp"
#include "preproc/surface/simplification/voxel_options.hpp"
#include "preproc/volume/mid_edge_nodes.hpp"
#include "quality/triangle_tree.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <variant>

namespace scan2fea {
namespace {

// Between two sides whose triangles are as wide as half of the wall there are nodes everywhere only if those inside are
// about as near to one another.
void need_nodes_in_walls(TetrahedralizeOptions& options) {
  constexpr double of_surface = 1.3;
  if (options.interior_size.unit == InteriorSize::Unit::of_surface)
    options.interior_size.value = std::min(options.interior_size.value, of_surface);
}

// 0 where no number of triangles is asked for.
double wanted_count(const TargetSize& size, const SurfaceMesh& scan) {
  if (const auto* faces = std::get_if<FaceCount>(&size)) return static_cast<double>(faces->faces);
  if (const auto* ratio = std::get_if<FaceRatio>(&size))
    return ratio->of_input * static_cast<double>(scan.triangles.size());
  return 0;
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
            const Half* half, const LayersOf& layers_of, PipelineResult& result, StageLog& log)
      : scan_(scan),
        options_(options),
        simplification_(options.simplify.value_or(SimplifyOptions{})),
        tetrahedralization_(options.tetrahedralize.value_or(TetrahedralizeOptions{})),
        result_(result),
        log_(log),
        half_(half),
        layers_of_(layers_of),
        in_scan_(frame_, half ? &half->frame : nullptr) {
    simplification_.curved = is_to_be_fitted();
    place();
    adapt(stairs);
  }

  FilledSurface run(const Progress& progress);

 private:
  void place();
  void take_lengths_to_frame();
  void adapt(std::optional<StairSteps> stairs);
  void simplify(const Progress& progress);
  void put_cut_onto_plane();
  void take_fewer_of_default(const Progress& progress);
  void tetrahedralize(const Progress& progress);
  void slide(const Progress& progress);
  void layer(const Progress& progress);
  void refuse_lost_deviation(const std::string& what, const std::string& where, const char* advice) const;
  void curve(const Progress& progress);
  SecondOrderResult fit_until_near(const Progress& progress);
  void curve_surface(const Progress& progress);
  void bring_back();
  const SurfaceMesh& scan() const { return placed_ ? *placed_ : scan_; }
  // Whether curved triangles take the straight ones' place. Layers, which are flat, want small ones.
  bool is_to_be_fitted() const {
    return options_.order == 2 && options_.simplify && simplification_.method == SimplifyMethod::lattice &&
           options_.tetrahedralize && !tetrahedralization_.split_boundary && !layers_of_;
  }

  const SurfaceMesh& scan_;
  const PipelineOptions& options_;
  SimplifyOptions simplification_;
  TetrahedralizeOptions tetrahedralization_;
  PipelineResult& result_;
  StageLog& log_;
  std::optional<CanonicalFrame> frame_;
  std::optional<SurfaceMesh> placed_;
  std::unique_ptr<Simplification> search_;
  std::string voxel_remark_;
  FilledSurface made_;
  const Half* half_;
  const LayersOf& layers_of_;
  InScan in_scan_;
};

void MeshMaker::place() {
  const SizeLimits& limits = simplification_.limits;
  if (options_.simplify && simplification_.method == SimplifyMethod::lattice && limits.boxes.empty() &&
      limits.balls.empty() && surface_area(scan_) > 0) {
    frame_.emplace(scan_, placed_.emplace());
    if (simplification_.given_features)
      for (Vec3& p : simplification_.given_features->points) p = frame_->to_frame(p);
    for (Vec3& p : simplification_.kept_lines.points) p = frame_->to_frame(p);
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
    if (half_ && search_) put_cut_onto_plane();
    if (options_.tetrahedralize) tetrahedralize(progress);
    if (options_.tetrahedralize && options_.slide && search_) slide(progress);
    const bool has_layers = options_.tetrahedralize && layers_of_ && search_;
    if (has_layers) layer(progress);
    if (options_.tetrahedralize && options_.order == 2 && !has_layers) curve(progress);
    if (!options_.tetrahedralize && search_ && options_.order == 2) curve_surface(progress);
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
    search_ = std::make_unique<Simplification>(scan(), simplification_);
    const Progress in_time = options_.tetrahedralize ? in_half_of_the_time(progress) : progress.until(progress.end());
    made_.simplified = search_->run(made_.surface, in_time);
    take_fewer_of_default(in_time);
    describe(made_.simplified, in_scan_, record);
    if (!voxel_remark_.empty()) record.remarks.push_back(voxel_remark_);
    note_left_out(in_time, "better edge lengths and places of the surface", record, result_);
    if (simplification_.given_features && simplification_.given_features->segments.empty())
      record.remarks.emplace_back("the file of features has no lines: no edges are kept");
  });
}

// The cut is to be shared by both sides: the few vertices along its border that a noisy scan has drawn off go back.
void MeshMaker::put_cut_onto_plane() {
  SurfaceMesh on_half = made_.surface;
  if (frame_) frame_->bring_back(on_half.vertices, scan_);
  const std::vector<bool> of_cut = vertices_of_cut(on_half, half_->scan, made_.simplified.line_edges);
  VertexConstraints constraints(of_cut.size(), VertexConstraint::free);
  for (std::size_t v = 0; v < of_cut.size(); ++v) {
    if (!of_cut[v]) continue;
    constraints[v] = VertexConstraint::fixed;
    on_half.vertices[v].x() = 0;
    made_.surface.vertices[v] = frame_ ? frame_->to_frame(on_half.vertices[v]) : on_half.vertices[v];
  }
  preserve_volume_clear(made_.surface, scan(), constraints);
}

// A slender part needs more triangles than the few that were asked for, but none more than where nobody asks.
void MeshMaker::take_fewer_of_default(const Progress& progress) {
  constexpr double many_more = 2;  // than were wanted: fewer are not worth another search
  const double wanted = wanted_count(simplification_.size, scan_);
  const std::size_t made = made_.surface.triangles.size();
  if (wanted == 0 || simplification_.method != SimplifyMethod::lattice ||
      static_cast<double>(made) < many_more * wanted)
    return;
  SimplifyOptions by_default = simplification_;
  by_default.size = SimplifyOptions{}.size;
  auto search = std::make_unique<Simplification>(scan(), by_default);
  SurfaceMesh surface;
  SimplifyResult simplified;
  try {
    progress.improve([&](const Progress& in_time) { simplified = search->run(surface, in_time); });
  } catch (const NotMeshable&) {
    return;
  }
  const std::size_t fewer = surface.triangles.size();
  if (fewer == 0 || fewer >= made || static_cast<double>(fewer) < wanted ||
      simplified.method != SimplifyMethod::lattice)
    return;
  simplified.size_remark = made_.simplified.size_remark + "; with the default deviation there are fewer, " +
                           std::to_string(fewer) + ", and these were taken";
  made_.surface = std::move(surface);
  made_.simplified = std::move(simplified);
  search_ = std::move(search);
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
  // Vertices of the surface would move, and with them the cut.
  if (half_ || !search_ || !worth_renewing(simplification_, made_)) return;
  log_.run("renewal", [&](StageRecord& record) {
    const Progress in_time = progress.until(progress.end());
    RenewalResult renewal = renew_where_poor(*search_, simplification_, tetrahedralization_, std::move(made_), in_time);
    describe(renewal, in_scan_, record);
    note_left_out(in_time, "renewal of the surface around poor tetrahedra", record, result_);
    made_ = std::move(renewal.made);
  });
}

void MeshMaker::slide(const Progress& progress) {
  double most = options_.slide->distance;
  if (options_.slide->unit == LargestDeviation::Unit::of_diagonal) most *= bounding_box(scan_.vertices).diagonal();
  log_.run("slide", [&](StageRecord& record) {
    SlideResult slid;
    const Progress in_time = progress.until(progress.end());
    in_time.improve(
        [&](const Progress& p) { slid = slide_boundary(search_->planes(), most / in_scan_.unit(), made_, p); });
    describe(slid, in_scan_, record);
    note_left_out(in_time, "sliding of the surface", record, result_);
  });
}

// Curved sides move the corners, too, so that these are fitted before.
void MeshMaker::layer(const Progress& progress) {
  const bool is_curved = options_.order == 2;
  const Progress in_time = progress.until(progress.end());
  std::optional<FittedCurves> fitted;
  LayersResult layers;
  log_.run("layers", [&](StageRecord& record) {
    if (is_curved) {
      fitted = search_->curved(made_.simplified, made_.surface, false, in_time);
      made_.surface = fitted->surface.corners;
    }
    SurfaceMesh in_scan = made_.surface;
    if (frame_) frame_->bring_back(in_scan.vertices, scan_);
    LayeredTriangles layered = layers_of_(in_scan, made_.simplified.line_edges);
    for (LayerHeights& heights : layered.heights) heights.first /= in_scan_.unit();
    require_high_layers(made_.surface, layered, is_curved ? flattest_curved : flattest_straight, in_scan_.unit());
    layers = add_layers(layered, search_->planes(), tetrahedralization_, is_curved, made_, in_time);
    describe(layers, in_scan_, record);
  });
  constexpr const char* beside_layers =
      "beside the layers the surface would be farther from the scan than was asked for";
  constexpr const char* advice = "lower layers, a larger --deviation, or --faces instead of it";
  if (layers.lost_deviation > 0) refuse_lost_deviation(beside_layers, {}, advice);
  if (!is_curved) return;
  SecondOrderResult curved;
  log_.run("second order", [&](StageRecord& record) {
    curved = curve_layers(*fitted, layers.parallel, scan(), made_, in_time);
    curved.parted_elements = layers.parted_elements;
    describe(curved, in_scan_, record);
    note_left_out(in_time, "curved sides that are fitted to the scan", record, result_);
  });
  if (!curved.beyond.empty()) refuse_lost_deviation(beside_layers, {}, advice);
}

// Where it is a bound; of an aim a warning tells.
void MeshMaker::refuse_lost_deviation(const std::string& what, const std::string& where, const char* advice) const {
  const auto* bound = std::get_if<LargestDeviation>(&simplification_.size);
  if (bound == nullptr || !bound->required) return;
  throw NotMeshable({.what = what,
                     .where = where,
                     .value = {},
                     .limit = error_text(in_scan_.unit() * bound->distance, 4),
                     .advice = advice});
}

void MeshMaker::curve(const Progress& progress) {
  SecondOrderResult curved;
  log_.run("second order", [&](StageRecord& record) {
    const Progress in_time = progress.until(progress.end());
    if (search_ && made_.filled.boundary_parent.empty())
      in_time.improve([&](const Progress& p) { curved = fit_until_near(p); });
    if (made_.filled.mesh.order() == 1) curved = curve_on_scan(scan(), made_, in_time);
    describe(curved, in_scan_, record);
    note_left_out(in_time, "curved sides that are fitted to the scan", record, result_);
  });
  if (made_.simplified.is_of_curved && !curved.beyond.empty())
    refuse_lost_deviation("the elements do not allow sides that are as near to the scan as was asked for",
                          std::to_string(curved.beyond.size()) + " triangles",
                          "a smaller or larger --deviation, --faces instead of it, or a longer --time-limit");
}

// What elements take of the deviation, shorter edges there give back.
SecondOrderResult MeshMaker::fit_until_near(const Progress& progress) {
  constexpr int most_surfaces = 3;
  constexpr double most_growth = 1.5;
  // Of a half another surface would move the cut.
  if (!made_.simplified.is_of_curved || half_) return make_second_order(*search_, tetrahedralization_, made_, progress);
  FilledSurface straight = made_;
  const double most = most_growth * static_cast<double>(made_.surface.triangles.size());
  SecondOrderResult best = make_second_order(*search_, tetrahedralization_, made_, progress);
  for (int surface = 0; surface < most_surfaces && !best.beyond.empty(); ++surface)
    progress.improve([&](const Progress& in_time) {
      std::vector<ShorterEdges> places;
      for (const std::uint32_t f : best.beyond) places.push_back(shorter_around(made_.surface, f, least_shortening));
      const auto simplified = search_->run_again(places, most, straight.surface, in_time);
      if (!simplified) return;
      FilledSurface next = straight;
      next.simplified = *simplified;
      next.filled = scan2fea::tetrahedralize(next.surface, tetrahedralization_, in_time);
      SecondOrderResult curved = make_second_order(*search_, tetrahedralization_, next, in_time);
      if (curved.beyond.size() >= best.beyond.size()) return;
      best = std::move(curved);
      made_ = std::move(next);
    });
  return best;
}

// For want of time there are none.
void MeshMaker::curve_surface(const Progress& progress) {
  const Progress in_time = progress.until(progress.end());
  in_time.improve([&](const Progress& p) {
    auto curved = std::make_shared<FittedCurves>(search_->curved(made_.simplified, made_.surface, false, p));
    if (frame_) {
      frame_->bring_back(curved->surface.corners.vertices, scan_);
      frame_->bring_back(curved->surface.mid, scan_);
      const Vec3 origin = frame_->back(Vec3::Zero());
      for (Vec3& direction : curved->directions) direction = (frame_->back(direction) - origin) / frame_->unit();
    }
    result_.curved = std::move(curved);
  });
}

void MeshMaker::bring_back() {
  if (!frame_) return;
  frame_->bring_back(made_.surface.vertices, scan_);
  frame_->bring_back(made_.filled.mesh.nodes, scan_);
  frame_->bring_back(made_.simplified.features.points, scan_);
  made_.simplified.largest_deviation *= frame_->unit();
  made_.simplified.aimed_deviation *= frame_->unit();
  made_.simplified.noise_in_aim *= frame_->unit();
}

}  // namespace

std::vector<WeakPlace> checked_for_solvers(const SurfaceMesh& surface, const TetMesh* volume_mesh,
                                           const SurfaceMesh& scan, const PipelineOptions& options,
                                           std::size_t flat_tetrahedra) {
  std::vector<WeakPlace> places = find_weak_places(surface, volume_mesh, scan, flat_tetrahedra);
  const bool is_told_only =
      !options.tetrahedralize && options.simplify && options.simplify->method == SimplifyMethod::collapse;
  if (!is_told_only) {
    refuse_unusable(places);
    if (options.simplify) refuse_crossings(surface);
  }
  return places;
}

FilledSurface mesh_of_scan(const SurfaceMesh& scan, const std::optional<StairSteps>& stairs,
                           const PipelineOptions& options, const Half* half, const LayersOf& layers_of,
                           const Progress& progress, PipelineResult& result, StageLog& log) {
  return MeshMaker(scan, stairs, options, half, layers_of, result, log).run(progress);
}

}  // namespace scan2fea
