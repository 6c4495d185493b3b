#include "preproc/surface/intersection_removal.hpp"

#include "preproc/surface/adjacency.hpp"
#include "preproc/surface/components.hpp"
#include "preproc/surface/hole_filling.hpp"
#include "preproc/surface/shell_union.hpp"
#include "preproc/surface/soup_adjacency.hpp"
#include "preproc/surface/soup_cleaning.hpp"
#include "quality/self_intersections.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace scan2fea {
namespace {

struct Round {
  int rings;
  PatchShape shape;
};
// Small cuts keep most of the scan, plain patches cross least.
constexpr std::array rounds{Round{1, PatchShape::Faired},    Round{1, PatchShape::Triangles},
                            Round{2, PatchShape::Faired},    Round{2, PatchShape::Triangles},
                            Round{3, PatchShape::Membrane},  Round{4, PatchShape::Triangles},
                            Round{6, PatchShape::Membrane},  Round{8, PatchShape::Triangles},
                            Round{12, PatchShape::Membrane}, Round{16, PatchShape::Triangles}};

std::vector<char> marks_of(const std::vector<FacePair>& pairs, std::size_t face_count) {
  std::vector<char> marks(face_count, 0);
  for (const FacePair& pair : pairs) marks[pair.face] = marks[pair.other] = 1;
  return marks;
}

std::vector<std::uint32_t> vertices_of(const SurfaceMesh& mesh, const std::vector<char>& marks) {
  std::vector<std::uint32_t> vertices;
  for (std::size_t f = 0; f < marks.size(); ++f)
    if (marks[f]) vertices.insert(vertices.end(), mesh.triangles[f].begin(), mesh.triangles[f].end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

// Sets of faces joined by common vertices: of all faces, or only of those whose mark is `only`.
struct Pieces {
  std::vector<std::uint32_t> of_face;
  std::vector<double> area;
};

Pieces find_pieces(const SurfaceMesh& mesh, const std::vector<char>& marks, std::optional<char> only) {
  const auto counts = [&](std::size_t f) { return !only || marks[f] == *only; };
  SurfaceMesh part{mesh.vertices, {}};
  for (std::size_t f = 0; f < marks.size(); ++f)
    if (counts(f)) part.triangles.push_back(mesh.triangles[f]);
  const Components components = find_components(part);
  Pieces pieces;
  pieces.of_face.assign(marks.size(), 0);
  std::vector<std::uint32_t> number(components.count, no_face);
  for (std::uint32_t f = 0; f < marks.size(); ++f) {
    if (!counts(f)) continue;
    std::uint32_t& n = number[components.of_vertex[mesh.triangles[f][0]]];
    if (n == no_face) {
      n = static_cast<std::uint32_t>(pieces.area.size());
      pieces.area.push_back(0);
    }
    pieces.of_face[f] = n;
    pieces.area[n] += area_of(mesh, f);
  }
  return pieces;
}

Vec3 centre_of_ring(const SurfaceMesh& mesh, const VertexStars& stars, std::uint32_t v) {
  Vec3 sum = Vec3::Zero();
  const auto corners = stars.corners(v);
  for (const std::uint32_t corner : corners) sum += mesh.vertices[end_vertex(mesh, corner)];
  return sum / static_cast<double>(corners.size());
}

// Folds of a noisy scan come undone by a little smoothing, and no face is lost: vertices of intersecting faces move
// half way to the means of their neighbours until their faces are clear, no farther than an edge or a hundredth of the
// surface's diagonal, beyond which the shape would change.
void smooth_folds(SurfaceMesh& mesh, std::vector<FacePair>& pairs, RepairResult& result) {
  constexpr int most_sweeps = 20;
  constexpr int sweeps_without_gain = 3;
  const std::vector<Vec3> before = mesh.vertices;
  const VertexStars stars(mesh);
  const double reach = 0.01 * bounding_box(mesh.vertices).diagonal();
  const auto mean_edge = [&](std::uint32_t v) {
    double sum = 0;
    for (const std::uint32_t corner : stars.corners(v)) sum += (before[end_vertex(mesh, corner)] - before[v]).norm();
    return sum / static_cast<double>(stars.corners(v).size());
  };
  std::size_t fewest = pairs.size();
  for (int sweep = 0, since = 0; sweep < most_sweeps && since < sweeps_without_gain && !pairs.empty(); ++sweep) {
    std::vector<char> at_moved(mesh.triangles.size(), 0);
    for (const std::uint32_t v : vertices_of(mesh, marks_of(pairs, mesh.triangles.size()))) {
      const Vec3 move = (mesh.vertices[v] + centre_of_ring(mesh, stars, v)) / 2 - before[v];
      const double limit = std::min(reach, mean_edge(v));
      mesh.vertices[v] = before[v] + move * std::min(1.0, limit / std::max(move.norm(), limit));
      for (const std::uint32_t corner : stars.corners(v)) at_moved[corner / 3] = 1;
    }
    std::vector<std::uint32_t> to_check;
    for (std::uint32_t f = 0; f < at_moved.size(); ++f)
      if (at_moved[f]) to_check.push_back(f);
    pairs = find_self_intersections(mesh, to_check);
    since = pairs.size() < fewest ? 0 : since + 1;
    fewest = std::min(fewest, pairs.size());
  }
  for (std::size_t v = 0; v < before.size(); ++v)
    if (mesh.vertices[v] != before[v])
      result.changes.push_back({RepairKind::SmoothedFold, before[v], (mesh.vertices[v] - before[v]).norm()});
}

// Copies of one place, in faces that intersect, move towards their rings. Returns whether any did.
bool part_touching_vertices(SurfaceMesh& mesh, const std::vector<char>& intersecting, RepairResult& result) {
  constexpr double fraction = 0.01;
  std::vector<std::uint32_t> candidates = vertices_of(mesh, intersecting);
  const auto less = [&](std::uint32_t a, std::uint32_t b) {
    const Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b];
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  };
  std::stable_sort(candidates.begin(), candidates.end(), less);

  const VertexStars stars(mesh);
  std::vector<std::pair<std::uint32_t, Vec3>> moves;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const bool touches = (i > 0 && !less(candidates[i - 1], candidates[i])) ||
                         (i + 1 < candidates.size() && !less(candidates[i], candidates[i + 1]));
    if (!touches) continue;
    const std::uint32_t v = candidates[i];
    moves.emplace_back(v, fraction * (centre_of_ring(mesh, stars, v) - mesh.vertices[v]));
  }
  for (const auto& [v, move] : moves) {
    result.changes.push_back({RepairKind::PartedTouch, mesh.vertices[v], move.norm()});
    mesh.vertices[v] += move;
  }
  return !moves.empty();
}

void grow(const SurfaceMesh& mesh, std::vector<char>& marks, int rings) {
  std::vector<char> at_vertex(mesh.vertices.size());
  for (int ring = 0; ring < rings; ++ring) {
    std::fill(at_vertex.begin(), at_vertex.end(), 0);
    for (std::size_t f = 0; f < marks.size(); ++f)
      if (marks[f])
        for (const std::uint32_t v : mesh.triangles[f]) at_vertex[v] = 1;
    for (std::size_t f = 0; f < marks.size(); ++f)
      for (const std::uint32_t v : mesh.triangles[f]) marks[f] |= at_vertex[v];
  }
}

// Of each shell that is cut the largest piece stays, and others where they have more area than the cut.
void mark_islands(const SurfaceMesh& mesh, std::vector<char>& marks) {
  const Pieces shells = find_pieces(mesh, marks, std::nullopt);
  const Pieces pieces = find_pieces(mesh, marks, 0);
  std::vector<double> cut_area(shells.area.size(), 0), largest(shells.area.size(), 0);
  for (std::uint32_t f = 0; f < marks.size(); ++f) {
    const std::uint32_t shell = shells.of_face[f];
    if (marks[f])
      cut_area[shell] += area_of(mesh, f);
    else
      largest[shell] = std::max(largest[shell], pieces.area[pieces.of_face[f]]);
  }
  for (std::uint32_t f = 0; f < marks.size(); ++f) {
    if (marks[f]) continue;
    const double area = pieces.area[pieces.of_face[f]];
    const std::uint32_t shell = shells.of_face[f];
    if (area < largest[shell] && area < cut_area[shell]) marks[f] = 1;
  }
}

void log_cuts(const SurfaceMesh& mesh, const std::vector<char>& marks, RepairResult& result) {
  const Pieces cuts = find_pieces(mesh, marks, 1);
  std::vector<Vec3> weighted(cuts.area.size(), Vec3::Zero());
  std::vector<Vec3> any(cuts.area.size(), Vec3::Zero());
  for (std::uint32_t f = 0; f < marks.size(); ++f)
    if (marks[f]) {
      weighted[cuts.of_face[f]] += area_of(mesh, f) * centre_of(mesh, f);
      any[cuts.of_face[f]] = centre_of(mesh, f);
    }
  for (std::size_t i = 0; i < cuts.area.size(); ++i)
    result.changes.push_back(
        {RepairKind::Intersection, cuts.area[i] > 0 ? Vec3(weighted[i] / cuts.area[i]) : any[i], cuts.area[i]});
}

// Faces at edges of more than two faces: a patch may have met another one.
void mark_non_manifold(const SurfaceMesh& mesh, std::vector<char>& marks) {
  EdgeGroups(mesh).for_each([&](const std::uint32_t* first, const std::uint32_t* last) {
    if (last - first > 2)
      for (const std::uint32_t* h = first; h != last; ++h) marks[*h / 3] = 1;
  });
}

}  // namespace

IntersectionRemoval remove_intersections(SurfaceMesh& mesh, RepairResult& result, const Progress& progress) {
  std::vector<FacePair> pairs = find_self_intersections(mesh);
  result.intersecting_pairs = pairs.size();
  if (!pairs.empty() && unite_shells(mesh, pairs, result)) pairs = find_self_intersections(mesh);
  if (!pairs.empty() && part_touching_vertices(mesh, marks_of(pairs, mesh.triangles.size()), result))
    pairs = find_self_intersections(mesh);
  if (!pairs.empty()) smooth_folds(mesh, pairs, result);

  IntersectionRemoval removal;
  std::size_t faces_of_input = mesh.triangles.size();  // they come first, patches after them
  for (std::size_t i = 0;; ++i) {
    std::vector<char> marks = marks_of(pairs, mesh.triangles.size());
    mark_non_manifold(mesh, marks);
    const bool sound = std::find(marks.begin(), marks.end(), 1) == marks.end();
    if (!sound && i == rounds.size()) removal.remaining = std::max<std::size_t>(1, pairs.size());
    if (sound || i == rounds.size()) return removal;
    progress("remove self-intersections", static_cast<double>(i) / rounds.size());

    grow(mesh, marks, rounds[i].rings);
    mark_islands(mesh, marks);
    log_cuts(mesh, marks, result);
    std::size_t gone = 0;
    for (std::uint32_t f = 0; f < faces_of_input; ++f)
      if (marks[f]) removal.area_cut += area_of(mesh, f), ++gone;
    faces_of_input -= gone;
    remove_faces(mesh, marks, result);
    RepairResult of_the_cut;  // vertices split where the cut's rim touches itself: nothing to report
    const Twins twins = make_manifold(mesh, of_the_cut);
    result.faces_removed += of_the_cut.faces_removed;
    const std::size_t kept = mesh.triangles.size();
    for (const BorderLoop& loop : find_border_loops(mesh, twins)) fill_hole(mesh, twins, loop, rounds[i].shape);
    result.faces_added += mesh.triangles.size() - kept;

    std::vector<std::uint32_t> patches(mesh.triangles.size() - kept);
    std::iota(patches.begin(), patches.end(), static_cast<std::uint32_t>(kept));
    pairs = find_self_intersections(mesh, patches);
  }
}

}  // namespace scan2fea
