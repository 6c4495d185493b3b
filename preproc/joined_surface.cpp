#include "preproc/joined_surface.hpp"

#include "preproc/bodies/interface_sheets.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/surface/features/curve_sampling.hpp"
#include "preproc/surface/features/feature_curves.hpp"
#include "preproc/surface/fit/preserve_volume.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/cut_surface.hpp"
#include "preproc/surface/simplification/simplify_sheet.hpp"
#include "quality/deviation_bound.hpp"
#include "quality/self_intersections.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace scan2fea {
namespace {

// No name that a user can give.
constexpr char mark = '\x01';
// Of the diagonal, as in interface_sheets.cpp; and how far chords may be from lines within.
constexpr double rounding = 1e-6, line_tolerance = 1e-4;
// Sheets with edges shorter by this that are tried where one is farther from the scan than asked.
constexpr int more_trials = 4;
constexpr double shortening = 0.7;
// Over a deviation that is only aimed at: nearer is not worth twice the triangles.
constexpr double near_enough = 1.5;
// Of a body's volume: less is the rounding of coordinates.
constexpr double exact_volume = 1e-9;

// Adds the pieces between bodies one after the other.
class Interfaces {
 public:
  Interfaces(const BodyComplex& scan, const SimplifyOptions& options, const std::vector<FeatureEdge>& line_edges,
             BodyComplex& made)
      : scan_(scan),
        options_(options),
        made_(made),
        near_(rounding * bounding_box(scan.mesh.vertices).diagonal()),
        mean_edge_(mean_edge_length(made.mesh)),
        is_held_(made.mesh.vertices.size(), false) {
    for (const FeatureEdge& edge : line_edges)
      for (const std::uint32_t v : edge) is_held_[v] = true;
  }

  InterfaceResult run(const Progress& progress) {
    find_points_on_lines();
    sample_inner_lines();
    const std::vector<Sheet> sheets = find_sheets(scan_);
    for (const Sheet& sheet : sheets) {
      if (sheet.is_closed) continue;
      progress("interfaces", static_cast<double>(result_.sheets) / static_cast<double>(sheets.size()));
      add(sheet, progress);
    }
    restore_volumes();
    require_clear();
    return result_;
  }

 private:
  // Vertices of the outside at which triangles of other bodies meet.
  void find_points_on_lines() {
    std::map<FeatureEdge, Sides> sides;
    std::vector<bool> is_on_line(made_.mesh.vertices.size(), false);
    for (std::size_t f = 0; f < made_.sides.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k) {
        const FeatureEdge edge = feature_edge(made_.mesh.triangles[f][k], made_.mesh.triangles[f][(k + 1) % 3]);
        const auto [at, is_first] = sides.try_emplace(edge, made_.sides[f]);
        if (!is_first && at->second != made_.sides[f]) is_on_line[edge[0]] = is_on_line[edge[1]] = true;
      }
    for (std::uint32_t v = 0; v < is_on_line.size(); ++v)
      if (is_on_line[v]) candidates_.push_back(v);
  }

  // Lines at which bodies meet within are no edges of the outside, and get their vertices here.
  void sample_inner_lines() {
    const std::vector<FeatureEdge> inner = find_lines(scan_).inner;
    if (inner.empty()) return;
    const std::vector<double> length(scan_.mesh.vertices.size(), mean_edge_);
    const FeatureCurves curves = trace_feature_curves(scan_.mesh.vertices, inner, {}, length);
    const double tolerance = line_tolerance * bounding_box(scan_.mesh.vertices).diagonal();
    const auto places = sample_curves(scan_.mesh, curves, length, {.tolerance = tolerance});
    for (std::size_t c = 0; c < places.size(); ++c)
      for (const double place : places[c]) {
        const Vec3 p = curve_point(scan_.mesh, curves.curves[c], place);
        if (std::ranges::any_of(candidates_,
                                [&](std::uint32_t v) { return (made_.mesh.vertices[v] - p).norm() <= near_; }))
          continue;
        candidates_.push_back(add_vertex(p, true));
      }
  }

  void add(const Sheet& sheet, const Progress& progress) {
    SheetSurface of_scan = extract_sheet(scan_, sheet, made_.mesh.vertices, candidates_);
    const auto kept = std::make_shared<const SurfaceMesh>(std::move(of_scan.mesh));
    std::vector<bool> held;
    std::map<std::array<double, 3>, std::uint32_t> vertex_at;
    for (std::size_t v = 0; v < kept->vertices.size(); ++v) {
      const std::uint32_t point = of_scan.point_of_vertex[v];
      held.push_back(point != no_point);
      const Vec3& p = kept->vertices[v];
      if (held.back()) vertex_at[{p.x(), p.y(), p.z()}] = point;
    }
    double border = 0;
    for (const auto& [a, b] : boundary_edges(*kept)) border += (kept->vertices[a] - kept->vertices[b]).norm();
    const double spacing = border / static_cast<double>(std::max<std::size_t>(1, vertex_at.size()));
    SimplifiedSheet made = within_deviation(*kept, held, std::max(spacing, mean_edge_), progress);
    std::vector<std::uint32_t> number;
    for (std::size_t v = 0; v < made.mesh.vertices.size(); ++v) {
      const Vec3& p = made.mesh.vertices[v];
      const auto at = made.on_border[v] ? vertex_at.find({p.x(), p.y(), p.z()}) : vertex_at.end();
      number.push_back(at != vertex_at.end() ? at->second : add_vertex(p, made.on_line[v]));
    }
    for (const Triangle& t : made.mesh.triangles) {
      made_.mesh.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
      made_.sides.push_back(sheet.sides);
    }
    result_.made.push_back({.vertices = std::move(number),
                            .triangles = std::move(made.mesh.triangles),
                            .on_border = std::move(made.on_border),
                            .of_scan = kept,
                            .on_scan = std::move(made.on_scan)});
    ++result_.sheets;
    result_.faces_before += sheet.triangles.size();
    result_.faces_after += result_.made.back().triangles.size();
  }

  // The first sheet that is near enough, or the nearest.
  SimplifiedSheet within_deviation(const SurfaceMesh& sheet, const std::vector<bool>& held, double edge_length,
                                   const Progress& progress) {
    SimplifyOptions options = options_;
    SimplifiedSheet best = first_good(sheet, held, edge_length, options, progress);
    auto* asked = std::get_if<LargestDeviation>(&options.size);
    if (asked == nullptr) return best;
    const DeviationReference reference(sheet);
    const double wanted = asked->distance;
    const auto deviation = [&](const SimplifiedSheet& made) {
      return bound_deviation(made.mesh, reference, {.limit = wanted}).upper();
    };
    double nearest = deviation(best);
    const double enough = asked->required ? wanted : near_enough * wanted;
    for (int trial = 0; trial < more_trials && nearest > enough && progress.may_improve(); ++trial) {
      edge_length *= shortening;
      asked->distance *= shortening * shortening;  // which edges go with the root of
      try {
        SimplifiedSheet made = simplify_sheet(sheet, held, edge_length, options, progress);
        if (const double next = deviation(made); next < nearest) {
          nearest = next;
          best = std::move(made);
        }
      } catch (const NotMeshable&) {
        break;
      }
    }
    if (nearest > wanted && asked->required)
      throw NotMeshable({.what = "the deviation was not reached between two bodies",
                         .where = {},
                         .value = std::to_string(nearest / wanted) + " times as far",
                         .limit = {},
                         .advice = "a larger --deviation, or --faces",
                         .at = sheet.vertices.front()});
    result_.largest_deviation = std::max(result_.largest_deviation, nearest);
    return best;
  }

  // Of another edge length the lattice is another one, and may be better: the first whose triangles are well shaped, or
  // the best of them. A crease of the piece may end where the outside has no vertex.
  static SimplifiedSheet first_good(const SurfaceMesh& sheet, const std::vector<bool>& held, double& edge_length,
                                    SimplifyOptions& options, const Progress& progress) {
    constexpr int trials = 4;
    constexpr double next_shorter = 0.85, good_deg = 25;
    const double longest = edge_length;
    SimplifiedSheet best;
    double best_deg = -1, best_length = longest;
    for (int trial = 0; trial < trials || best_deg < 0; ++trial) {
      if (trial == trials) {
        if (!options.features.angle_deg) break;
        options.features.angle_deg.reset();
        edge_length = longest;
        trial = 0;
      }
      try {
        SimplifiedSheet made = simplify_sheet(sheet, held, edge_length, options, progress);
        const double deg = measure_triangles(made.mesh).min_angle_deg.min;
        if (deg > best_deg) {
          best = std::move(made);
          best_deg = deg;
          best_length = edge_length;
        }
        if (deg >= good_deg || !progress.may_improve()) break;
      } catch (const NotMeshable&) {
        if (best_deg < 0 && trial + 1 == trials && !options.features.angle_deg) throw;
      }
      edge_length *= next_shorter;
    }
    edge_length = best_length;
    return best;
  }

  std::uint32_t add_vertex(const Vec3& p, bool is_held) {
    made_.mesh.vertices.push_back(p);
    is_held_.push_back(is_held);
    return static_cast<std::uint32_t>(made_.mesh.vertices.size() - 1);
  }

  // The last body first: what lies between it and others is then settled.
  void restore_volumes() {
    std::uint32_t bodies = 0;
    for (const Sides& sides : made_.sides) bodies = std::max(bodies, sides.behind + 1);
    for (const Sides& sides : made_.sides)
      if (sides.front != no_body) bodies = std::max(bodies, sides.front + 1);
    for (std::uint32_t b = bodies; b-- > 0;) restore_volume(b);
  }

  // By what lies between it and others, where that bends: then nothing is taken from the outside of all, whose volume
  // is right. Else by its own outside. What is plane stays plane.
  void restore_volume(std::uint32_t body) {
    OwnVertices own = surface_of_body(made_, body);
    const SurfaceMesh like = surface_of_body(scan_, body).mesh;
    std::vector<bool> is_between(made_.mesh.vertices.size(), false);
    for (std::size_t f = 0; f < made_.sides.size(); ++f)
      if (made_.sides[f].front == body || (made_.sides[f].behind == body && made_.sides[f].front != no_body))
        for (const std::uint32_t v : made_.mesh.triangles[f]) is_between[v] = true;
    const std::vector<bool> is_plane = vertices_in_planes(own.mesh);
    const double wanted = enclosed_volume(like);
    for (const bool between : {true, false}) {
      if (std::abs(enclosed_volume(own.mesh) - wanted) <= exact_volume * wanted) break;
      VertexConstraints constraints;
      for (std::size_t v = 0; v < own.of_all.size(); ++v) {
        const std::uint32_t of_complex = own.of_all[v];
        const bool is_free = !is_held_[of_complex] && !is_plane[v] && is_between[of_complex] == between;
        constraints.push_back(is_free ? VertexConstraint::free : VertexConstraint::fixed);
      }
      if (std::ranges::count(constraints, VertexConstraint::free) > 0)
        preserve_volume_clear(own.mesh, like, constraints);
    }
    for (std::size_t v = 0; v < own.of_all.size(); ++v) {
      Vec3& p = made_.mesh.vertices[own.of_all[v]];
      result_.largest_volume_shift = std::max(result_.largest_volume_shift, (p - own.mesh.vertices[v]).norm());
      p = own.mesh.vertices[v];
    }
    for (std::size_t v = 0; v < is_between.size(); ++v)
      if (is_between[v]) is_held_[v] = true;
  }

  void require_clear() const {
    const std::vector<FacePair> crossings = find_self_intersections(made_.mesh);
    if (crossings.empty()) return;
    throw NotMeshable({.what = "surfaces between bodies cross others",
                       .where = {},
                       .value = std::to_string(crossings.size()) + " pairs of triangles",
                       .limit = "none",
                       .advice = "smaller triangles (--deviation, --faces)",
                       .at = centroid(made_.mesh, made_.mesh.triangles[crossings.front().face])});
  }

  const BodyComplex& scan_;
  const SimplifyOptions& options_;
  BodyComplex& made_;
  double near_, mean_edge_;
  std::vector<std::uint32_t> candidates_;  // vertices that may lie on borders of pieces
  std::vector<bool> is_held_;              // per vertex
  InterfaceResult result_;
};

}  // namespace

Outside outside_of(const BodyComplex& scan) {
  std::vector<bool> is_taken(scan.sides.size());
  for (std::size_t f = 0; f < is_taken.size(); ++f) is_taken[f] = scan.sides[f].front == no_body;
  for (const Sheet& sheet : find_sheets(scan))
    if (sheet.is_closed)
      for (const std::uint32_t f : sheet.triangles) is_taken[f] = true;
  Outside outside;
  std::vector<Triangle> triangles;
  for (std::uint32_t f = 0; f < is_taken.size(); ++f) {
    if (!is_taken[f]) continue;
    const Sides& sides = scan.sides[f];
    const auto at = std::find(outside.of_set.begin(), outside.of_set.end(), sides) - outside.of_set.begin();
    if (at == static_cast<std::ptrdiff_t>(outside.of_set.size())) {
      outside.of_set.push_back(sides);
      outside.sets.push_back({mark + std::to_string(at), {}});
    }
    outside.sets[static_cast<std::size_t>(at)].members.push_back(static_cast<std::uint32_t>(triangles.size()));
    triangles.push_back(scan.mesh.triangles[f]);
  }
  outside.mesh = own_vertices(scan.mesh.vertices, std::move(triangles)).mesh;
  return outside;
}

BodyComplex outside_as_made(const Outside& outside, PipelineResult& result) {
  const std::size_t count = result.surface.triangles.size();
  std::vector<Sides> sides(count, outside.of_set.front());
  for (const NamedSet& set : result.face_sets)
    if (const std::size_t s = find_set(outside.sets, set.name); s < outside.sets.size())
      for (const std::uint32_t f : set.members) sides[f] = outside.of_set[s];
  std::erase_if(result.face_sets, [](const NamedSet& set) { return set.name.front() == mark; });
  std::erase_if(result.sets, [](const MadeSet& set) { return set.name.front() == mark; });

  std::vector<std::uint32_t> order(count);
  for (std::uint32_t f = 0; f < count; ++f) order[f] = f;
  std::ranges::stable_partition(order, [&](std::uint32_t f) { return sides[f].front == no_body; });
  BodyComplex made{.mesh = {result.surface.vertices, {}}, .sides = {}, .contacts = {}, .gaps = {}, .touches = {}};
  for (const std::uint32_t f : order) {
    made.mesh.triangles.push_back(result.surface.triangles[f]);
    made.sides.push_back(sides[f]);
  }
  result.face_sets = carried_sets(result.face_sets, order);
  return made;
}

InterfaceResult add_interfaces(const BodyComplex& scan, const SimplifyOptions& options,
                               const std::vector<FeatureEdge>& line_edges, BodyComplex& made,
                               const Progress& progress) {
  return Interfaces(scan, options, line_edges, made).run(progress);
}

TetrahedralizeResult fill_body(const BodyComplex& made, std::uint32_t body, const TetrahedralizeOptions& options,
                               const Progress& progress, TetMesh& mesh) {
  const OwnVertices own = surface_of_body(made, body);
  TetrahedralizeResult filled = tetrahedralize(own.mesh, options, progress);
  std::vector<std::uint32_t> node = own.of_all;
  for (std::size_t n = node.size(); n < filled.mesh.nodes.size(); ++n) {
    node.push_back(static_cast<std::uint32_t>(mesh.nodes.size()));
    mesh.nodes.push_back(filled.mesh.nodes[n]);
  }
  const auto first = static_cast<std::uint32_t>(mesh.tetrahedra.size());
  NamedSet& set = mesh.element_sets.emplace_back();
  for (const Tetrahedron& t : filled.mesh.tetrahedra) {
    set.members.push_back(static_cast<std::uint32_t>(mesh.tetrahedra.size()));
    mesh.tetrahedra.push_back({node[t[0]], node[t[1]], node[t[2]], node[t[3]]});
  }
  // As triangles_of_body lists them.
  std::size_t i = 0;
  for (std::size_t f = 0; f < made.sides.size(); ++f) {
    if (made.sides[f].behind != body && made.sides[f].front != body) continue;
    const BoundaryFace face = filled.mesh.boundary[i++];
    if (made.sides[f].behind == body) mesh.boundary[f] = {first + face.tetrahedron, face.face};
  }
  return filled;
}

}  // namespace scan2fea
