#include "preproc/surface/repair/intersection_removal.hpp"

#include "preproc/mesh/union_find.hpp"
#include "preproc/surface/repair/border_stitching.hpp"
#include "preproc/surface/repair/crossing_union.hpp"
#include "preproc/surface/repair/degenerate_faces.hpp"
#include "preproc/surface/repair/face_marks.hpp"
#include "preproc/surface/repair/fold_smoothing.hpp"
#include "preproc/surface/repair/hole_filling.hpp"
#include "preproc/surface/repair/repeated_shells.hpp"
#include "preproc/surface/repair/soup_adjacency.hpp"
#include "quality/self_intersections.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

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

// Of each shell that is cut the largest piece stays, and others where they have more area than the cut.
void mark_islands(const SurfaceMesh& mesh, FaceMarks& marks) {
  const FacePieces shells = find_pieces(mesh, marks, std::nullopt);
  const FacePieces pieces = find_pieces(mesh, marks, 0);
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

void log_cuts(const SurfaceMesh& mesh, const FaceMarks& marks, RepairResult& result) {
  const FacePieces cuts = find_pieces(mesh, marks, 1);
  std::vector<Vec3> weighted(cuts.area.size(), Vec3::Zero());
  std::vector<Vec3> any(cuts.area.size(), Vec3::Zero());
  for (std::uint32_t f = 0; f < marks.size(); ++f)
    if (marks[f]) {
      weighted[cuts.of_face[f]] += area_of(mesh, f) * centre_of(mesh, f);
      any[cuts.of_face[f]] = centre_of(mesh, f);
    }
  for (std::size_t i = 0; i < cuts.area.size(); ++i)
    result.changes.push_back({RepairKind::Intersection, cuts.area[i] > 0 ? Vec3(weighted[i] / cuts.area[i]) : any[i],
                              cuts.area[i], cuts.area[i]});
}

// The border edges of a surface, to be known again by their places when the indices are others.
class Borders {
 public:
  explicit Borders(const SurfaceMesh& mesh) {
    const Twins twins = find_twins(mesh);
    for (std::uint32_t h = 0; h < twins.size(); ++h)
      if (twins[h] == no_twin) edges_.push_back(key(mesh, h));
    std::sort(edges_.begin(), edges_.end());
  }
  bool empty() const { return edges_.empty(); }
  bool share_an_edge(const SurfaceMesh& mesh, const BorderLoop& loop) const {
    return std::any_of(loop.begin(), loop.end(),
                       [&](std::uint32_t h) { return std::binary_search(edges_.begin(), edges_.end(), key(mesh, h)); });
  }

 private:
  using Key = std::array<double, 6>;
  static Key key(const SurfaceMesh& mesh, std::uint32_t h) {
    const Vec3 &a = mesh.vertices[start_vertex(mesh, h)], &b = mesh.vertices[end_vertex(mesh, h)];
    return {a[0], a[1], a[2], b[0], b[1], b[2]};
  }
  std::vector<Key> edges_;
};

// Faces at edges of more than two faces: a patch may have met another one.
void mark_non_manifold(const SurfaceMesh& mesh, FaceMarks& marks) {
  EdgeGroups(mesh).for_each([&](const std::uint32_t* first, const std::uint32_t* last) {
    if (last - first > 2)
      for (const std::uint32_t* h = first; h != last; ++h) marks[*h / 3] = 1;
  });
}

void fill(SurfaceMesh& mesh, const Twins& twins, const std::vector<BorderLoop>& loops, PatchShape shape,
          RepairResult& result) {
  const std::size_t before = mesh.triangles.size();
  for (const BorderLoop& loop : loops) append_patch(mesh, make_patch(mesh, twins, loop, shape));
  result.faces_added += mesh.triangles.size() - before;
}

// Unites what crosses in some of the pairs, which all become those of the surface of the union, with one fan of faces
// per vertex. Slivers as narrow as rounding may be missing from it, and are filled in; where more is missing there is
// no union.
void unite(SurfaceMesh& mesh, std::vector<FacePair>& pairs, std::span<const FacePair> of_them, Crossings which,
           RepairResult& result, const Progress& progress) {
  constexpr double most_filled_of_area = 1e-6;
  SurfaceMesh united = mesh;
  RepairResult of_the_union;
  if (!unite_crossings(united, of_them, which, of_the_union, progress)) return;
  RepairResult of_its_rounding;  // what follows from it: nothing to report
  stitch_borders(united, of_its_rounding);
  const Twins twins = make_manifold(united, of_its_rounding);
  const double open_area = surface_area(united);
  fill(united, twins, find_border_loops(united, twins), PatchShape::Triangles, of_the_union);
  if (surface_area(united) - open_area > most_filled_of_area * open_area) return;
  make_manifold(united, of_its_rounding);
  mend_degenerate_faces(united, of_its_rounding);
  if (!Borders(united).empty()) return;
  mesh = std::move(united);
  pairs = find_self_intersections(mesh);
  result.changes.insert(result.changes.end(), of_the_union.changes.begin(), of_the_union.changes.end());
  result.faces_added += of_the_union.faces_added;
  result.faces_removed += of_the_union.faces_removed + of_its_rounding.faces_removed;
}

// The pairs of crossings that cut whole faces off the rest of their shell, as where a tube passes through itself. Folds
// of noise, which smoothing undoes without the loss of a face, are no deeper than the faces that cross.
std::vector<FacePair> deep_crossings(const SurfaceMesh& mesh, std::vector<FacePair> pairs) {
  const FaceMarks marks = marks_of(pairs, mesh.triangles.size());
  const FacePieces shells = find_pieces(mesh, marks, std::nullopt);
  const FacePieces rest = find_pieces(mesh, marks, 0);
  const FacePieces crossing = find_pieces(mesh, marks, 1);
  std::vector<double> largest(shells.area.size(), 0);
  for (std::uint32_t f = 0; f < marks.size(); ++f)
    if (!marks[f]) largest[shells.of_face[f]] = std::max(largest[shells.of_face[f]], rest.area[rest.of_face[f]]);
  std::vector<char> of_island(mesh.vertices.size(), 0), deep(crossing.area.size(), 0);
  for (std::uint32_t f = 0; f < marks.size(); ++f)
    if (!marks[f] && rest.area[rest.of_face[f]] < largest[shells.of_face[f]])
      for (const std::uint32_t v : mesh.triangles[f]) of_island[v] = 1;

  UnionFind joined(crossing.area.size());
  for (const FacePair& pair : pairs) joined.unite(crossing.of_face[pair.face], crossing.of_face[pair.other]);
  for (std::uint32_t f = 0; f < marks.size(); ++f)
    for (const std::uint32_t v : mesh.triangles[f])
      if (marks[f] && of_island[v]) deep[joined.find(crossing.of_face[f])] = 1;
  std::erase_if(pairs, [&](const FacePair& pair) { return !deep[joined.find(crossing.of_face[pair.face])]; });
  return pairs;
}

}  // namespace

IntersectionRemoval remove_intersections(SurfaceMesh& mesh, RepairResult& result, const Progress& progress) {
  std::vector<FacePair> pairs = find_self_intersections(mesh);
  result.intersecting_pairs = pairs.size();
  if (pairs.empty()) return {};
  const bool closed = Borders(mesh).empty();
  if (closed && drop_repeated_shells(mesh, pairs, result)) pairs = find_self_intersections(mesh);
  if (closed && !pairs.empty()) unite(mesh, pairs, pairs, Crossings::between_shells, result, progress);
  if (!pairs.empty() && part_touching_shells(mesh, pairs, result)) pairs = find_self_intersections(mesh);
  if (!pairs.empty() && part_touching_vertices(mesh, pairs, result)) pairs = find_self_intersections(mesh);
  if (closed && !pairs.empty())
    unite(mesh, pairs, deep_crossings(mesh, pairs), Crossings::within_shells, result, progress);
  if (!pairs.empty()) pairs = smooth_folds(mesh, std::move(pairs), result);
  if (closed && !pairs.empty()) unite(mesh, pairs, pairs, Crossings::within_shells, result, progress);

  IntersectionRemoval removal;
  std::size_t faces_of_input = mesh.triangles.size();  // they come first, patches after them
  for (std::size_t i = 0;; ++i) {
    FaceMarks marks = marks_of(pairs, mesh.triangles.size());
    mark_non_manifold(mesh, marks);
    const bool sound = std::find(marks.begin(), marks.end(), 1) == marks.end();
    if (!sound && i == rounds.size()) removal.remaining = std::max<std::size_t>(1, pairs.size());
    if (sound || i == rounds.size()) return removal;
    progress("remove self-intersections", static_cast<double>(i) / rounds.size());

    grow(mesh, marks, rounds[i].rings);
    mark_islands(mesh, marks);
    log_cuts(mesh, marks, result);
    const Borders borders(mesh);
    std::size_t gone = 0;
    for (std::uint32_t f = 0; f < faces_of_input; ++f)
      if (marks[f]) removal.area_cut += area_of(mesh, f), ++gone;
    faces_of_input -= gone;
    remove_faces(mesh, marks, result);
    RepairResult of_the_cut;  // vertices split where the cut's rim touches itself: nothing to report
    const Twins twins = make_manifold(mesh, of_the_cut);
    result.faces_removed += of_the_cut.faces_removed;
    const std::size_t kept = mesh.triangles.size();
    std::vector<BorderLoop> loops = find_border_loops(mesh, twins);
    const bool border_recedes =
        std::erase_if(loops, [&](const BorderLoop& loop) { return borders.share_an_edge(mesh, loop); }) > 0;
    fill(mesh, twins, loops, rounds[i].shape, result);

    if (border_recedes) {  // and leaves bare the vertices that were split, where old faces now touch one another
      pairs = find_self_intersections(mesh);
    } else {
      std::vector<std::uint32_t> patches(mesh.triangles.size() - kept);
      std::iota(patches.begin(), patches.end(), static_cast<std::uint32_t>(kept));
      pairs = find_self_intersections(mesh, patches);
    }
  }
}

}  // namespace scan2fea
