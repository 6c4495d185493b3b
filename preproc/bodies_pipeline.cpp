#include "preproc/bodies_pipeline.hpp"

#include "preproc/bodies/interface_sheets.hpp"
#include "preproc/joined_surface.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh/union_find.hpp"
#include "preproc/named_parts.hpp"
#include "preproc/second_order.hpp"
#include "preproc/stage_descriptions.hpp"
#include "preproc/stage_log.hpp"
#include "quality/triangle_tree.hpp"

#include <algorithm>
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
        log_(stages_, listener) {}

  PipelineResult run() {
    if (options_.repair) log_.run("repair", [&](StageRecord& record) { repair_all(record); });
    log_.run("contact", [&](StageRecord& record) { join(record); });
    simplify_outside();
    log_.run("interfaces", [&](StageRecord& record) { make_interfaces(record); });
    log_.run("tetrahedralize", [&](StageRecord& record) { fill(record); });
    if (options_.order == 2) log_.run("second order", [&](StageRecord& record) { curve(record); });
    result_.repaired = std::move(repaired_);
    result_.bodies = std::move(made_bodies_);
    result_.contacts = std::move(contacts_);
    result_.stages = std::move(stages_);
    return std::move(result_);
  }

 private:
  void repair_all(StageRecord& record);
  void join(StageRecord& record);
  void simplify_outside();
  void make_interfaces(StageRecord& record);
  void fill(StageRecord& record);
  void curve(StageRecord& record);
  std::string interface_name(const Sides& sides) const {
    return "INTERFACE_" + bodies_[sides.behind].name + "_" + bodies_[sides.front].name;
  }
  void add_sets(const TetMesh& mesh);

  std::vector<Body> bodies_;
  const JoinOptions& joining_;
  const PipelineOptions& options_;
  const Progress& progress_;
  const StageListener& listener_;
  std::vector<StageRecord> stages_;
  StageLog log_;
  RepairResult repaired_;
  BodyComplex scan_;  // the bodies, joined
  BodyComplex made_;  // the same of what was made
  std::vector<MadeBody> made_bodies_;
  std::vector<MadeContact> contacts_;
  PipelineResult result_;
};

void BodiesPipeline::repair_all(StageRecord& record) {
  for (Body& body : bodies_) {
    try {
      RepairResult repaired = repair(body.surface, *options_.repair, progress_);
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
  double gap = 0, overlap = 0, area = 0;
  std::size_t closed = 0;
  UnionFind joined(bodies_.size());
  for (const Contact& contact : scan_.contacts) {
    joined.unite(contact.first, contact.second);
    contacts_.push_back({.first = bodies_[contact.first].name,
                         .second = bodies_[contact.second].name,
                         .set = interface_name({contact.first, contact.second}),
                         .triangles_closed = contact.triangles,
                         .largest_gap = contact.largest_gap,
                         .largest_overlap = contact.largest_overlap,
                         .tolerance = contact.tolerance,
                         .at = contact.at});
    gap = std::max(gap, contact.largest_gap);
    overlap = std::max(overlap, contact.largest_overlap);
    area += contact.area;
    closed += contact.triangles;
    record.remarks.push_back(bodies_[contact.first].name + " and " + bodies_[contact.second].name +
                             " touch: " + std::to_string(contact.triangles) + " triangles closed, the largest gap " +
                             error_text(contact.largest_gap, 3) + ", the largest overlap " +
                             error_text(contact.largest_overlap, 3) + " (tolerance " +
                             error_text(contact.tolerance, 3) + "), at " + error_text(contact.at));
  }
  std::size_t parts = 0;
  for (std::uint32_t b = 0; b < bodies_.size(); ++b) parts += joined.find(b) == b;
  record.changes = {{"bodies", static_cast<double>(bodies_.size())},
                    {"contacts", static_cast<double>(scan_.contacts.size())},
                    {"contact_area", area},
                    {"triangles_closed", static_cast<double>(closed)},
                    {"largest_gap", gap},
                    {"largest_overlap", overlap},
                    {"parts", static_cast<double>(parts)}};
  if (parts > 1)
    record.remarks.push_back(std::to_string(parts) +
                             " parts that do not touch: a solver finds the system singular unless each is held");
}

void BodiesPipeline::simplify_outside() {
  PipelineOptions options = options_;
  options.repair.reset();
  options.tetrahedralize.reset();
  options.order = 1;
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
  options.size = in_model_units(options.size, bounding_box(result_.scan.vertices));
  const InterfaceResult made = add_interfaces(scan_, options, result_.line_edges, made_, progress_);
  record.changes = {{"sheets", static_cast<double>(made.sheets)},
                    {"faces_before", static_cast<double>(made.faces_before)},
                    {"faces_after", static_cast<double>(made.faces_after)},
                    {"largest_volume_shift", made.largest_volume_shift}};
  if (made.largest_deviation > 0) record.changes.emplace_back("largest_deviation", made.largest_deviation);
  for (std::uint32_t b = 0; b < bodies_.size(); ++b) {
    const double before = enclosed_volume({scan_.mesh.vertices, triangles_of_body(scan_, b)});
    const double after = enclosed_volume({made_.mesh.vertices, triangles_of_body(made_, b)});
    made_bodies_.push_back({.name = bodies_[b].name, .volume_of_scan = before, .volume = after, .tetrahedra = 0});
    record.remarks.push_back(bodies_[b].name + ": volume " + error_text(after) + ", " +
                             error_text(100 * (after / before - 1), 3) + " % from its scan's");
  }
}

void BodiesPipeline::fill(StageRecord& record) {
  const TetrahedralizeOptions options = options_.tetrahedralize.value_or(TetrahedralizeOptions{});
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
  for (std::uint32_t b = 0; b < bodies_.size(); ++b) mesh.element_sets[b].name = bodies_[b].name;
  mesh.faces_between = static_cast<std::size_t>(
      std::ranges::count_if(made_.sides, [](const Sides& sides) { return sides.front != no_body; }));
  record.changes.insert(record.changes.begin(), {{"tetrahedra", static_cast<double>(mesh.tetrahedra.size())},
                                                 {"nodes", static_cast<double>(mesh.nodes.size())},
                                                 {"surface_allows_min_dihedral_deg", least_bound}});
  add_sets(mesh);
  mesh.face_sets = result_.face_sets;
  result_.surface = {made_.mesh.vertices, {}};
  for (std::size_t f = 0; f < mesh.outer_faces(); ++f) result_.surface.triangles.push_back(made_.mesh.triangles[f]);
  result_.weak_places = find_weak_places(result_.surface, &mesh, scan_.mesh);
  refuse_unusable(result_.weak_places);
  result_.volume_mesh = std::move(mesh);
}

// The sets of the outside as they are now numbered, then the interfaces.
void BodiesPipeline::add_sets(const TetMesh& mesh) {
  std::vector<NamedSet> interfaces;
  for (auto f = static_cast<std::uint32_t>(mesh.outer_faces()); f < made_.sides.size(); ++f)
    interfaces[find_or_add_set(interfaces, interface_name(made_.sides[f]))].members.push_back(f);
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
      if (scan_.sides[f].front != no_body && interface_name(scan_.sides[f]) == set.name)
        made.area_of_scan += area_vector(scan_.mesh, scan_.mesh.triangles[f]).norm() / 2;
    result_.face_sets.push_back(std::move(set));
  }
}

// Of edges that stand for lines of the scans, the nodes lie on these lines: the middle of a chord of a rim lies in the
// plane face inside of it, where the nearest point of the scan is.
void BodiesPipeline::curve(StageRecord& record) {
  TetMesh& mesh = *result_.volume_mesh;
  add_mid_edge_nodes(mesh);
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
  describe({.curved = curve_mid_edge_nodes(mesh, to)}, InScan({}, nullptr), record);
  for (std::size_t b = 0; b < made_bodies_.size(); ++b)
    made_bodies_[b].volume = volume_of(mesh, mesh.element_sets[b].members);
  measure_sets(result_);
  result_.weak_places = find_weak_places(result_.surface, &mesh, scan_.mesh);
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
  if (options.symmetry) refuse("several bodies have no mirror plane in common", "--symmetry off");
  if (!options.simplify || options.simplify->method != SimplifyMethod::lattice)
    refuse("several bodies are simplified by the lattice method alone", "--method lattice");
  return BodiesPipeline(std::move(bodies), joining, options, progress, listener).run();
}

}  // namespace scan2fea
