#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include "preproc/mesh/error.hpp"

#include <algorithm>
#include <string>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

[[noreturn]] void throw_not_manifold(std::string what, std::string where) {
  throw NotMeshable({.what = std::move(what),
                     .where = std::move(where),
                     .value = {},
                     .limit = "an oriented manifold surface",
                     .advice = "repair the surface first"});
}

std::string edge_name(Index a, Index b) {
  return "edge of vertices " + std::to_string(a) + " and " + std::to_string(b);
}

}  // namespace

HalfedgeMesh::HalfedgeMesh(const SurfaceMesh& mesh) : points(mesh.vertices), face_count_(mesh.triangles.size()) {
  if (face_count_ >= none / 3)
    throw NotMeshable({.what = "too many triangles for 32-bit connectivity",
                       .where = {},
                       .value = std::to_string(face_count_),
                       .limit = std::to_string(none / 3),
                       .advice = "split the scan"});
  origin_.reserve(3 * face_count_);
  for (std::size_t f = 0; f < face_count_; ++f) {
    const Triangle& t = mesh.triangles[f];
    for (const Index v : t)
      if (v >= points.size()) throw_not_manifold("vertex index out of range", "face " + std::to_string(f));
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
      throw_not_manifold("a triangle uses a vertex twice", "face " + std::to_string(f));
    origin_.insert(origin_.end(), t.begin(), t.end());
  }
  build_opposites();
  build_outgoing();
}

// Half-edges are bucketed by their origin (a counting sort), so that an opposite is found among a vertex's few.
void HalfedgeMesh::build_opposites() {
  const auto count = static_cast<Index>(origin_.size());
  std::vector<Index> first(points.size() + 1, 0);
  for (const Index v : origin_) ++first[v + 1];
  for (std::size_t v = 0; v < points.size(); ++v) first[v + 1] += first[v];
  std::vector<Index> bucket(count);
  std::vector<Index> fill(first.begin(), first.end() - 1);
  for (Index h = 0; h < count; ++h) bucket[fill[origin_[h]]++] = h;

  opposite_.assign(count, none);
  const auto halfedges_to = [&](Index from, Index to, auto visit) {
    for (Index i = first[from]; i < first[from + 1]; ++i)
      if (target(bucket[i]) == to) visit(bucket[i]);
  };
  for (Index h = 0; h < count; ++h) {
    const Index a = origin_[h], b = target(h);
    halfedges_to(a, b, [&](Index other) {
      if (other != h)
        throw_not_manifold("an edge has more than two faces, or two of opposite orientation", edge_name(a, b));
    });
    halfedges_to(b, a, [&](Index other) { opposite_[h] = other; });
  }
}

void HalfedgeMesh::build_outgoing() {
  outgoing_.assign(points.size(), none);
  std::vector<Index> faces_at(points.size(), 0);
  for (Index h = 0; h < origin_.size(); ++h) {
    const Index v = origin_[h];
    ++faces_at[v];
    if (outgoing_[v] == none || is_border(h)) outgoing_[v] = h;
  }
  for (Index v = 0; v < points.size(); ++v) {
    Index met = 0;
    for_each_outgoing(v, [&](Index) { ++met; });
    if (met != faces_at[v])
      throw_not_manifold("parts of the surface touch in one vertex only", "vertex " + std::to_string(v));
  }
}

SurfaceMesh HalfedgeMesh::to_surface() const {
  SurfaceMesh mesh;
  mesh.triangles.reserve(face_count_);
  std::vector<Index> number(points.size(), none);
  for (Index v = 0; v < points.size(); ++v)
    if (is_alive(v)) {
      number[v] = static_cast<Index>(mesh.vertices.size());
      mesh.vertices.push_back(points[v]);
    }
  for (Index f = 0; f < face_slots(); ++f)
    if (is_face_alive(f)) {
      const Triangle t = triangle(f);
      mesh.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
    }
  return mesh;
}

std::size_t HalfedgeMesh::valence(Index v) const {
  std::size_t count = 0;
  for_each_neighbour(v, [&](Index) { ++count; });
  return count;
}

Index HalfedgeMesh::find_halfedge(Index a, Index b) const {
  Index found = none;
  for_each_outgoing(a, [&](Index h) {
    if (target(h) == b) found = h;
  });
  return found;
}

bool HalfedgeMesh::are_neighbours(Index a, Index b) const {
  bool found = false;
  for_each_neighbour(a, [&](Index v) { found = found || v == b; });
  return found;
}

void HalfedgeMesh::link(Index h, Index o) {
  if (h != none) opposite_[h] = o;
  if (o != none) opposite_[o] = h;
}

void HalfedgeMesh::set_face(Index f, Index a, Index b, Index c) {
  const std::size_t h = 3 * std::size_t{f};
  origin_[h] = a;
  origin_[h + 1] = b;
  origin_[h + 2] = c;
}

Index HalfedgeMesh::add_face(Index a, Index b, Index c) {
  const auto h = static_cast<Index>(origin_.size());
  origin_.insert(origin_.end(), {a, b, c});
  opposite_.insert(opposite_.end(), 3, none);
  ++face_count_;
  return h;
}

void HalfedgeMesh::remove_face(Index f) {
  set_face(f, none, none, none);
  --face_count_;
}

// `h` is any half-edge that starts at v; turns clockwise until a border or a full circle is met.
void HalfedgeMesh::set_outgoing(Index v, Index h) {
  const Index start = h;
  while (!is_border(h)) {
    h = next(opposite_[h]);
    if (h == start) break;
  }
  outgoing_[v] = h;
}

bool HalfedgeMesh::can_collapse(Index h) const {
  const Index o = opposite_[h];
  const Index a = origin_[h], b = target(h);
  if (o != none && is_border_vertex(a) && is_border_vertex(b)) return false;

  // A face whose other two edges are borders would leave its apex without a face; an inner apex with three neighbours
  // would keep only two.
  const auto apex_stays = [&](Index side) {
    if (is_border(next(side)) && is_border(prev(side))) return false;
    const Index apex = origin_[prev(side)];
    return is_border_vertex(apex) || valence(apex) > 3;
  };
  if (!apex_stays(h) || (o != none && !apex_stays(o))) return false;

  std::size_t shared = 0;
  for_each_neighbour(a, [&](Index v) { for_each_neighbour(b, [&](Index w) { shared += v == w ? 1 : 0; }); });
  return shared == (o == none ? 1U : 2U);
}

void HalfedgeMesh::collapse(Index h) {
  const Index kept = origin_[h], removed = target(h);
  const std::array<Index, 2> sides{h, opposite_[h]};

  Index turn = outgoing_[removed];
  const Index first = turn;
  do {
    const Index following = opposite_[prev(turn)];
    origin_[turn] = kept;
    turn = following;
  } while (turn != none && turn != first);
  outgoing_[removed] = none;

  Index apexes[2];
  std::size_t apex_count = 0;
  for (const Index side : sides) {
    if (side == none) continue;
    const Index apex = origin_[prev(side)];
    const Index p = opposite_[next(side)], q = opposite_[prev(side)];  // become the two sides of one edge
    link(p, q);
    remove_face(face(side));
    for (const Index outer : {p, q}) {
      if (outer == none) continue;
      const bool from_kept = origin_[outer] == kept;
      outgoing_[kept] = from_kept ? outer : next(outer);
      outgoing_[apex] = from_kept ? next(outer) : outer;
    }
    apexes[apex_count++] = apex;
  }
  set_outgoing(kept, outgoing_[kept]);
  for (std::size_t i = 0; i < apex_count; ++i) set_outgoing(apexes[i], outgoing_[apexes[i]]);
}

bool HalfedgeMesh::can_flip(Index h) const {
  const Index o = opposite_[h];
  if (o == none) return false;
  const Index a = origin_[h], b = target(h), c = origin_[prev(h)], d = origin_[prev(o)];
  for (const Index v : {a, b})
    if (valence(v) <= (is_border_vertex(v) ? 2U : 3U)) return false;
  return c != d && !are_neighbours(c, d);
}

void HalfedgeMesh::flip(Index h) {
  const Index o = opposite_[h];
  const Index a = origin_[h], b = target(h), c = origin_[prev(h)], d = origin_[prev(o)];
  const Index bc = opposite_[next(h)], ca = opposite_[prev(h)];
  const Index ad = opposite_[next(o)], db = opposite_[prev(o)];
  origin_[h] = d;  // d c a
  origin_[next(h)] = c;
  origin_[prev(h)] = a;
  origin_[o] = c;  // c d b
  origin_[next(o)] = d;
  origin_[prev(o)] = b;
  link(next(h), ca);
  link(prev(h), ad);
  link(next(o), db);
  link(prev(o), bc);
  set_outgoing(a, prev(h));
  set_outgoing(b, prev(o));
  set_outgoing(c, next(h));
  set_outgoing(d, next(o));
}

Index HalfedgeMesh::split_face(Index f, const Vec3& point) {
  const auto v = static_cast<Index>(points.size());
  points.push_back(point);
  outgoing_.push_back(none);
  const Index h = 3 * f;
  const Index a = origin_[h], b = origin_[h + 1], c = origin_[h + 2];
  const Index outer_b = opposite_[h + 1], outer_c = opposite_[h + 2];
  set_face(f, a, b, v);
  const Index hb = add_face(b, c, v), hc = add_face(c, a, v);
  link(hb, outer_b);
  link(hc, outer_c);
  link(h + 1, hb + 2);
  link(hb + 1, hc + 2);
  link(hc + 1, h + 2);
  outgoing_[v] = h + 2;
  set_outgoing(a, h);
  set_outgoing(b, hb);
  set_outgoing(c, hc);
  return v;
}

Index HalfedgeMesh::split_edge(Index h, const Vec3& point) {
  const auto v = static_cast<Index>(points.size());
  points.push_back(point);
  outgoing_.push_back(none);
  const Index o = opposite_[h];
  const Index b = target(h), c = origin_[prev(h)];
  const Index bc = opposite_[next(h)];
  origin_[next(h)] = v;  // the face becomes a v c, the new one is v b c
  const Index n = add_face(v, b, c);
  link(n + 1, bc);
  link(n + 2, next(h));
  Index m = none;
  if (o != none) {
    // b a d becomes v a d, the new one is b v d
    const Index d = origin_[prev(o)];
    const Index db = opposite_[prev(o)];
    origin_[o] = v;
    m = add_face(b, v, d);
    link(m, n);
    link(m + 1, prev(o));
    link(m + 2, db);
    set_outgoing(d, m + 2);
  }
  outgoing_[v] = n;
  set_outgoing(v, n);
  set_outgoing(b, n + 1);
  set_outgoing(c, n + 2);
  return v;
}

}  // namespace scan2fea
