#include "preproc/command/figures.hpp"

#include "preproc/command/caller.hpp"
#include "preproc/command/console.hpp"
#include "preproc/command/element_figures.hpp"
#include "preproc/command/face_files.hpp"
#include "preproc/command/gates_asked.hpp"
#include "preproc/made_up.hpp"
#include "preproc/surface/repair/solid_volume.hpp"
#include "quality/curved_surface.hpp"
#include "quality/junit.hpp"
#include "quality/triangle_tree.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <numbers>

namespace scan2fea::command {
namespace {

Json to_json(const std::vector<StageRecord>& stages) {
  Json list = Json::array();
  for (const StageRecord& stage : stages) {
    Json entry{{"name", stage.name}, {"seconds", stage.seconds}, {"peak_bytes", stage.peak_bytes}};
    for (const auto& [name, value] : stage.changes) entry[name] = value;
    std::vector<std::string> remarks = stage.warnings;
    for (const auto& more : {stage.remarks, stage.reasons}) remarks.insert(remarks.end(), more.begin(), more.end());
    if (!remarks.empty()) entry["remarks"] = std::move(remarks);
    list.push_back(std::move(entry));
  }
  return list;
}

Json list_changes(const RepairResult& repaired, bool (*is_listed)(RepairKind)) {
  Json list = Json::array();
  for (const RepairChange& change : repaired.changes) {
    if (!is_listed(change.kind)) continue;
    Json entry{
        {"what", name(change.kind)}, {"place", point_json(change.place)}, {"size", change.size}, {"area", change.area}};
    if (change.volume > 0) entry["volume"] = change.volume;
    list.push_back(std::move(entry));
  }
  return list;
}

void add_bridges(const std::vector<Bridge>& bridges, Json& list) {
  for (const Bridge& bridge : bridges) {
    Json entry{{"what", bridge.hole_radius ? "bridged_hole" : "bridge"},
               {"place", point_json(bridge.place)},
               {"size", bridge.length},
               {"triangles", bridge.triangles}};
    if (bridge.hole_radius) entry["radius"] = *bridge.hole_radius;
    list.push_back(std::move(entry));
  }
}

// Places of others are places in this list.
Json to_json(const std::vector<Primitive>& primitives) {
  Json list = Json::array();
  for (const Primitive& primitive : primitives) {
    const Shape& shape = primitive.shape;
    Json entry{{"name", describe(primitive)},       {"use", name_of(primitive.use)}, {"kind", name_of(shape.kind)},
               {"place", point_json(shape.origin)}, {"points", primitive.points},    {"fit", primitive.fit},
               {"extent", primitive.extent}};
    if (shape.kind != ShapeKind::sphere) entry["axis"] = point_json(shape.axis);
    if (shape.kind != ShapeKind::plane) {
      entry["radius"] = shape.radius;
      entry["hollow"] = shape.hollow;
    }
    if (shape.kind == ShapeKind::torus) entry["tube_radius"] = shape.tube_radius;
    if (shape.kind == ShapeKind::cone) entry["half_angle_deg"] = shape.half_angle * 180 / std::numbers::pi;
    if (primitive.turn_deg > 0) entry["turn_deg"] = primitive.turn_deg;
    const ShapeRelations& relations = primitive.relations;
    if (relations.tangent_to) entry["tangent_to"] = *relations.tangent_to;
    if (relations.parallel_to) entry["parallel_to"] = *relations.parallel_to;
    if (relations.coaxial_to) entry["coaxial_to"] = *relations.coaxial_to;
    if (relations.same_radius_as) entry["same_radius_as"] = *relations.same_radius_as;
    list.push_back(std::move(entry));
  }
  return list;
}

Json to_json(const std::vector<MadeSet>& sets) {
  Json list = Json::array();
  for (const MadeSet& set : sets)
    list.push_back({{"name", set.name},
                    {"kind", "faces"},
                    {"area", set.area},
                    {"area_of_scan", set.area_of_scan},
                    {"area_difference_pct", 100 * (set.area / set.area_of_scan - 1)},
                    {"triangles", set.triangles}});
  return list;
}

Json to_json(const std::vector<MadeBody>& bodies) {
  Json list = Json::array();
  for (const MadeBody& body : bodies)
    list.push_back({{"name", body.name},
                    {"volume", body.volume},
                    {"volume_of_scan", body.volume_of_scan},
                    {"volume_difference_pct", 100 * (body.volume / body.volume_of_scan - 1)},
                    {"volume_joined", body.volume_joined},
                    {"tetrahedra", body.tetrahedra}});
  return list;
}

Json to_json(const std::vector<MadeContact>& contacts) {
  Json list = Json::array();
  for (const MadeContact& contact : contacts)
    list.push_back({{"bodies", {contact.first, contact.second}},
                    {"set", contact.set},
                    {"triangles_closed", contact.triangles_closed},
                    {"largest_gap", contact.largest_gap},
                    {"largest_overlap", contact.largest_overlap},
                    {"tolerance", contact.tolerance},
                    {"place", point_json(contact.at)}});
  return list;
}

Json to_json(const std::vector<MadeGap>& gaps) {
  Json list = Json::array();
  for (const MadeGap& gap : gaps)
    list.push_back({{"bodies", {gap.first, gap.second}},
                    {"size", gap.size},
                    {"tolerance", gap.tolerance},
                    {"place", point_json(gap.at)}});
  return list;
}

Json to_json(const std::vector<MadeTouch>& touches) {
  Json list = Json::array();
  for (const MadeTouch& touch : touches)
    list.push_back({{"bodies", {touch.first, touch.second}},
                    {"kind", touch.length > 0 ? "line" : "point"},
                    {"length", touch.length},
                    {"drawn_apart", touch.moved},
                    {"place", point_json(touch.at)}});
  return list;
}

bool is_on_filling(const Vec3& place, const Subject& subject) {
  const std::vector<NamedSet>& sets = face_sets_of(subject);
  const std::size_t filled = find_set(sets, filled_set);
  if (filled == sets.size()) return false;
  const SurfaceMesh faces =
      subject.volume_mesh != nullptr ? outer_corner_faces(*subject.volume_mesh) : *subject.surface;
  const std::uint32_t nearest = TriangleTree(faces).closest(place).triangle;
  return std::ranges::find(sets[filled].members, nearest) != sets[filled].members.end();
}

// Of a file.
Json sets_of(const TetMesh& mesh) {
  Json list = Json::array();
  for (const NamedSet& set : mesh.element_sets) {
    list.push_back({{"name", set.name},
                    {"kind", "elements"},
                    {"volume", volume_of(mesh, set.members)},
                    {"tetrahedra", set.members.size()}});
  }
  for (const NamedSet& set : mesh.face_sets) {
    double area = 0;
    for (const std::uint32_t f : set.members) area += face_area(mesh, mesh.boundary[f]);
    list.push_back({{"name", set.name}, {"kind", "faces"}, {"area", area}, {"triangles", set.members.size()}});
  }
  for (const NamedSet& set : mesh.node_sets)
    list.push_back({{"name", set.name}, {"kind", "nodes"}, {"nodes", set.members.size()}});
  return list;
}

Json box_of(const std::vector<Vec3>& points) {
  const BoundingBox box = bounding_box(points);
  return {{"box", point_json(box.high - box.low)}, {"diagonal", box.diagonal()}};
}

// Of what triangles use: a scanner's invalid points may be anywhere.
Json box_of(const SurfaceMesh& mesh) {
  std::vector<bool> is_used(mesh.vertices.size(), false);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) is_used[v] = true;
  std::vector<Vec3> points;
  for (std::size_t v = 0; v < is_used.size(); ++v)
    if (is_used[v]) points.push_back(mesh.vertices[v]);
  return box_of(points);
}

// What a file of figures says beside those that a terminal is told.
void add_origin(const Subject& subject, const CommonFlags& flags, Json& report) {
  report["program"] = program_json();
  report["command"] = command_json(flags.caller != nullptr ? flags.caller->arguments : arguments_of_process());
  report["inputs"] = inputs_json(subject.inputs);
  if (!subject.written.empty()) report["outputs"] = outputs_json(subject.written);
  if (subject.surface != nullptr) report["size"] = box_of(*subject.surface);
  if (subject.reference != nullptr)
    report["reference"] = extent_of(*subject.reference);
  else if (subject.cloud != nullptr)
    report["reference"] = extent_of(subject.cloud->points);
}

std::string size_text(const std::vector<Vec3>& points, const CommonFlags& flags) {
  const BoundingBox box = bounding_box(points);
  const Vec3 size = box.high - box.low;
  char text[96];
  std::snprintf(text, sizeof text, "%.6g x %.6g x %.6g ", size.x(), size.y(), size.z());
  return text + flags.unit.value_or("(no --unit given)");
}

}  // namespace

Json extent_of(const std::vector<Vec3>& points) {
  Json extent = box_of(points);
  extent["vertices"] = points.size();
  extent["triangles"] = 0;
  return extent;
}

Json extent_of(const SurfaceMesh& mesh) {
  Json extent = box_of(mesh);
  extent["vertices"] = mesh.vertices.size();
  extent["triangles"] = mesh.triangles.size();
  return extent;
}

Json measure(const Subject& subject, const CommonFlags& flags, const Progress& progress) {
  Report report;
  report.input = flags.input.string();
  const bool is_curved = subject.volume_mesh != nullptr && subject.volume_mesh->order() == 2;
  if (subject.surface != nullptr) report.surface = measure_surface(*subject.surface);
  if (subject.surface != nullptr && is_curved) {
    report.surface->area = 0;
    for (const BoundaryFace f : outer_faces_by_element(*subject.volume_mesh))
      report.surface->area += face_area(*subject.volume_mesh, f);
    if (report.surface->volume) report.surface->volume = total_volume(*subject.volume_mesh);
  }
  if (subject.surface != nullptr && subject.reference != nullptr) {
    std::optional<double> volume = subject.solid_volume;
    if (!volume && encloses_volume(*subject.surface)) volume = volume_of_solid(*subject.reference, progress);
    const DeviationOptions how{
        .seed = flags.seed, .reference_volume = volume, .reference_is_of_bodies = subject.reference_is_of_bodies};
    report.deviation = is_curved || (subject.volume_mesh != nullptr && how.reference_is_of_bodies)
                           ? measure_deviation(*subject.volume_mesh, *subject.reference, how)
                           : measure_deviation(*subject.surface, *subject.reference, how);
  }
  if (subject.surface != nullptr && subject.cloud != nullptr) {
    const double tolerance = flat_enough_of_diagonal * bounding_box(subject.cloud->points).diagonal();
    report.points = measure_point_distances(
        subject.cloud->points, is_curved ? flat_pieces(*subject.volume_mesh, tolerance).mesh : *subject.surface,
        subject.outliers ? *subject.outliers : std::vector<Vec3>{});
  }
  if (subject.volume_mesh != nullptr) report.volume_mesh = measure_tetrahedra(*subject.volume_mesh);
  Json json = scan2fea::to_json(report);
  if (report.deviation)
    json["deviation"]["farthest_is_on_filling"] =
        !report.deviation->farthest_is_on_reference && is_on_filling(report.deviation->farthest_point, subject);
  if (flags.unit) json["unit"] = *flags.unit;
  if (subject.repaired != nullptr) {
    json["lost"] = list_changes(*subject.repaired, is_lost);
    json["made_up"] = list_changes(*subject.repaired, is_made_up);
    if (subject.bridges != nullptr) add_bridges(*subject.bridges, json["made_up"]);
  }
  if (subject.primitives != nullptr && !subject.primitives->empty()) json["primitives"] = to_json(*subject.primitives);
  if (subject.faces != nullptr && !subject.faces->list.empty()) json["faces"] = face_list(*subject.faces);
  if (subject.sets != nullptr && !subject.sets->empty()) json["sets"] = to_json(*subject.sets);
  if (subject.sets == nullptr && subject.volume_mesh != nullptr) json["sets"] = sets_of(*subject.volume_mesh);
  if (json.contains("sets") && json["sets"].empty()) json.erase("sets");
  if (subject.bodies != nullptr && !subject.bodies->empty()) {
    json["bodies"] = to_json(*subject.bodies);
    json["contacts"] = to_json(*subject.contacts);
    json["gaps"] = to_json(*subject.gaps);
    json["touches"] = to_json(*subject.touches);
  }
  if (!subject.compared.is_null()) json["compared"] = subject.compared;
  if (subject.stages != nullptr) json["stages"] = to_json(*subject.stages);
  return json;
}

std::vector<GateResult> finish_report(Json& report, const Subject& subject, const CommonFlags& flags,
                                      const std::vector<Gate>& gates, OutputFiles& outputs) {
  const bool wants_all = flags.json || flags.report || flags.caller != nullptr;
  if (wants_all || has_gate_on(gates, {"inputs", "outputs", "size", "reference"})) add_origin(subject, flags, report);
  ElementFigures elements;
  if (subject.surface != nullptr && (wants_all || has_gate_on(gates, {"histograms", "worst_elements"}))) {
    elements = measure_elements(subject);
    add_to_json(elements, subject, report);
  }
  std::vector<GateResult> results = judge(gates, subject, report);
  if (report.contains("outputs"))
    for (Json& output : report["outputs"]) output["written"] = all_pass(results);
  if (flags.json) add_json(report, *flags.json, outputs);
  if (flags.junit) add_text(junit_text(report, subject.output.value_or(flags.input).string()), *flags.junit, outputs);
  if (flags.report) add_report(report, page_of(report, elements, subject), flags, outputs);
  if (flags.caller != nullptr) flags.caller->figures = report;
  return results;
}

bool report_figures(const Subject& subject, const CommonFlags& flags, const std::vector<Gate>& gates,
                    ProgressDisplay& display, OutputFiles& outputs) {
  display.begin("measure");
  Json report = measure(subject, flags, display.progress());
  if (flags.report) display.begin("report");
  const std::vector<GateResult> results = finish_report(report, subject, flags, gates, outputs);
  // With the JSON, the XML or the mesh on stdout the table goes where messages go.
  if (!flags.quiet && flags.caller == nullptr) {
    const std::string table = to_table(report) + worst_element_row(subject, report);
    if (flags.json == "-" || flags.junit == "-" || flags.stdout_is_data)
      display.line(table);
    else
      write_to_stdout(table);
  }
  tell_failures(results, flags.input);
  return all_pass(results);
}

std::string describe_input(const SurfaceMesh& mesh, const CommonFlags& flags) {
  return shown_name(flags.input) + ": " + std::to_string(mesh.vertices.size()) + " vertices, " +
         std::to_string(mesh.triangles.size()) + " triangles, " + size_text(mesh.vertices, flags);
}

std::string describe_input(const PointCloud& cloud, const CommonFlags& flags) {
  return shown_name(flags.input) + ": " + std::to_string(cloud.points.size()) + " points, " +
         (cloud.left_out > 0 ? std::to_string(cloud.left_out) + " more marked as none, " : "") +
         size_text(cloud.points, flags);
}

}  // namespace scan2fea::command
