#include "preproc/surface/repair/repair.hpp"

#include "preproc/mesh/error_text.hpp"
#include "preproc/surface/kernel/unused_vertices.hpp"
#include "preproc/surface/repair/degenerate_faces.hpp"
#include "preproc/surface/repair/face_marks.hpp"
#include "preproc/surface/repair/hole_closing.hpp"
#include "preproc/surface/repair/intersection_removal.hpp"
#include "preproc/surface/repair/shells.hpp"
#include "preproc/surface/repair/soup_adjacency.hpp"
#include "preproc/surface/repair/soup_cleaning.hpp"
#include "preproc/surface/repair/wrap.hpp"
#include "quality/self_intersections.hpp"
#include "quality/validity.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

// Cutting out more would make another shape of the scan.
constexpr double most_cut_of_area = 1.0 / 3;

// Shells that bound nothing: dropped where they lie in a solid (as the faces do along which two solids touched) or are
// small, an error where they are what there is. Those that are to stay open bound nothing anyway.
void drop_flat_shells(SurfaceMesh& mesh, const RepairOptions& options, RepairResult& result) {
  const std::vector<Shell> shells = find_shells(mesh, options.holes == Holes::keep);
  const double total_area = surface_area(mesh);
  std::vector<std::optional<RepairKind>> reasons(shells.size());
  for (std::size_t s = 0; s < shells.size(); ++s) {
    const Shell& shell = shells[s];
    if (shell.open || std::abs(shell.volume) > least_volume_of_area * std::pow(shell.area, 1.5)) continue;
    const bool inside = std::abs(winding_of_others(mesh, shells, s)) > 0.5;
    reasons[s] = inside ? RepairKind::DroppedInside : RepairKind::DroppedFragment;
    if (!inside && shell.area >= options.fragment_of_area * total_area)
      throw NotMeshable({.what = "the surface is flat: it encloses no volume",
                         .where = error_text((shell.box.low + shell.box.high) / 2),
                         .value = "volume " + error_text(std::abs(shell.volume)) + ", area " + error_text(shell.area),
                         .limit = "volume over area^1.5 above " + error_text(least_volume_of_area),
                         .advice = "a scan of all sides of the part"});
  }
  drop_shells(mesh, shells, reasons, result);
}

[[noreturn]] void fail_of_intersections(const RepairResult& result, double cut_of_area) {
  const RepairChange* largest = nullptr;
  for (const RepairChange& change : result.changes)
    if (change.kind == RepairKind::Intersection && (!largest || change.size > largest->size)) largest = &change;
  throw NotMeshable({.what = "the surface intersects itself beyond repair",
                     .where = largest ? error_text(largest->place) : std::string(),
                     .value = std::to_string(result.intersecting_pairs) + " pairs of faces; " +
                              error_text(100 * cut_of_area) + " % of the area cut to mend them",
                     .limit = error_text(100 * most_cut_of_area) + " %",
                     .advice = "--repair wrap, or a scan with less noise and without overlapping sheets"});
}

[[noreturn]] void fail_of_level(const std::string& what, const Vec3& place, const std::string& value) {
  throw NotMeshable({.what = what,
                     .where = error_text(place),
                     .value = value,
                     .limit = "none with --repair off or gentle",
                     .advice = "--repair full"});
}

// Where no face has an area, or none of a solid, each step leaves out what it should, and all of it.
void require_some(const SurfaceMesh& mesh, const KeptBodies& bodies, const RepairResult& result) {
  if (!mesh.triangles.empty()) return;
  if (const auto* above = std::get_if<BodiesAbove>(&bodies); above && result.count(RepairKind::DroppedSpeck) > 0)
    throw NotMeshable({.what = "nothing is left of the surface: no body is large enough to be kept",
                       .where = {},
                       .value = {},
                       .limit = "a diagonal of " + error_text(above->diagonal),
                       .advice = "a smaller length for --keep"});
  throw NotMeshable({.what = "nothing is left of the surface: no part of it encloses a volume",
                     .where = result.changes.empty() ? std::string() : error_text(result.changes.back().place),
                     .value = std::to_string(result.changes.size()) + " changes",
                     .limit = {},
                     .advice = "a scan of all sides of the part"});
}

// What only the full repair mends.
void require_closed(const SurfaceMesh& mesh) {
  const Twins twins = find_twins(mesh);
  const auto loops = find_border_loops(mesh, twins);
  if (!loops.empty())
    fail_of_level("the surface is open", mesh.vertices[start_vertex(mesh, loops[0][0])],
                  std::to_string(loops.size()) + (loops.size() == 1 ? " hole" : " holes"));
}

void require_no_crossings(const SurfaceMesh& mesh) {
  const std::vector<FacePair> pairs = find_self_intersections(mesh);
  if (!pairs.empty())
    fail_of_level("the surface crosses itself", centre_of(mesh, pairs[0].face),
                  std::to_string(pairs.size()) + " pairs of faces");
}

void require_sound(const SurfaceMesh& mesh, const SurfaceValidity& validity, bool may_be_open) {
  if (!validity.manifold())
    fail_of_level("the surface is not manifold", mesh.vertices[mesh.triangles[0][0]],
                  std::to_string(validity.non_manifold_edges) + " edges of more than two faces, " +
                      std::to_string(validity.non_manifold_vertices) + " vertices of several fans, " +
                      std::to_string(validity.misoriented_edges) + " edges of faces that are turned differently");
  if (!may_be_open) require_closed(mesh);
  require_no_crossings(mesh);
  SurfaceMesh outwards = mesh;
  RepairResult turned;
  orient_shells(outwards, may_be_open, turned);
  if (!turned.unchanged())
    fail_of_level("the surface is turned inside out", turned.changes[0].place,
                  "area " + error_text(turned.changes[0].size));
}

void mend_crossings(SurfaceMesh& mesh, const RepairOptions& options, RepairResult& result, const Progress& progress) {
  const double area = surface_area(mesh);
  const IntersectionRemoval removal = remove_intersections(mesh, result, progress);
  if (removal.remaining > 0 || removal.area_cut > most_cut_of_area * area)
    fail_of_intersections(result, removal.area_cut / area);
  if (result.count(RepairKind::Intersection) > 0) {
    drop_flat_shells(mesh, options, result);
    drop_shells_inside(mesh, options.holes == Holes::keep, result);
  }
  if (result.count(RepairKind::Intersection) + result.count(RepairKind::UnitedShell) > 0)
    drop_debris(mesh, options.bodies, result);  // crossings may have parted pieces from the whole
}

// All rungs but the last.
RepairResult climb(SurfaceMesh& mesh, const RepairOptions& options, const Progress& progress) {
  RepairResult result;
  const bool keep_holes = options.holes == Holes::keep;
  const bool gentle = options.level == RepairLevel::gentle;
  constexpr double a_triangle = 1.5e-6;  // where there is little to repair
  progress.announce("repair of " + std::to_string(mesh.triangles.size()) + " triangles",
                    a_triangle * static_cast<double>(mesh.triangles.size()));
  progress("repair", 0);
  for (const Vec3& p : drop_unused_vertices(mesh)) result.changes.push_back({RepairKind::UnusedVertex, p, 0});
  const SurfaceValidity validity = check_validity(mesh);
  const bool sound = validity.closed() && validity.manifold();  // then there is nothing to do but look for crossings
  if (!sound) {
    clean_soup(mesh, result);
    make_manifold(mesh, result);
  }
  if (!sound || validity.components > 1) drop_debris(mesh, options.bodies, result);
  if (!sound && options.thickness) thicken_sheets(mesh, *options.thickness, result);
  if (!sound && !keep_holes && !gentle) {
    close_holes(mesh, {options.largest_hole_of_diagonal, options.fragment_of_area}, result, progress);
    make_manifold(mesh, result);
  }
  if (gentle && !keep_holes) require_closed(mesh);
  mend_degenerate_faces(mesh, result);
  drop_flat_shells(mesh, options, result);
  orient_shells(mesh, keep_holes, result);
  progress("repair", 0.3);
  if (gentle)
    require_no_crossings(mesh);
  else
    mend_crossings(mesh, options, result, progress);
  drop_unused_vertices(mesh);
  require_some(mesh, options.bodies, result);
  return result;
}

}  // namespace

RepairResult repair(SurfaceMesh& mesh, const RepairOptions& options, const Progress& progress) {
  check_input(mesh);
  RepairResult result;
  if (options.level == RepairLevel::off) {
    require_sound(mesh, check_validity(mesh), options.holes == Holes::keep);
  } else if (options.level == RepairLevel::wrap) {
    SurfaceMesh given = mesh;
    try {
      result = climb(mesh, options, progress);
    } catch (const NotMeshable&) {
      mesh = std::move(given);
      wrap(mesh, result);
    }
  } else {
    result = climb(mesh, options, progress);
  }
  for (const Shell& shell : find_shells(mesh)) result.bodies += shell.volume > 0;
  progress("repair", 1);
  return result;
}

}  // namespace scan2fea
