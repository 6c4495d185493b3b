#include "preproc/stage_descriptions.hpp"

#include "preproc/mesh/error_text.hpp"

#include <map>
#include <string>

namespace scan2fea {
namespace {

std::string rounded(double value) {
  return error_text(value, 4);
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

// One line, whatever the number of places: what the mesh has not of the edges that were found.
void warn_of_lost_edges(const SimplifyResult& result, std::size_t unsupported, StageRecord& record) {
  if (unsupported > 0) {
    std::string why;
    for (const UnsupportedCreases& dropped : result.unsupported_creases)
      why += (why.empty() ? "" : "; ") + std::to_string(dropped.edges) + ": " + describe(dropped.fault);
    record.warnings.push_back(
        (unsupported == result.feature_edges
             ? "none of the " + std::to_string(unsupported)
             : std::to_string(unsupported) + " of the " + std::to_string(result.feature_edges)) +
        " sharp edges found on the scan " + (unsupported == result.feature_edges ? "is kept" : "are not kept") +
        " as an edge of the mesh (" + why +
        "); where they are edges of the part, --features-from LINES.obj keeps those that are given");
  }
  if (result.feature_edges_too_fine > 0)
    record.warnings.push_back(std::to_string(result.feature_edges_too_fine) +
                              " edges of creases are not kept: they are too short, or their faces too small, for "
                              "triangles of the wanted size");
  if (!result.feature_remark.empty()) record.warnings.push_back(result.feature_remark);
}

// What became of the sharp edges of the scan. Gates may name the figures, so that they are there even where all are 0.
void describe_features(const SimplifyResult& result, const InScan& in_scan, StageRecord& record) {
  std::size_t unsupported = 0;
  for (const UnsupportedCreases& dropped : result.unsupported_creases) unsupported += dropped.edges;
  record.changes.emplace_back("feature_edges_before", static_cast<double>(result.feature_edges));
  record.changes.emplace_back("feature_edges_unsupported", static_cast<double>(unsupported));
  record.changes.emplace_back("feature_edges_too_fine", static_cast<double>(result.feature_edges_too_fine));
  record.changes.emplace_back("feature_edges_after", static_cast<double>(result.feature_edges_kept));
  for (const UnsupportedCreases& dropped : result.unsupported_creases)
    record.reasons.push_back(std::to_string(dropped.edges) + " sharp edges in " + std::to_string(dropped.networks) +
                             (dropped.networks == 1 ? " place, " : " places, the longest ") + "at " +
                             error_text(in_scan.place(dropped.place)) +
                             ", are not kept as creases: " + describe(dropped.fault));
  warn_of_lost_edges(result, unsupported, record);
}

}  // namespace

void describe(const ReconstructResult& result, StageRecord& record) {
  const auto holes_bridged =
      std::ranges::count_if(result.bridges, [](const Bridge& bridge) { return bridge.hole_radius.has_value(); });
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
                    {"holes_bridged", static_cast<double>(holes_bridged)},
                    {"noise", result.noise},
                    {"spacing", result.spacing},
                    {"largest_distance_of_points", result.distances.largest},
                    {"rms_distance_of_points", result.distances.rms}};
  record.remarks.push_back(result.choice);
  record.remarks.insert(record.remarks.end(), result.views.begin(), result.views.end());
  if (result.thinned > 0)
    record.remarks.push_back("of the points one in each cell of " + rounded(result.cell) + " was taken");
  if (result.distances.largest > 0)
    record.remarks.push_back("the given points but outliers lie within " + rounded(result.distances.largest) +
                             " of the surface, the farthest at " + error_text(result.distances.farthest));
  if (!result.outliers.empty())
    record.remarks.push_back(std::to_string(result.outliers.size()) + " outliers were left out, the first at " +
                             error_text(result.outliers.front()));
  for (const Bridge& bridge : result.bridges)
    record.remarks.push_back(
        bridge.hole_radius
            ? "at " + error_text(bridge.place) + " the surface closes or narrows a hole of radius " +
                  rounded(*bridge.hole_radius) + ", in which there are no points"
            : "at " + error_text(bridge.place) + " the surface spans " + rounded(bridge.length) + " between points " +
                  rounded(bridge.spacing) + " apart from their own: a gap, or a hole that was bridged");
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

void describe(const MirrorPlane& plane, StageRecord& record) {
  record.changes = {{"normal_x", plane.normal.x()},       {"normal_y", plane.normal.y()},
                    {"normal_z", plane.normal.z()},       {"offset", plane.offset},
                    {"rms_distance", plane.rms_distance}, {"largest_distance", plane.largest_distance}};
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
  if (result.gave_up)
    record.remarks.emplace_back("nothing was added: the volume would have changed by more than its triangles cut off");
  // What an engineer looks for in a part: round things, since faces are many and told by the eye.
  for (const Primitive& primitive : result.primitives)
    if (primitive.use != PrimitiveUse::face) record.remarks.push_back(describe(primitive));
}

void describe(const SimplifyResult& result, const InScan& in_scan, StageRecord& record) {
  record.changes = {{"faces_before", static_cast<double>(result.faces_before)},
                    {"faces_after", static_cast<double>(result.faces_after)},
                    {"crossings_mended", static_cast<double>(result.crossings_mended)}};
  describe_features(result, in_scan, record);
  if (!result.size_remark.empty()) record.remarks.push_back(result.size_remark);
  if (result.largest_deviation > 0)
    record.changes.emplace_back("largest_deviation", in_scan.unit() * result.largest_deviation);
  if (result.noise_in_aim > 0)
    record.remarks.push_back("the scan has noise of " + rounded(in_scan.unit() * result.noise_in_aim) +
                             ", whose farthest vertices no smooth surface comes near: " +
                             rounded(in_scan.unit() * result.aimed_deviation) + " from the scan is aimed at");
  if (result.is_of_curved)
    record.remarks.emplace_back("the deviation is that of its curved triangles, of which fewer keep it");
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
  record.reasons.clear();
  if (const auto& at = result.bound.min_dihedral_at)
    record.reasons.push_back("the surface bounds the dihedral angle at " + error_text(in_scan.place(*at)));
  if (const auto& at = result.bound.scaled_jacobian_at)
    record.reasons.push_back("the surface bounds the scaled Jacobian at " + error_text(in_scan.place(*at)));
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

void describe(const SlideResult& slid, const InScan& in_scan, StageRecord& record) {
  record.changes = {{"vertices_moved", static_cast<double>(slid.moved)},
                    {"most", in_scan.unit() * slid.most},
                    {"largest_move", in_scan.unit() * slid.largest_move},
                    {"min_dihedral_before_deg", slid.min_dihedral_before_deg},
                    {"min_dihedral_after_deg", slid.min_dihedral_after_deg},
                    {"max_dihedral_before_deg", slid.max_dihedral_before_deg},
                    {"max_dihedral_after_deg", slid.max_dihedral_after_deg}};
  if (!slid.is_taken)
    record.remarks.emplace_back("nothing was moved: no place along the scan is better, or none within the deviation");
}

void describe(const LayersResult& layers, const InScan& in_scan, StageRecord& record) {
  record.changes = {{"tetrahedra", static_cast<double>(layers.all_tetrahedra)},
                    {"nodes", static_cast<double>(layers.nodes)},
                    {"layer_tetrahedra", static_cast<double>(layers.tetrahedra)},
                    {"layered_triangles", static_cast<double>(layers.triangles)},
                    {"layered_vertices", static_cast<double>(layers.vertices)},
                    {"lower_vertices", static_cast<double>(layers.lower_vertices)},
                    {"tapered_vertices", static_cast<double>(layers.tapered_vertices)},
                    {"least_share_of_height", layers.least_share},
                    {"largest_move", in_scan.unit() * layers.largest_move}};
  if (layers.lower_vertices > 0)
    record.warnings.push_back("layers are lower than asked for at " + std::to_string(layers.lower_vertices) + " of " +
                              std::to_string(layers.vertices) + " vertices, for want of room: down to " +
                              error_text(100 * layers.least_share, 3) + " % of the height at " +
                              error_text(in_scan.place(layers.least_at)));
  if (layers.lost_volume_pct > 0)
    record.warnings.push_back("the surface that made room for the layers encloses " +
                              error_text(layers.lost_volume_pct, 3) + " % more or less than the scan");
  if (layers.lost_deviation > 0)
    record.warnings.push_back(
        "to make room for the layers vertices beside them moved along the scan: the surface is " +
        error_text(in_scan.unit() * layers.lost_deviation, 4) +
        " from it, more than was asked for; lower layers or smaller triangles keep the deviation");
  if (layers.tapered_vertices > 0)
    record.remarks.push_back("layers taper off at " + std::to_string(layers.tapered_vertices) +
                             " vertices, where no edge of the part ends them");
}

void describe(const SecondOrderResult& result, const InScan& in_scan, StageRecord& record) {
  const CurveResult& curved = result.curved;
  const double unit = in_scan.unit();
  record.changes = {{"tetrahedra", static_cast<double>(curved.tetrahedra)},
                    {"nodes", static_cast<double>(curved.nodes)},
                    {"curved_edges", static_cast<double>(curved.curved)},
                    {"eased_edges", static_cast<double>(curved.eased)},
                    {"parted_elements", static_cast<double>(result.parted_elements)},
                    {"straight_triangles", static_cast<double>(result.straight_triangles)},
                    {"triangles_beyond", static_cast<double>(result.beyond.size())},
                    {"largest_bend", unit * curved.largest_displacement},
                    {"least_scaled_jacobian", curved.least_scaled_jacobian},
                    {"curved_volume", unit * unit * unit * curved.volume}};
  if (!result.beyond.empty())
    record.warnings.push_back(std::to_string(result.beyond.size()) +
                              " curved triangles are farther from the scan than was asked for: smaller triangles, or a "
                              "smaller --deviation, keep it");
  if (!result.keeps_volume)
    record.warnings.emplace_back(
        "the curved elements do not enclose the scan's volume: for the elements' sake nodes went back that gave it; "
        "smaller triangles (--faces, --edge-length) keep it");
  if (result.corners_kept)
    record.remarks.emplace_back("corners stayed where they were: with them on the scan no tetrahedra came out in time");
}

}  // namespace scan2fea
