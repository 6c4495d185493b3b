#include "preproc/surface/mending/mend_surface.hpp"

#include "preproc/surface/fit/preserve_volume.hpp"
#include "preproc/surface/fit/shape_fit.hpp"
#include "preproc/surface/kernel/nearest.hpp"
#include "preproc/surface/kernel/rings.hpp"
#include "preproc/surface/mending/local_moves.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace scan2fea {
namespace {

// Two rings are enough for a tangle to spread out, and few enough to leave the rest of the surface alone.
constexpr int rings_of_repair = 2;
constexpr int smoothing_sweeps = 10;
// Some angles cannot be had (a sharp corner of the part): then further rounds are in vain.
constexpr int most_rounds_without_gain = 3;
// Over an edge length: a move by more than the volume's shift, and by less than any mending.
constexpr double negligible_move = 0.005;

// Fewer faces that cross or are inverted are better, whatever the angles; among equals the angles decide.
bool is_better(const SurfaceDefects& a, const SurfaceDefects& b) {
  const std::size_t harm_a = a.crossings.size() + a.inverted.size();
  const std::size_t harm_b = b.crossings.size() + b.inverted.size();
  return harm_a != harm_b ? harm_a < harm_b : a.missing_angles_deg < b.missing_angles_deg;
}

std::vector<std::uint32_t> faces_of(const SurfaceDefects& defects) {
  std::vector<std::uint32_t> faces = defects.inverted;
  faces.insert(faces.end(), defects.small_angles.begin(), defects.small_angles.end());
  for (const FacePair& p : defects.crossings) faces.insert(faces.end(), {p.face, p.other});
  return faces;
}

void remove_fixed(std::vector<bool>& movable, const VertexConstraints& constraints) {
  for (std::size_t v = 0; v < constraints.size(); ++v) {
    if (constraints[v] == VertexConstraint::fixed) movable[v] = false;
  }
}

// Angles between two edges on lines of the net are not the surface's to mend. A face's other small angles are: where a
// line runs straight on over two of its sides, it has no area and asks for a flip.
void drop_own_angles(SurfaceDefects& defects, const SurfaceMesh& mesh, const std::vector<FeatureEdge>& edges,
                     double least_angle_deg) {
  const auto is_on_line = [&](std::uint32_t a, std::uint32_t b) {
    return std::binary_search(edges.begin(), edges.end(), feature_edge(a, b));
  };
  std::erase_if(defects.small_angles, [&](std::uint32_t f) {
    const Triangle& t = mesh.triangles[f];
    bool own = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = t[k], next = t[(k + 1) % 3], last = t[(k + 2) % 3];
      if (angle_deg(mesh.vertices[v], mesh.vertices[next], mesh.vertices[last]) < least_angle_deg)
        own = own && is_on_line(v, next) && is_on_line(v, last);
    }
    if (own)
      defects.missing_angles_deg -=
          least_angle_deg - smallest_angle_deg(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    return own;
  });
}

// Fits again with more weight on shape, where `movable` is set.
void refit(SurfaceMesh& mesh, FeatureNet& net, const ReferenceSurface& scan, const std::vector<bool>& movable,
           double fidelity, const std::optional<std::vector<std::uint32_t>>& nearest_to_scan) {
  ShapeFitOptions fit;
  fit.nearest_vertex_of_scan_vertex = nearest_to_scan;
  fit.fidelity_of_diagonal = fidelity;
  fit.rounds = 2;
  fit.constraints.resize(mesh.vertices.size());
  for (std::size_t v = 0; v < movable.size(); ++v) {
    fit.constraints[v] = movable[v] ? VertexConstraint::free : VertexConstraint::fixed;
  }
  optimise_shape_and_fit(mesh, net, scan, fit);
}

void mend(SurfaceMesh& mesh, FeatureNet& net, const ReferenceSurface& scan, const SurfaceDefects& defects, int round,
          const MendOptions& options, const std::vector<std::uint32_t>& near,
          const std::optional<std::vector<std::uint32_t>>& nearest_to_scan) {
  const std::vector<bool> region = vertices_around(mesh, faces_of(defects), rings_of_repair + round / 2);
  std::vector<bool> movable = region;
  remove_fixed(movable, options.constraints);
  if (!defects.meshable()) {
    // Only what is tangled is smoothed: the fit alone serves small angles better.
    SurfaceDefects tangled = defects;
    tangled.small_angles.clear();
    const std::vector<bool> tangle = vertices_around(mesh, faces_of(tangled), 1);
    std::vector<bool> around = tangle;
    remove_fixed(around, options.constraints);
    if (!defects.inverted.empty() || round > 1) {
      smooth_worst(mesh, scan, near, around, smoothing_sweeps);
      if (flip_worst(mesh, scan, near, net.empty() ? around : tangle, edges_of(net)) > 0)
        smooth_worst(mesh, scan, near, around, smoothing_sweeps);
    }
  } else if (round > 0) {
    flip_worst(mesh, scan, near, net.empty() ? movable : region, edges_of(net));
  }
  // Vertices on lines may slide, and edges that end on a line flip. Each round allows half as
  // much distance again, 26 times as much in the eighth and last, which is near where the growth ends: what little
  // weight on shape mends stays close to the scan. At 1.2 or 2.5 instead of 1.5 fandisk at 8,000 faces is 0.080 or
  // 0.097 % of the diagonal from its scan at most, instead of 0.089.
  refit(mesh, net, scan, net.empty() ? movable : region,
        std::min(options.loosest_fidelity_of_diagonal, options.fidelity_of_diagonal * std::pow(1.5, round + 1)),
        nearest_to_scan);
  // Last, since the fit pulls crossing sheets back to where they crossed.
  if (!defects.crossings.empty()) {
    push_apart(mesh, scan, near, find_self_intersections(mesh), options.constraints);
  }
}

}  // namespace

MendResult mend_surface(SurfaceMesh& mesh, const ReferenceSurface& scan, const MendOptions& options,
                        const Progress& progress) {
  return mend_surface(mesh, FeatureNet{}, scan, options, progress);
}

MendResult mend_surface(SurfaceMesh& mesh, const FeatureNet& given_net, const ReferenceSurface& scan,
                        const MendOptions& given_options, const Progress& progress) {
  MendOptions options = given_options;
  FeatureNet net = given_net;
  const std::vector<FeatureEdge> lines = edges_of(net);
  if (!net.empty()) options.constraints = held_lines(net, mesh.vertices.size());
  if (!(options.least_angle_deg >= 0 && options.least_angle_deg < 60) || options.rounds < 1) {
    throw WrongUsage(
        {.what = "mending options out of range",
         .where = "",
         .value = std::to_string(options.least_angle_deg) + " degrees, " + std::to_string(options.rounds) + " rounds",
         .limit = "0 to 60 degrees, at least 1 round",
         .advice = ""});
  }
  if (options.keep_volume) preserve_volume(mesh, scan.whole, options.constraints);
  MendResult result;
  std::vector<std::uint32_t> near = net.empty() && !options.scan_vertex_of_face.empty()
                                        ? scan_vertices_of_faces(mesh, options.scan_vertex_of_face, scan)
                                        : scan_vertices_of_faces(mesh, net, scan);
  const auto find = [&] {
    SurfaceDefects defects = find_defects(mesh, scan, near, options.least_angle_deg);
    drop_own_angles(defects, mesh, lines, options.least_angle_deg);
    return defects;
  };
  result.before = find();
  result.after = result.before;
  if (result.before.none()) return result;

  const double edge = std::sqrt(scan.area / static_cast<double>(mesh.triangles.size()));
  // With features the fit finds them itself, patch by patch.
  std::optional<std::vector<std::uint32_t>> nearest_to_scan;
  if (net.empty())
    nearest_to_scan = options.nearest_vertex_of_scan_vertex
                          ? std::move(options.nearest_vertex_of_scan_vertex)
                          : nearest_vertices(scan.mesh.vertices, scan.vertex_normals, mesh, edge);
  const SurfaceMesh given = mesh;
  SurfaceMesh best = mesh;
  SurfaceDefects now = result.before;
  int rounds_without_gain = 0;
  for (; result.rounds < options.rounds && rounds_without_gain < most_rounds_without_gain; ++result.rounds) {
    progress("mending", static_cast<double>(result.rounds) / options.rounds);
    mend(mesh, net, scan, now, result.rounds, options, near, nearest_to_scan);
    if (options.keep_volume) preserve_volume(mesh, scan.whole, options.constraints);
    near = scan_vertices_of_faces(mesh, net, scan);
    now = find();
    ++rounds_without_gain;
    if (is_better(now, result.after)) {
      result.after = now;
      best = mesh;
      rounds_without_gain = 0;
      if (now.none()) {
        ++result.rounds;
        break;
      }
    }
  }
  mesh = std::move(best);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const double move = (mesh.vertices[v] - given.vertices[v]).norm();
    if (move > negligible_move * edge) ++result.moved;
    result.largest_move = std::max(result.largest_move, move);
  }
  return result;
}

}  // namespace scan2fea
