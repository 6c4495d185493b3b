#include "preproc/surface/repair/fold_smoothing.hpp"

#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/clear_moves.hpp"
#include "preproc/surface/repair/face_marks.hpp"
#include "preproc/surface/repair/shells.hpp"
#include "preproc/surface/repair/soup_adjacency.hpp"

#include <algorithm>

namespace scan2fea {
namespace {

constexpr double parted_by_of_diagonal = 1e-6;

Vec3 centre_of_ring(const SurfaceMesh& mesh, const VertexStars& stars, std::uint32_t v) {
  Vec3 sum = Vec3::Zero();
  const auto corners = stars.corners(v);
  for (const std::uint32_t corner : corners) sum += mesh.vertices[end_vertex(mesh, corner)];
  return sum / static_cast<double>(corners.size());
}

// Puts back the folds, connected sets of the faces marked, that kept more than half of their pairs. Returns whether
// there were any.
bool put_back_folds(SurfaceMesh& mesh, const std::vector<Vec3>& before, const FaceMarks& moved,
                    const std::vector<FacePair>& pairs_before, const std::vector<FacePair>& pairs_left) {
  if (pairs_left.empty()) return false;
  const FacePieces folds = find_pieces(mesh, moved, 1);
  std::vector<std::ptrdiff_t> too_many(folds.area.size(), 0);  // pairs left, less half of those before
  for (const FacePair& pair : pairs_before) too_many[folds.of_face[pair.face]] -= 1;
  for (const FacePair& pair : pairs_left) too_many[folds.of_face[pair.face]] += 2;
  FaceMarks failed(moved.size(), 0);
  for (std::size_t f = 0; f < moved.size(); ++f) failed[f] = moved[f] && too_many[folds.of_face[f]] > 0;
  const std::vector<std::uint32_t> vertices = vertices_of(mesh, failed);
  for (const std::uint32_t v : vertices) mesh.vertices[v] = before[v];
  return !vertices.empty();
}

}  // namespace

bool part_touching_shells(SurfaceMesh& mesh, const std::vector<FacePair>& pairs, RepairResult& result) {
  const std::vector<Shell> shells = find_shells(mesh);
  const std::vector<std::uint32_t> shell_of_face = shell_of_faces(shells, mesh.triangles.size());
  std::vector<Vec3> away(shells.size(), Vec3::Zero());
  for (const FacePair& pair : pairs) {
    const std::uint32_t a = shell_of_face[pair.face], b = shell_of_face[pair.other];
    if (a == b) continue;
    const Vec3 apart = centre_of(mesh, pair.face) - centre_of(mesh, pair.other);
    if (shells[a].area < shells[b].area)
      away[a] += apart;
    else
      away[b] -= apart;
  }
  bool any = false;
  const double distance = parted_by_of_diagonal * bounding_box(mesh.vertices).diagonal();
  for (std::uint32_t s = 0; s < shells.size(); ++s) {
    if (away[s].isZero()) continue;
    FaceMarks marks(mesh.triangles.size(), 0);
    for (const std::uint32_t f : shells[s].faces) marks[f] = 1;
    const std::vector<std::uint32_t> vertices = vertices_of(mesh, marks);
    const std::vector<Vec3> before = mesh.vertices;
    for (const std::uint32_t v : vertices) mesh.vertices[v] += distance * away[s].normalized();
    const std::vector<FacePair> left = find_self_intersections(mesh, shells[s].faces);
    if (std::any_of(left.begin(), left.end(), [&](const FacePair& p) { return marks[p.face] != marks[p.other]; })) {
      mesh.vertices = before;
      continue;
    }
    any = true;
    result.changes.push_back({RepairKind::PartedTouch, (shells[s].box.low + shells[s].box.high) / 2, distance});
  }
  return any;
}

bool part_touching_vertices(SurfaceMesh& mesh, const std::vector<FacePair>& pairs, RepairResult& result) {
  constexpr double most_of_ring = 0.01;  // of small faces
  std::vector<std::uint32_t> candidates = vertices_of(mesh, marks_of(pairs, mesh.triangles.size()));
  const auto less = [&](std::uint32_t a, std::uint32_t b) {
    const Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b];
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  };
  std::stable_sort(candidates.begin(), candidates.end(), less);

  const double distance = parted_by_of_diagonal * bounding_box(mesh.vertices).diagonal();
  const VertexStars stars(mesh);
  std::vector<std::pair<std::uint32_t, Vec3>> moves;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const bool touches = (i > 0 && !less(candidates[i - 1], candidates[i])) ||
                         (i + 1 < candidates.size() && !less(candidates[i], candidates[i + 1]));
    if (!touches) continue;
    const std::uint32_t v = candidates[i];
    const Vec3 to_centre = centre_of_ring(mesh, stars, v) - mesh.vertices[v];
    moves.emplace_back(v, to_centre * std::min(most_of_ring, distance / std::max(to_centre.norm(), distance)));
  }
  for (const auto& [v, move] : moves) {
    result.changes.push_back({RepairKind::PartedTouch, mesh.vertices[v], move.norm()});
    mesh.vertices[v] += move;
  }
  return !moves.empty();
}

std::vector<FacePair> smooth_folds(SurfaceMesh& mesh, std::vector<FacePair> pairs, RepairResult& result) {
  constexpr int most_sweeps = 20;
  constexpr int sweeps_without_gain = 3;
  constexpr int sweeps_back = 8;
  const std::vector<Vec3> before = mesh.vertices;
  const VertexStars stars(mesh);
  const double reach = 0.01 * bounding_box(mesh.vertices).diagonal();
  const auto mean_edge = [&](std::uint32_t v) {
    double sum = 0;
    for (const std::uint32_t corner : stars.corners(v)) sum += (before[end_vertex(mesh, corner)] - before[v]).norm();
    return sum / static_cast<double>(stars.corners(v).size());
  };
  const std::vector<FacePair> pairs_before = pairs;
  FaceMarks moved(mesh.triangles.size(), 0);
  std::size_t fewest = pairs.size();
  for (int sweep = 0, since = 0; sweep < most_sweeps && since < sweeps_without_gain && !pairs.empty(); ++sweep) {
    FaceMarks moved_now(mesh.triangles.size(), 0);
    for (const std::uint32_t v : vertices_of(mesh, marks_of(pairs, mesh.triangles.size()))) {
      const Vec3 move = (mesh.vertices[v] + centre_of_ring(mesh, stars, v)) / 2 - before[v];
      const double limit = std::min(reach, mean_edge(v));
      mesh.vertices[v] = before[v] + move * std::min(1.0, limit / std::max(move.norm(), limit));
      for (const std::uint32_t corner : stars.corners(v)) moved_now[corner / 3] = moved[corner / 3] = 1;
    }
    std::vector<std::uint32_t> to_check;
    for (std::uint32_t f = 0; f < moved_now.size(); ++f)
      if (moved_now[f]) to_check.push_back(f);
    pairs = find_self_intersections(mesh, to_check);
    since = pairs.size() < fewest ? 0 : since + 1;
    fewest = std::min(fewest, pairs.size());
  }
  if (put_back_folds(mesh, before, moved, pairs_before, pairs)) pairs = find_self_intersections(mesh);
  if (pairs.empty()) move_clear(mesh, before, sweeps_back);
  for (std::size_t v = 0; v < before.size(); ++v)
    if (mesh.vertices[v] != before[v])
      result.changes.push_back({RepairKind::SmoothedFold, before[v], (mesh.vertices[v] - before[v]).norm()});
  return pairs;
}

}  // namespace scan2fea
