#include "preproc/bodies_pipeline.hpp"

#include "preproc/bodies/interface_sheets.hpp"
#include "preproc/bodies_told.hpp"
#include "preproc/curved_bodies.hpp"
#include "preproc/joined_surface.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/named_parts.hpp"
#include "preproc/second_order.hpp"
#include "preproc/stage_descriptions.hpp"
#include "preproc/stage_log.hpp"
#include "preproc/surface/repair/solid_volume.hpp"
#include "quality/tetrahedron_measures.hpp"
#include "quality/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace scan2fea {
namespace {

class BodiesPipeline {
 public:
  BodiesPipeline(std::vector<Body> bodies, const JoinOptions& joining, const PipelineOptions& options,
                 const Progress& progress, const StageListener& listener)
      : bodies_(std::move(bodies)),
        joining_(joining),
        options_(options),
        progress_(progress),
        listener_(listener),
        log_(stages_, listener, progress) {}

  PipelineResult run() {
    take_scans();
    if (options_.repair) log_.run("repair", [&](StageRecord& record) { repair_all(record); });
    log_.run("contact", [&](StageRecord& record) { join(record); });
    size_ = options_.simplify->size;
    make_surfaces();
    log_.run("tetrahedralize", [&](StageRecord& record) { fill(record); });
    if (is_poor() && options_.simplify->effort != Effort::low)
      log_.run("renewal", [&](StageRecord& record) { renew(record); });
    if (options_.order == 2) log_.run("second order", [&](StageRecord& record) { curve(record); });
    result_.repaired = std::move(repaired_);
    result_.given = std::move(given_);
    result_.solid_volume = 0;
    for (const MadeBody& body : made_bodies_) *result_.solid_volume += body.volume_of_scan;
    result_.bodies = std::move(made_bodies_);
    result_.contacts = std::move(meetings_.contacts);
    result_.gaps = std::move(meetings_.gaps);
    result_.touches = std::move(meetings_.touches);
    result_.stages = std::move(stages_);
    return std::move(result_);
  }

 private:
  void take_scans();
  void repair_all(StageRecord& record);
  void join(StageRecord& record);
  void make_surfaces();
  void simplify_outside();
  void make_interfaces(StageRecord& record);
  // What a round of renewal may replace.
  struct Made {
    PipelineResult result;
    BodyComplex complex;
    std::vector<MadeSheet> sheets;
    BodyComplex straight;
    std::optional<CurvedBodies> curved;
    double surface_allows_deg;
    std::vector<MadeBody> bodies;
    std::vector<StageRecord> stages;
  };
  Made take_made() const;
  void put_made(Made made);
  bool is_poor() const;
  void renew(StageRecord& record);
  void fill(StageRecord& record);
  TetMesh filled(StageRecord& record);
  void curve(StageRecord& record);
  EdgePlaces nearest_places(const TetMesh& mesh) const;
  void add_sets(const TetMesh& mesh);

  std::vector<Body> bodies_;
  const JoinOptions& joining_;
  const PipelineOptions& options_;
  const Progress& progress_;
  const StageListener& listener_;
  std::vector<StageRecord> stages_;
  StageLog log_;
  RepairResult repaired_;
  SurfaceMesh given_;                   // all scans
  BodyComplex scan_;                    // the bodies, joined
  TargetSize size_;                     // of the triangles, as it is asked of the outside
  BodyComplex made_;                    // the same of what was made
  std::vector<MadeSheet> sheets_;       // its pieces between bodies
  BodyComplex straight_;                // what was made, where curved sides have moved it
  std::optional<CurvedBodies> curved_;  // of order 2
  double surface_allows_deg_ = 180;     // of dihedral angles
  std::vector<MadeBody> made_bodies_;
  Meetings meetings_;
  PipelineResult result_;
};

void BodiesPipeline::take_scans() {
  for (const Body& body : bodies_) {
    append(given_, body.surface);
    made_bodies_.push_back({.name = body.name, .volume_of_scan = enclosed_volume(body.surface)});
  }
}

void BodiesPipeline::repair_all(StageRecord& record) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Body& body = bodies_[b];
    try {
      const SurfaceMesh given = *options_.repair == RepairOptions{} ? SurfaceMesh{} : body.surface;
      RepairResult repaired = repair(body.surface, *options_.repair, progress_);
      made_bodies_[b].volume_of_scan = given.triangles.empty()
                                           ? volume_of_solid(body.surface, repaired)
                                           : volume_of_solid(given).value_or(enclosed_volume(body.surface));
      repaired_.changes.insert(repaired_.changes.end(), repaired.changes.begin(), repaired.changes.end());
      repaired_.intersecting_pairs += repaired.intersecting_pairs;
      repaired_.faces_removed += repaired.faces_removed;
      repaired_.faces_added += repaired.faces_added;
    } catch (Error& error) {
      ErrorParts parts = error.parts();
      parts.where = parts.where.empty() ? body.name : body.name + ": " + parts.where;
      error.amend(std::move(parts));
      throw;
    }
  }
  describe(repaired_, record);
  std::erase_if(record.changes, [](const auto& change) { return change.first == "bodies"; });  // told by the contact
}

void BodiesPipeline::join(StageRecord& record) {
  progress_("contact", 0);
  scan_ = join_bodies(bodies_, joining_);
  meetings_ = describe_meetings(scan_, bodies_, record);
}

TargetSize finer(TargetSize size) {
  constexpr unsigned times = 2;  // as many triangles
  if (auto* faces = std::get_if<FaceCount>(&size)) faces->faces *= times;
  if (auto* ratio = std::get_if<FaceRatio>(&size)) ratio->of_input *= times;
  if (auto* edge = std::get_if<MeanEdgeLength>(&size)) edge->length /= std::sqrt(double{times});
  if (auto* bound = std::get_if<LargestDeviation>(&size)) bound->distance /= times;  // goes with an edge's square
  return size;
}

// With smaller triangles where those of the wanted size cannot stand between the bodies.
void BodiesPipeline::make_surfaces() {
  constexpr int most_finer = 2;
  const std::size_t before = stages_.size();
  for (int trial = 0;; ++trial) {
    simplify_outside();
    try {
      log_.run("interfaces", [&](StageRecord& record) { make_interfaces(record); });
      return;
    } catch (const OutOfTime&) {
      throw;
    } catch (const NotMeshable& error) {
      if (trial == most_finer) throw;
      stages_.resize(before);
      StageRecord told;
      told.name = "interfaces";
      told.remarks = {std::string(error.parts().what) + ": made again with smaller triangles"};
      if (listener_) listener_(told);
    }
    size_ = finer(size_);
  }
}

void BodiesPipeline::simplify_outside() {
  PipelineOptions options = options_;
  options.simplify->size = size_;
  options.simplify->keep_planes = false;  // the borders between bodies have to stay on their lines
  options.repair.reset();
  options.tetrahedralize.reset();
  const Outside outside = outside_of(scan_);
  options.given_sets = outside.sets;
  result_ = run_pipeline(outside.mesh, options, progress_, [&](const StageRecord& record) {
    stages_.push_back(record);
    if (listener_) listener_(record);
  });
  made_ = outside_as_made(outside, result_);
}

void BodiesPipeline::make_interfaces(StageRecord& record) {
  SimplifyOptions options = *options_.simplify;
  options.size = in_model_units(size_, bounding_box(result_.scan.vertices));
  InterfaceResult made = add_interfaces(scan_, options, result_.line_edges, made_, progress_);
  sheets_ = std::move(made.made);
  record.changes = {{"sheets", static_cast<double>(made.sheets)},
                    {"faces_before", static_cast<double>(made.faces_before)},
                    {"faces_after", static_cast<double>(made.faces_after)},
                    {"largest_volume_shift", made.largest_volume_shift}};
  if (made.largest_deviation > 0) record.changes.emplace_back("largest_deviation", made.largest_deviation);
  for (std::uint32_t b = 0; b < bodies_.size(); ++b) {
    const double before = enclosed_volume({scan_.mesh.vertices, triangles_of_body(scan_, b)});
    const double after = enclosed_volume({made_.mesh.vertices, triangles_of_body(made_, b)});
    MadeBody& body = made_bodies_[b];
    body.volume_joined = before;
    body.volume = after;
    record.remarks.push_back(told_volume(body));
  }
}

// Curved sides move the corners, too, so that it is filled after they are fitted; where that fails, as it was.
void BodiesPipeline::fill(StageRecord& record) {
  if (options_.order == 2 && result_.curved) {
    straight_ = made_;
    progress_.until(progress_.end()).improve([&](const Progress& in_time) {
      curved_ = fit_bodies(straight_, *result_.curved, result_.surface.vertices, sheets_, in_time);
    });
    if (curved_) made_.mesh.vertices = curved_->surface.corners.vertices;
  }
  TetMesh mesh;
  try {
    mesh = filled(record);
  } catch (const MeshingFailed&) {
    if (!curved_) throw;
  } catch (const NotMeshable&) {
    if (!curved_) throw;
  }
  if (mesh.tetrahedra.empty()) {
    curved_.reset();
    made_ = straight_;
    mesh = filled(record);
  }
  add_sets(mesh);
  mesh.face_sets = result_.face_sets;
  result_.surface = {made_.mesh.vertices, {}};
  for (std::size_t f = 0; f < mesh.outer_faces(); ++f) result_.surface.triangles.push_back(made_.mesh.triangles[f]);
  result_.weak_places = find_weak_places(result_.surface, &mesh, scan_.mesh);
  refuse_unusable(result_.weak_places);
  result_.volume_mesh = std::move(mesh);
}

TetMesh BodiesPipeline::filled(StageRecord& record) {
  const TetrahedralizeOptions options = options_.tetrahedralize.value_or(TetrahedralizeOptions{});
  record.remarks.clear();
  TetMesh mesh;
  mesh.nodes = made_.mesh.vertices;
  mesh.boundary.resize(made_.mesh.triangles.size());
  double least_bound = 180;
  for (std::uint32_t b = 0; b < bodies_.size(); ++b) {
    const TetrahedralizeResult filled = fill_body(made_, b, options, progress_.until(progress_.end()), mesh);
    least_bound = std::min(least_bound, filled.bound.min_dihedral_deg);
    made_bodies_[b].tetrahedra = filled.mesh.tetrahedra.size();
    record.remarks.push_back(bodies_[b].name + ": " + std::to_string(made_bodies_[b].tetrahedra) + " tetrahedra");
  }
  surface_allows_deg_ = least_bound;
  for (std::uint32_t b = 0; b < bodies_.size(); ++b) mesh.element_sets[b].name = bodies_[b].name;
  mesh.faces_between = static_cast<std::size_t>(
      std::ranges::count_if(made_.sides, [](const Sides& sides) { return sides.front != no_body; }));
  record.changes.insert(record.changes.begin(), {{"tetrahedra", static_cast<double>(mesh.tetrahedra.size())},
                                                 {"nodes", static_cast<double>(mesh.nodes.size())},
                                                 {"surface_allows_min_dihedral_deg", least_bound}});
  return mesh;
}

// As of one body; small meshes alone, since all of it is made again.
bool BodiesPipeline::is_poor() const {
  constexpr std::size_t most_triangles = 6000;
  return made_.mesh.triangles.size() <= most_triangles &&
         !is_good_dihedral(measure_tetrahedra(*result_.volume_mesh).min_dihedral_deg, surface_allows_deg_);
}

// Smaller triangles, and the better mesh.
void BodiesPipeline::renew(StageRecord& record) {
  constexpr int most_rounds = 2;
  const auto angle = [&] { return measure_tetrahedra(*result_.volume_mesh).min_dihedral_deg; };
  const double before = angle();
  double best_angle = before;
  int rounds = 0;
  Made best = take_made();
  for (; rounds < most_rounds && is_poor() && progress_.may_improve(); ++rounds) {
    size_ = finer(size_);
    try {
      make_surfaces();
      StageRecord of_filling;
      fill(of_filling);
    } catch (const MeshingFailed&) {
      break;
    } catch (const NotMeshable&) {
      break;
    }
    if (angle() < best_angle + worth_it_deg) continue;
    best_angle = angle();
    best = take_made();
  }
  put_made(std::move(best));
  record.changes = {{"surfaces_made", static_cast<double>(rounds)},
                    {"min_dihedral_before_deg", before},
                    {"min_dihedral_after_deg", best_angle},
                    {"tetrahedra", static_cast<double>(result_.volume_mesh->tetrahedra.size())}};
}

BodiesPipeline::Made BodiesPipeline::take_made() const {
  return {result_, made_, sheets_, straight_, curved_, surface_allows_deg_, made_bodies_, stages_};
}

void BodiesPipeline::put_made(Made made) {
  result_ = std::move(made.result);
  made_ = std::move(made.complex);
  sheets_ = std::move(made.sheets);
  straight_ = std::move(made.straight);
  curved_ = std::move(made.curved);
  surface_allows_deg_ = made.surface_allows_deg;
  made_bodies_ = std::move(made.bodies);
  stages_ = std::move(made.stages);
}

// The sets of the outside as they are now numbered, then the interfaces.
void BodiesPipeline::add_sets(const TetMesh& mesh) {
  std::vector<NamedSet> interfaces;
  for (auto f = static_cast<std::uint32_t>(mesh.outer_faces()); f < made_.sides.size(); ++f)
    interfaces[find_or_add_set(interfaces, interface_name(bodies_, made_.sides[f]))].members.push_back(f);
  // As the bodies were given.
  const auto order = [&](const NamedSet& set) {
    const Sides& sides = made_.sides[set.members.front()];
    return std::pair(std::min(sides.behind, sides.front), std::max(sides.behind, sides.front));
  };
  std::ranges::sort(interfaces, {}, order);
  for (NamedSet& set : interfaces) {
    MadeSet& made = result_.sets.emplace_back(MadeSet{.name = set.name, .area_of_scan = 0, .area = 0, .triangles = 0});
    made.triangles = set.members.size();
    for (const std::uint32_t f : set.members) made.area += area_vector(made_.mesh, made_.mesh.triangles[f]).norm() / 2;
    for (std::size_t f = 0; f < scan_.sides.size(); ++f)
      if (scan_.sides[f].front != no_body && interface_name(bodies_, scan_.sides[f]) == set.name)
        made.area_of_scan += area_vector(scan_.mesh, scan_.mesh.triangles[f]).norm() / 2;
    result_.face_sets.push_back(std::move(set));
  }
}

void BodiesPipeline::curve(StageRecord& record) {
  TetMesh& mesh = *result_.volume_mesh;
  SecondOrderResult result;
  if (curved_) {
    result.straight_triangles = curved_->straight;
    const auto keep_volumes = [&](const std::vector<Vec3>& directions, CurvedSurface& surface) {
      return keep_volumes_of_bodies(straight_, directions, surface);
    };
    curve_as_fitted(curved_->surface, curved_->directions, keep_volumes, mesh, result);
  } else {
    add_mid_edge_nodes(mesh);
    EdgePlaces to = nearest_places(mesh);
    result.curved = curve_mid_edge_nodes(mesh, to);
  }
  describe(result, InScan({}, nullptr), record);
  for (std::size_t b = 0; b < made_bodies_.size(); ++b) {
    made_bodies_[b].volume = volume_of(mesh, mesh.element_sets[b].members);
    record.remarks.push_back(told_volume(made_bodies_[b]));
  }
  measure_sets(result_);
  result_.weak_places = find_weak_places(result_.surface, &mesh, scan_.mesh);
}

// Where there was no time, or no way, to fit them. Of edges that stand for lines of the scans, the nodes lie on these
// lines: the middle of a chord of a rim lies in the plane face inside of it, where the nearest point of the scan is.
EdgePlaces BodiesPipeline::nearest_places(const TetMesh& mesh) const {
  EdgePlaces to = nearest_on_scan(mesh, TriangleTree(scan_.mesh));
  SurfaceMesh lines;  // a segment is a triangle without area
  const auto add = [&](const Vec3& a, const Vec3& b) {
    const auto first = static_cast<std::uint32_t>(lines.vertices.size());
    lines.vertices.insert(lines.vertices.end(), {a, b});
    lines.triangles.push_back({first, first + 1, first + 1});
  };
  for (const auto& [a, b] : result_.features.segments) add(result_.features.points[a], result_.features.points[b]);
  const ComplexLines of_scan = find_lines(scan_);
  for (const auto* edges : {&of_scan.outer, &of_scan.inner})
    for (const auto& [a, b] : *edges) add(scan_.mesh.vertices[a], scan_.mesh.vertices[b]);
  if (!lines.triangles.empty()) {
    const TriangleTree tree(lines);
    for (std::size_t e = 0; e < to.edges.size(); ++e)
      if (std::ranges::binary_search(result_.line_edges, to.edges[e])) {
        const Vec3 middle = (mesh.nodes[to.edges[e][0]] + mesh.nodes[to.edges[e][1]]) / 2;
        const double length = (mesh.nodes[to.edges[e][0]] - mesh.nodes[to.edges[e][1]]).norm();
        to.places[e] = tree.closest_within(middle, length / 4).value_or(ClosestPoint{0, middle, 0}).point;
      }
  }
  return to;
}

}  // namespace

PipelineResult run_pipeline_of_bodies(std::vector<Body> bodies, const JoinOptions& joining,
                                      const PipelineOptions& options, const Progress& progress,
                                      const StageListener& listener) {
  const auto refuse = [](const char* what, const char* advice) {
    throw WrongUsage({.what = what, .where = {}, .value = {}, .limit = {}, .advice = advice});
  };
  if (bodies.size() < 2) refuse("fewer than two bodies", "run_pipeline");
  if (options.enrich) refuse("several bodies are not enriched", "scan2fea enrich for each of them, first");
  if (options.slide) refuse("nodes of several bodies do not slide", "no --slide");
  if (!options.layers.empty()) refuse("several bodies get no layers", "no --layers");
  if (options.symmetry) refuse("several bodies have no mirror plane in common", "--symmetry off");
  if (!options.simplify || options.simplify->method != SimplifyMethod::lattice)
    refuse("several bodies are simplified by the lattice method alone", "--method lattice");
  return BodiesPipeline(std::move(bodies), joining, options, progress, listener).run();
}

}  // namespace scan2fea
