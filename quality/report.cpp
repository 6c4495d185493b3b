#include "quality/report.hpp"

#include "quality/comparison_table.hpp"
#include "quality/self_intersections.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>

namespace scan2fea {
namespace {

Json figure(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

template <class Number>
Json figure(const std::optional<Number>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json surface_json(const SurfaceFigures& surface) {
  const TriangleSummary& shape = surface.shape;
  // Where every triangle is degenerate there is no shape to report.
  const auto of_shape = [&](double value) { return shape.measured > 0 ? figure(value) : Json(nullptr); };
  return {{"vertices", surface.vertices},
          {"faces", surface.faces},
          {"edge_ratio",
           {{"mean", of_shape(shape.edge_ratio.mean)},
            {"p50", of_shape(shape.edge_ratio.p50)},
            {"p95", of_shape(shape.edge_ratio.p95)},
            {"p99", of_shape(shape.edge_ratio.p99)},
            {"max", of_shape(shape.edge_ratio.max)}}},
          {"min_angle_deg", {{"mean", of_shape(shape.min_angle_deg.mean)}, {"min", of_shape(shape.min_angle_deg.min)}}},
          {"max_angle_deg", of_shape(shape.max_angle_deg)},
          {"radius_ratio", {{"mean", of_shape(shape.radius_ratio.mean)}, {"min", of_shape(shape.radius_ratio.min)}}},
          {"degenerate", shape.degenerate},
          {"closed", surface.validity.closed()},
          {"manifold", surface.validity.manifold()},
          {"oriented", surface.validity.oriented()},
          {"self_intersections", surface.self_intersections},
          {"unused_vertices", surface.validity.unused_vertices},
          {"components", surface.validity.components},
          {"genus", figure(surface.validity.genus)},
          {"volume", figure(surface.volume)},
          {"area", figure(surface.area)}};
}

Json side_json(const OneSidedDistance& side) {
  return {{"hausdorff_pct_diagonal", figure(side.hausdorff_pct_diagonal)},
          {"rms_pct_diagonal", figure(side.rms_pct_diagonal)}};
}

Json points_json(const PointDistances& points) {
  const Vec3& p = points.farthest;
  return {{"count", points.points},
          {"largest_distance", figure(points.largest)},
          {"rms_distance", figure(points.rms)},
          {"farthest_point", point_json(p)}};
}

Json deviation_json(const Deviation& deviation) {
  const Vec3& p = deviation.farthest_point;
  return {{"volume_difference_pct", figure(deviation.volume_difference_pct)},
          {"area_difference_pct", figure(deviation.area_difference_pct)},
          {"hausdorff_pct_diagonal", figure(deviation.hausdorff_pct_diagonal)},
          {"rms_pct_diagonal", figure(deviation.rms_pct_diagonal)},
          {"farthest_point", point_json(p)},
          {"from_mesh", side_json(deviation.from_mesh)},
          {"from_reference", side_json(deviation.from_reference)}};
}

Json volume_mesh_json(const TetSummary& tets) {
  return {{"nodes", tets.nodes},
          {"tetrahedra", tets.tetrahedra},
          {"order", tets.order},
          {"min_dihedral_deg", figure(tets.min_dihedral_deg)},
          {"max_dihedral_deg", figure(tets.max_dihedral_deg)},
          {"min_face_angle_deg", figure(tets.min_face_angle_deg)},
          {"max_face_angle_deg", figure(tets.max_face_angle_deg)},
          {"scaled_jacobian", {{"min", figure(tets.scaled_jacobian.min)}, {"mean", figure(tets.scaled_jacobian.mean)}}},
          {"edge_ratio", figure(tets.edge_ratio)},
          {"radius_edge_ratio", figure(tets.radius_edge_ratio)},
          {"volume", figure(tets.volume)},
          {"inverted", tets.inverted}};
}

std::string text(const Json& value, const char* format = "%.4f") {
  if (value.is_null()) return "none";
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_integer()) return value.dump();
  if (!value.is_number()) return value.is_string() ? value.get<std::string>() : value.dump();
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value.get<double>());
  return buffer;
}

std::string surface_table(const Json& s) {
  const Json &ratio = s["edge_ratio"], &angle = s["min_angle_deg"], &radius = s["radius_ratio"];
  std::string table = "surface\n";
  table += table_row("size", text(s["vertices"]) + " vertices, " + text(s["faces"]) + " triangles, " +
                                 text(s["degenerate"]) + " of zero area");
  table +=
      table_row("edge ratio", "mean " + text(ratio["mean"]) + ", median " + text(ratio["p50"]) + ", 95 % " +
                                  text(ratio["p95"]) + ", 99 % " + text(ratio["p99"]) + ", max " + text(ratio["max"]));
  table += table_row("angles", "smallest: mean " + text(angle["mean"], "%.2f") + ", min " + text(angle["min"], "%.2f") +
                                   "; largest " + text(s["max_angle_deg"], "%.2f") + " deg");
  table += table_row("radius ratio", "mean " + text(radius["mean"]) + ", min " + text(radius["min"]));
  table += table_row("closed, manifold", text(s["closed"]) + ", " + text(s["manifold"]) +
                                             (s["oriented"].get<bool>() ? "" : " (faces are not oriented alike)"));
  table += table_row("self-intersections", text(s["self_intersections"]));
  table += table_row("components, genus", text(s["components"]) + ", " + text(s["genus"]));
  table += table_row("unused vertices", text(s["unused_vertices"]));
  const bool inside_out = s["volume"].is_number() && s["volume"].get<double>() < 0;
  table += table_row("volume, area", text(s["volume"], "%.9g") + (inside_out ? " (normals point inwards)" : "") + ", " +
                                         text(s["area"], "%.9g"));
  return table;
}

std::string points_table(const Json& points) {
  const Json& p = points["farthest_point"];
  return "points of the cloud\n" +
         table_row("distance from mesh", "largest " + text(points["largest_distance"], "%.6g") + ", RMS " +
                                             text(points["rms_distance"], "%.6g") + ", of " + text(points["count"]) +
                                             " points; the farthest at (" + text(p[0], "%.6g") + ", " +
                                             text(p[1], "%.6g") + ", " + text(p[2], "%.6g") + ")");
}

std::string deviation_table(const Json& d) {
  std::string table = "deviation from the reference\n";
  table += table_row("volume", text(d["volume_difference_pct"]) + " %");
  table += table_row("area", text(d["area_difference_pct"]) + " %");
  table +=
      table_row("Hausdorff distance",
                text(d["hausdorff_pct_diagonal"]) + " % of the diagonal, at (" + text(d["farthest_point"][0], "%.6g") +
                    ", " + text(d["farthest_point"][1], "%.6g") + ", " + text(d["farthest_point"][2], "%.6g") + ")" +
                    (d.value("farthest_is_on_filling", false) ? ", where a hole was closed" : ""));
  table += table_row("RMS distance", text(d["rms_pct_diagonal"], "%.5f") + " % of the diagonal");
  for (const auto& [name, side] : {std::pair("from the mesh", "from_mesh"), {"from the reference", "from_reference"}})
    table += table_row(name, "Hausdorff " + text(d[side]["hausdorff_pct_diagonal"]) + " %, RMS " +
                                 text(d[side]["rms_pct_diagonal"], "%.5f") + " %");
  return table;
}

std::string volume_mesh_table(const Json& v) {
  std::string table = "volume mesh\n";
  table += table_row("size", text(v["nodes"]) + " nodes, " + text(v["tetrahedra"]) + " tetrahedra of order " +
                                 text(v["order"]) + ", " + text(v["inverted"]) + " inverted");
  table +=
      table_row("dihedral angles", text(v["min_dihedral_deg"], "%.2f") + " to " + text(v["max_dihedral_deg"], "%.2f") +
                                       " deg, of faces " + text(v["min_face_angle_deg"], "%.2f") + " to " +
                                       text(v["max_face_angle_deg"], "%.2f") + " deg");
  table += table_row("scaled Jacobian",
                     "mean " + text(v["scaled_jacobian"]["mean"]) + ", min " + text(v["scaled_jacobian"]["min"]));
  table += table_row("edge ratio", "max " + text(v["edge_ratio"]));
  table += table_row("radius/edge ratio", "max " + text(v["radius_edge_ratio"]));
  table += table_row("volume", text(v["volume"], "%.9g"));
  return table;
}

std::string gate_row(const Json& gate) {
  return table_row(gate["pass"].get<bool>() ? "pass" : "FAIL",
                   text(gate["name"]) + " = " + text(gate["value"], "%.6g") + ", " + text(gate["operator"]) + " " +
                       text(gate["limit"], "%.6g"));
}

std::string set_text(const Json& set) {
  if (set.contains("nodes")) return text(set["nodes"]) + " nodes";
  if (set.contains("tetrahedra")) return text(set["tetrahedra"]) + " tetrahedra, volume " + text(set["volume"], "%.9g");
  std::string line = text(set["triangles"]) + " triangles, area " + text(set["area"], "%.6g");
  if (set.contains("area_of_scan")) line += ", of the scan " + text(set["area_of_scan"], "%.6g");
  return line;
}

}  // namespace

SurfaceFigures measure_surface(const SurfaceMesh& mesh) {
  SurfaceFigures surface;
  surface.vertices = mesh.vertices.size();
  surface.faces = mesh.triangles.size();
  surface.shape = measure_triangles(mesh);
  surface.validity = check_validity(mesh);
  surface.self_intersections = find_self_intersections(mesh).size();
  if (surface.validity.encloses_volume()) surface.volume = enclosed_volume(mesh);
  surface.area = surface_area(mesh);
  return surface;
}

std::string table_row(const std::string& name, const std::string& figures) {
  constexpr std::size_t column = 22;  // names have 18 characters at most, but those of sets
  return "  " + name + std::string(name.size() < column ? column - name.size() : 1, ' ') + figures + "\n";
}

Json point_json(const Vec3& p) {
  return Json::array({figure(p.x()), figure(p.y()), figure(p.z())});
}

Json to_json(const Report& report) {
  Json json{{"schema", report_schema}, {"input", report.input}};
  if (report.surface) json["surface"] = surface_json(*report.surface);
  if (report.deviation) json["deviation"] = deviation_json(*report.deviation);
  if (report.points) json["points"] = points_json(*report.points);
  if (report.volume_mesh) json["volume_mesh"] = volume_mesh_json(*report.volume_mesh);
  json["regions"] = Json::array();
  for (const RegionFigures& region : report.regions)
    json["regions"].push_back({{"name", region.name}, {"area", figure(region.area)}, {"faces", region.faces}});
  json["gates"] = Json::array();
  return json;
}

namespace {

std::string gate_rows(const Json& gates) {
  std::string table = gates.empty() ? "" : "gates\n";
  for (const Json& gate : gates) table += gate_row(gate);
  return table;
}

// Both meshes in columns, and then only what the columns do not say.
std::string table_of_two(const Json& report) {
  const Json& compared = report["compared"];
  std::string table = text(compared["first"]["input"]) + " and " + text(compared["second"]["input"]) + "\n" +
                      comparison_table(compared);
  if (report.contains("deviation")) table += "the second from the first: " + deviation_table(report["deviation"]);
  return table + gate_rows(report["gates"]);
}

}  // namespace

std::string to_table(const Json& report) {
  if (report.contains("compared")) return table_of_two(report);
  std::string table = text(report["input"]) + "\n";
  if (report.contains("surface")) table += surface_table(report["surface"]);
  if (report.contains("deviation")) table += deviation_table(report["deviation"]);
  if (report.contains("points")) table += points_table(report["points"]);
  if (report.contains("volume_mesh")) table += volume_mesh_table(report["volume_mesh"]);
  if (report.contains("sets")) table += "sets\n";
  if (report.contains("sets"))
    for (const Json& set : report["sets"]) table += table_row(text(set["name"]), set_text(set));
  if (report.contains("bodies")) table += "bodies\n";
  if (report.contains("bodies"))
    for (const Json& body : report["bodies"])
      table += table_row(text(body["name"]), text(body["tetrahedra"]) + " tetrahedra, volume " +
                                                 text(body["volume"], "%.9g") + ", " +
                                                 text(body["volume_difference_pct"], "%.4f") + " % from the scan's");
  if (!report["regions"].empty()) table += "regions\n";
  for (const Json& region : report["regions"])
    table += table_row(text(region["name"]), text(region["faces"]) + " faces, area " + text(region["area"], "%.9g"));
  return table + gate_rows(report["gates"]);
}

}  // namespace scan2fea
