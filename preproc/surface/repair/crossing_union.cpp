#include "preproc/surface/repair/crossing_union.hpp"

#include "preproc/mesh/union_find.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/components.hpp"
#include "preproc/surface/repair/arrangement.hpp"
#include "preproc/surface/repair/face_marks.hpp"
#include "preproc/surface/repair/shells.hpp"
#include "preproc/surface/repair/sides_of_pieces.hpp"
#include "quality/validity.hpp"

#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace scan2fea {
namespace {

// Where the faces of one shell cross more of its others than this each, sheets lie in a tangle that tells no inside
// from outside, and that takes long to arrange. A tube through itself has two or three; of two shells whose flat ends
// touch the fans of triangles there meet all to all.
constexpr std::size_t most_pairs_a_face = 8;

// Shells that cross one another, and the pairs in which they do.
struct CrossingSet {
  std::vector<std::size_t> shells;
  std::vector<FacePair> pairs;
  std::vector<FacePair> own_pairs;  // in which one of them crosses itself, where others are wanted
};

bool is_tangle(const std::vector<FacePair>& pairs) {
  std::vector<std::uint32_t> faces;
  for (const FacePair& pair : pairs) faces.insert(faces.end(), {pair.face, pair.other});
  std::sort(faces.begin(), faces.end());
  const auto last = std::unique(faces.begin(), faces.end());
  return pairs.size() > most_pairs_a_face * static_cast<std::size_t>(last - faces.begin());
}

std::vector<CrossingSet> find_sets(const SurfaceMesh& mesh, const std::vector<Shell>& shells,
                                   std::span<const FacePair> pairs, Crossings which) {
  const std::vector<std::uint32_t> shell_of_face = shell_of_faces(shells, mesh.triangles.size());
  std::vector<FacePair> wanted, others;
  UnionFind joined(shells.size());
  for (const FacePair& pair : pairs) {
    const std::uint32_t a = shell_of_face[pair.face], b = shell_of_face[pair.other];
    const bool is_wanted = (a != b) == (which == Crossings::between_shells);
    (is_wanted ? wanted : others).push_back(pair);
    if (is_wanted) joined.unite(a, b);
  }
  std::vector<CrossingSet> by_root(shells.size());
  for (const FacePair& pair : wanted) by_root[joined.find(shell_of_face[pair.face])].pairs.push_back(pair);
  if (which == Crossings::between_shells)
    for (const FacePair& pair : others) by_root[joined.find(shell_of_face[pair.face])].own_pairs.push_back(pair);
  for (std::uint32_t s = 0; s < shells.size(); ++s) by_root[joined.find(s)].shells.push_back(s);
  std::erase_if(by_root, [](const CrossingSet& set) {
    return set.pairs.empty() || (set.shells.size() == 1 && is_tangle(set.pairs));
  });
  return by_root;
}

// The faces of some shells as a surface of their own.
struct Part {
  SurfaceMesh mesh;
  std::vector<std::uint32_t> vertex, face;  // of the whole, for each of its own
  std::vector<FacePair> pairs, own_pairs;
};

Part take_part(const SurfaceMesh& mesh, const std::vector<Shell>& shells, const CrossingSet& set) {
  Part part;
  for (const std::size_t s : set.shells)
    part.face.insert(part.face.end(), shells[s].faces.begin(), shells[s].faces.end());
  std::sort(part.face.begin(), part.face.end());
  for (const std::uint32_t f : part.face)
    part.vertex.insert(part.vertex.end(), mesh.triangles[f].begin(), mesh.triangles[f].end());
  std::sort(part.vertex.begin(), part.vertex.end());
  part.vertex.erase(std::unique(part.vertex.begin(), part.vertex.end()), part.vertex.end());
  const auto index = [](const std::vector<std::uint32_t>& in, std::uint32_t i) {
    return static_cast<std::uint32_t>(std::lower_bound(in.begin(), in.end(), i) - in.begin());
  };
  for (const std::uint32_t v : part.vertex) part.mesh.vertices.push_back(mesh.vertices[v]);
  for (const std::uint32_t f : part.face) {
    Triangle t = mesh.triangles[f];
    for (std::uint32_t& v : t) v = index(part.vertex, v);
    part.mesh.triangles.push_back(t);
  }
  for (const FacePair& pair : set.pairs)
    part.pairs.push_back({index(part.face, pair.face), index(part.face, pair.other)});
  for (const FacePair& pair : set.own_pairs)
    part.own_pairs.push_back({index(part.face, pair.face), index(part.face, pair.other)});
  return part;
}

// Within this distance things count as being in the same place: four steps of 32-bit floats, as which most files store
// coordinates. Solids that touch along faces touch within such steps wherever they lie in space.
double tolerance_of(const SurfaceMesh& mesh) {
  return 2 * std::numeric_limits<float>::epsilon() * bounding_box(mesh.vertices).diagonal();
}

// Adds pairs of faces of different shells that lie in one plane within the tolerance, whether they cross or not.
void add_contacts(Part& part) {
  using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;
  const SurfaceMesh& mesh = part.mesh;
  const double tolerance = tolerance_of(mesh);
  const Components shells = find_components(mesh);
  std::vector<Box> boxes;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 low = a.cwiseMin(b).cwiseMin(c).array() - tolerance,
               high = a.cwiseMax(b).cwiseMax(c).array() + tolerance;
    boxes.emplace_back(CGAL::Bbox_3(low.x(), low.y(), low.z(), high.x(), high.y(), high.z()), f);
  }
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
    const std::uint32_t f = std::min(a.info(), b.info()), g = std::max(a.info(), b.info());
    const bool apart = shells.of_vertex[mesh.triangles[f][0]] != shells.of_vertex[mesh.triangles[g][0]];
    if (apart && lie_in_one_plane(mesh, f, g, tolerance)) part.pairs.push_back({f, g});
  });
  std::sort(part.pairs.begin(), part.pairs.end());
  part.pairs.erase(std::unique(part.pairs.begin(), part.pairs.end()), part.pairs.end());
}

// Pairs that are one crossing, since their faces are the same or share a vertex: a number for each face of a pair.
std::vector<std::uint32_t> number_crossings(const Part& part) {
  UnionFind joined(part.mesh.triangles.size());
  std::vector<std::uint32_t> at_vertex(part.mesh.vertices.size(), no_face);
  for (const FacePair& pair : part.pairs) {
    joined.unite(pair.face, pair.other);
    for (const std::uint32_t f : {pair.face, pair.other})
      for (const std::uint32_t v : part.mesh.triangles[f]) {
        if (at_vertex[v] != no_face) joined.unite(at_vertex[v], f);
        at_vertex[v] = f;
      }
  }
  std::vector<std::uint32_t> number(part.mesh.triangles.size());
  for (std::uint32_t f = 0; f < number.size(); ++f) number[f] = joined.find(f);
  return number;
}

// Vertices that rounding alone keeps apart become one.
void join_close_vertices(Arrangement& arrangement) {
  SurfaceMesh& mesh = arrangement.mesh;
  const double close = rounding_of(mesh);
  UnionFind joined(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      if ((mesh.vertices[a] - mesh.vertices[b]).norm() < close) joined.unite(a, b);
    }
  std::size_t kept = 0;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    Triangle t = mesh.triangles[f];
    for (std::uint32_t& v : t) v = joined.find(v);
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    mesh.triangles[kept] = t;
    arrangement.face_of[kept++] = arrangement.face_of[f];
  }
  mesh.triangles.resize(kept);
  arrangement.face_of.resize(kept);
}

// Leaves one of the triangles on the same three vertices, that of the first face. Returns whether any went.
bool leave_one_of_each(Arrangement& arrangement) {
  std::vector<std::pair<Triangle, std::uint32_t>> sorted;
  for (std::uint32_t f = 0; f < arrangement.mesh.triangles.size(); ++f) {
    sorted.emplace_back(arrangement.mesh.triangles[f], f);
    std::sort(sorted[f].first.begin(), sorted[f].first.end());
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<char> again(sorted.size(), 0);
  for (std::size_t i = 1; i < sorted.size(); ++i) again[sorted[i].second] = sorted[i].first == sorted[i - 1].first;
  std::size_t left = 0;
  for (std::size_t f = 0; f < again.size(); ++f) {
    if (again[f]) continue;
    arrangement.mesh.triangles[left] = arrangement.mesh.triangles[f];
    arrangement.face_of[left++] = arrangement.face_of[f];
  }
  arrangement.mesh.triangles.resize(left);
  arrangement.face_of.resize(left);
  return left < again.size();
}

struct Union {
  Arrangement arrangement;
  std::vector<char> kept;  // per triangle of it
};

// Leaves out crossings beyond which a surface is inside out, if it must not be. Nothing where none is left.
std::optional<Union> unite(Part part, bool may_be_inside_out, double tolerance, const Progress& progress) {
  const std::vector<std::uint32_t> crossing = number_crossings(part);
  while (!part.pairs.empty()) {
    std::optional<Arrangement> arranged = arrange(part.mesh, part.pairs, tolerance, progress);
    if (!arranged) return {};
    Union made{std::move(*arranged), {}};
    join_close_vertices(made.arrangement);
    SurfaceMesh& mesh = made.arrangement.mesh;
    bool changed = leave_one_of_each(made.arrangement);
    made.kept.assign(mesh.triangles.size(), 0);
    const std::vector<Sides> sides = find_sides(part.mesh, made.arrangement);
    std::vector<char> inside_out(part.mesh.triangles.size(), 0);  // by crossing
    std::vector<char> crossed = marks_of(part.pairs, part.mesh.triangles.size());
    for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
      const Sides& of_piece = sides[f];
      const std::uint32_t face = made.arrangement.face_of[f];
      if (std::min(of_piece.outside, of_piece.inside) < 0 && crossed[face]) inside_out[crossing[face]] = 1;
      if (!of_piece.first || (of_piece.outside > 0) == (of_piece.inside > 0)) continue;
      made.kept[f] = 1;
      if (of_piece.outside > 0) std::swap(mesh.triangles[f][1], mesh.triangles[f][2]);
    }
    changed |= std::find(made.kept.begin(), made.kept.end(), 0) != made.kept.end();
    if (!changed) return {};  // they only touch
    if (may_be_inside_out || std::find(inside_out.begin(), inside_out.end(), 1) == inside_out.end()) return made;
    std::erase_if(part.pairs, [&](const FacePair& pair) { return inside_out[crossing[pair.face]] != 0; });
  }
  return {};
}

SurfaceMesh surface_of(const Union& made) {
  const SurfaceMesh& mesh = made.arrangement.mesh;
  SurfaceMesh united{mesh.vertices, {}};
  for (std::size_t f = 0; f < made.kept.size(); ++f)
    if (made.kept[f]) united.triangles.push_back(mesh.triangles[f]);
  return united;
}

// A union holds what its largest solid holds, but for cavities in it. One that does not is of shells that are crossed
// by themselves in ways that no winding number sorts out.
bool loses_volume(const Union& made, const std::vector<Shell>& shells, const CrossingSet& set) {
  constexpr double most_lost = 0.01;
  double largest = 0, cavities = 0;
  for (const std::size_t s : set.shells) {
    largest = std::max(largest, shells[s].volume);
    cavities += std::min(0.0, shells[s].volume);
  }
  return enclosed_volume(surface_of(made)) < (1 - most_lost) * largest + cavities;
}

// The union that is closed, or else the last that was tried.
template <class Predicate>
std::optional<Union> unite_if_closed(Part& part, Crossings which, const Progress& progress, const Predicate& is_wrong) {
  std::optional<Union> last;
  const auto try_all = [&] {
    // Surfaces that cross at flat angles, as two scans of one part, lie within the tolerance over long ways: there only
    // a smaller one tells what is on which side.
    for (const double factor : {1.0, 1e-3, 1e-6}) {
      std::optional<Union> made =
          unite(part, which == Crossings::between_shells, factor * tolerance_of(part.mesh), progress);
      if (!made || is_wrong(*made)) continue;
      last = std::move(made);
      if (encloses_volume(surface_of(*last))) return true;
    }
    return false;
  };
  if (try_all() || part.own_pairs.empty() || is_tangle(part.own_pairs)) return last;
  // Where a shell crosses another, it crosses itself as well.
  part.pairs.insert(part.pairs.end(), part.own_pairs.begin(), part.own_pairs.end());
  std::sort(part.pairs.begin(), part.pairs.end());
  try_all();
  return last;
}

// What of the faces no triangle of the union shows, in pieces of faces that share vertices. Less than the tolerance
// about a face may be its rounding.
void log_lost(const Part& part, const Union& made, RepairResult& result) {
  const std::size_t count = part.mesh.triangles.size();
  const double tolerance = tolerance_of(part.mesh);
  std::vector<double> area(count);
  std::vector<Vec3> weighted(count);  // places by area
  for (std::uint32_t f = 0; f < count; ++f) {
    area[f] = area_of(part.mesh, f);
    weighted[f] = area[f] * centre_of(part.mesh, f);
  }
  const SurfaceMesh& cut = made.arrangement.mesh;
  for (std::uint32_t f = 0; f < cut.triangles.size(); ++f) {
    if (!made.kept[f]) continue;
    area[made.arrangement.face_of[f]] -= area_of(cut, f);
    weighted[made.arrangement.face_of[f]] -= area_of(cut, f) * centre_of(cut, f);
  }
  FaceMarks lost(count, 0);
  for (std::uint32_t f = 0; f < count; ++f) {
    const Triangle& t = part.mesh.triangles[f];
    double outline = 0;
    for (std::size_t i = 0; i < 3; ++i)
      outline += (part.mesh.vertices[t[i]] - part.mesh.vertices[t[(i + 1) % 3]]).norm();
    lost[f] = area[f] > tolerance * outline;
  }
  const FacePieces pieces = find_pieces(part.mesh, lost, 1);
  std::vector<double> of_piece(pieces.area.size(), 0);
  std::vector<Vec3> place(pieces.area.size(), Vec3::Zero());
  for (std::uint32_t f = 0; f < count; ++f)
    if (lost[f]) {
      of_piece[pieces.of_face[f]] += area[f];
      place[pieces.of_face[f]] += weighted[f];
    }
  for (std::size_t i = 0; i < of_piece.size(); ++i)
    result.changes.push_back({RepairKind::DroppedInside, place[i] / of_piece[i], of_piece[i], of_piece[i]});
}

// The corners may begin at another one.
bool is_same(Triangle a, const Triangle& b) {
  for (int i = 0; i < 3 && a != b; ++i) std::rotate(a.begin(), a.begin() + 1, a.end());
  return a == b;
}

}  // namespace

bool unite_crossings(SurfaceMesh& mesh, std::span<const FacePair> pairs, Crossings which, RepairResult& result,
                     const Progress& progress) {
  const std::vector<Shell> shells = find_shells(mesh);
  std::vector<char> gone(mesh.triangles.size(), 0);
  std::vector<Triangle> added;
  bool changed = false;
  for (const CrossingSet& set : find_sets(mesh, shells, pairs, which)) {
    Part part = take_part(mesh, shells, set);
    if (which == Crossings::between_shells) add_contacts(part);
    const std::optional<Union> made = unite_if_closed(part, which, progress, [&](const Union& tried) {
      return which == Crossings::between_shells && loses_volume(tried, shells, set);
    });
    if (!made) continue;
    changed = true;
    const SurfaceMesh& cut = made->arrangement.mesh;
    const auto known = static_cast<std::uint32_t>(part.vertex.size());
    const auto first_new = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), cut.vertices.begin() + known, cut.vertices.end());
    for (const std::uint32_t f : part.face) gone[f] = 1;
    for (std::uint32_t f = 0; f < cut.triangles.size(); ++f) {
      if (!made->kept[f]) continue;
      Triangle t = cut.triangles[f];
      for (std::uint32_t& v : t) v = v < known ? part.vertex[v] : first_new + (v - known);
      const std::uint32_t face = part.face[made->arrangement.face_of[f]];
      if (is_same(t, mesh.triangles[face]))
        gone[face] = 0;
      else
        added.push_back(t);
    }
    log_lost(part, *made, result);
    for (const std::size_t s : set.shells)
      result.changes.push_back({RepairKind::UnitedShell, (shells[s].box.low + shells[s].box.high) / 2, shells[s].area});
  }
  if (!changed) return false;
  remove_faces(mesh, gone, result);
  mesh.triangles.insert(mesh.triangles.end(), added.begin(), added.end());
  result.faces_added += added.size();
  return true;
}

}  // namespace scan2fea
