#include "preproc/slide_boundary.hpp"

#include "preproc/surface/fit/preserve_volume.hpp"
#include "preproc/surface/kernel/clear_moves.hpp"
#include "preproc/surface/simplification/surface_on_scan.hpp"
#include "preproc/surface/simplification/vertices_beyond.hpp"
#include "preproc/ways_on_scan.hpp"
#include "quality/deviation_bound.hpp"
#include "quality/tetrahedron_measures.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace scan2fea {
namespace {

// The shift that gives the volume back takes the rest of the way: it goes with the square of the slides.
constexpr double share_of_slide = 0.95;

// Dihedral angles of 38 to 125 degrees; and where a face of the scan ends in a tip of 19 degrees, as fandisk's does, an
// element on it has either a dihedral angle of 27 degrees or a scaled Jacobian of 0.34: there 35 degrees and 0.24 are
// better.
constexpr OptimiseOptions slide_options{
    .threshold = 1.65, .insertion_rounds = 3, .patches = PatchOptions{.jacobian_counts = 1.8}};

// Neither angle is worse, and one is better.
bool is_better(const TetSummary& after, const TetSummary& before) {
  const double least = after.min_dihedral_deg - before.min_dihedral_deg;
  const double largest = before.max_dihedral_deg - after.max_dihedral_deg;
  return after.inverted == 0 && least >= 0 && largest >= 0 && least + largest > 0;
}

void note_moves(const std::vector<Vec3>& from, const std::vector<Vec3>& to, SlideResult& result) {
  for (std::size_t v = 0; v < from.size(); ++v) {
    const double move = (to[v] - from[v]).norm();
    result.largest_move = std::max(result.largest_move, move);
    result.moved += move > 0 ? 1 : 0;
  }
}

void note_angles(const TetSummary& before, const TetSummary& after, SlideResult& result) {
  result.min_dihedral_before_deg = before.min_dihedral_deg;
  result.max_dihedral_before_deg = before.max_dihedral_deg;
  result.min_dihedral_after_deg = after.min_dihedral_deg;
  result.max_dihedral_after_deg = after.max_dihedral_deg;
}

// The surface with its vertices there, as far as nothing meets, and the scan's volume; nothing where it would lose
// that. `beyond` are the vertices where it would lose a deviation that was asked for.
std::optional<SurfaceMesh> moved_to(const std::vector<Vec3>& places, const SurfaceMesh& given,
                                    const PlanesOfScan& planes, SimplifyResult& simplified,
                                    std::vector<std::uint32_t>& beyond) {
  const FeatureNet& net = simplified.on_scan->net;
  const PreparedScan& scan = *simplified.on_scan->scan;
  SurfaceMesh surface = given;
  move_clear(surface, places);
  const std::vector<Vec3> outwards = planes.empty() ? std::vector<Vec3>() : planes.vertices_of(given, net).outwards;
  if (!preserve_volume_clear(surface, scan.mesh, held_lines(net, places.size()), outwards)) return {};
  const double asked = simplified.aimed_deviation, before = simplified.largest_deviation;
  if (before > 0) {
    const DeviationBound bound = bound_deviation(surface, scan.deviation_reference(), {.limit = asked});
    if (before <= asked) beyond = vertices_beyond(surface, bound, asked);
    simplified.largest_deviation = bound.upper();
  }
  return surface;
}

// What moves beside them takes them along.
void hold_around(const std::vector<std::uint32_t>& vertices, const SurfaceMesh& surface, std::vector<bool>& held) {
  std::vector<bool> is_one(held.size(), false);
  for (const std::uint32_t v : vertices) is_one[v] = true;
  for (const Triangle& t : surface.triangles)
    if (is_one[t[0]] || is_one[t[1]] || is_one[t[2]])
      for (const std::uint32_t v : t) held[v] = true;
}

// With these vertices held; those of `beyond` are to be held, too, before the result may be taken.
SlideResult slide(const PlanesOfScan& planes, double most, const std::vector<bool>& held, FilledSurface& made,
                  std::vector<std::uint32_t>& beyond, const Progress& progress) {
  SlideResult result{.most = most};
  const TetSummary before = measure_tetrahedra(made.filled.mesh);
  note_angles(before, before, result);
  const SurfaceOnScan& on_scan = *made.simplified.on_scan;
  TetMesh mesh = made.filled.mesh;
  const auto vertices = static_cast<std::ptrdiff_t>(held.size());
  const BoundaryWays ways =
      ways_on_scan(made.surface, on_scan.net, on_scan.scan->reference(), planes, share_of_slide * most);
  const BoundaryWays some = [&](std::uint32_t v, const Vec3& wanted) {
    return held[v] ? std::optional<WayPoint>() : ways(v, wanted);
  };
  optimise_tetrahedra(mesh, held.size(), slide_options, some, progress);

  SimplifyResult simplified = made.simplified;
  std::optional<SurfaceMesh> surface =
      moved_to({mesh.nodes.begin(), mesh.nodes.begin() + vertices}, made.surface, planes, simplified, beyond);
  if (!surface || !beyond.empty()) return result;
  std::ranges::copy(surface->vertices, mesh.nodes.begin());
  const TetSummary after = measure_tetrahedra(mesh);
  SlideResult slid{.most = most, .is_taken = true};
  note_angles(before, after, slid);
  note_moves(made.surface.vertices, surface->vertices, slid);
  if (slid.largest_move > most || !is_better(after, before)) return result;
  made.surface = std::move(*surface);
  made.simplified = std::move(simplified);
  made.filled.mesh = std::move(mesh);
  return slid;
}

}  // namespace

SlideResult slide_boundary(const PlanesOfScan& planes, double most, FilledSurface& made, const Progress& progress) {
  constexpr int most_trials = 6;
  std::vector<bool> held(made.surface.vertices.size(), false);
  SlideResult result;
  for (int trial = 0; trial < most_trials; ++trial) {
    std::vector<std::uint32_t> beyond;
    result = slide(planes, most, held, made, beyond, progress);
    if (beyond.empty()) break;
    hold_around(beyond, made.surface, held);
  }
  return result;
}

}  // namespace scan2fea
