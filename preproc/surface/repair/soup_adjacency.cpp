#include "preproc/surface/repair/soup_adjacency.hpp"

#include "preproc/surface/repair/face_marks.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>

namespace scan2fea {
namespace {

// Faces about one edge of more than two, paired. `+` faces run along the edge's direction, `-` faces against it.
// Counted counter-clockwise about the edge, material begins at a `-` face and ends at a `+` face: as parentheses match.
struct RadialFace {
  std::uint32_t halfedge;
  double angle;
  bool forward;
};

std::vector<RadialFace> sort_about_edge(const SurfaceMesh& mesh, std::span<const std::uint32_t> halfedges) {
  const std::uint32_t low = std::min(start_vertex(mesh, halfedges[0]), end_vertex(mesh, halfedges[0]));
  const std::uint32_t high = std::max(start_vertex(mesh, halfedges[0]), end_vertex(mesh, halfedges[0]));
  const Vec3 axis = (mesh.vertices[high] - mesh.vertices[low]).normalized();
  const Vec3 u = axis.unitOrthogonal();
  const Vec3 v = axis.cross(u);
  std::vector<RadialFace> faces;
  for (const std::uint32_t h : halfedges) {
    const Vec3 d = mesh.vertices[start_vertex(mesh, previous_halfedge(h))] - mesh.vertices[low];
    faces.push_back({h, std::atan2(d.dot(v), d.dot(u)), start_vertex(mesh, h) == low});
  }
  std::sort(faces.begin(), faces.end(), [](const RadialFace& a, const RadialFace& b) {
    return a.angle != b.angle ? a.angle < b.angle : a.halfedge < b.halfedge;
  });
  return faces;
}

// Where solids touch along faces, one ends at the angle at which the next begins, up to rounding. Put first, the
// beginning makes one solid of the two, and a shell without volume of the faces between them.
void begin_before_end(std::vector<RadialFace>& faces) {
  constexpr double same_angle = 1e-4;  // nothing that opens less can be filled with elements
  const auto apart = [&](std::size_t i) {
    const double turn = i == 0 ? 2 * std::numbers::pi : 0;
    return faces[i].angle - faces[(i + faces.size() - 1) % faces.size()].angle + turn > same_angle;
  };
  std::size_t start = 0;
  while (start < faces.size() && !apart(start)) ++start;
  if (start == faces.size()) return;
  std::rotate(faces.begin(), faces.begin() + static_cast<std::ptrdiff_t>(start), faces.end());
  for (RadialFace& face : faces)
    if (face.angle < faces[0].angle) face.angle += 2 * std::numbers::pi;
  for (auto first = faces.begin(); first != faces.end();) {
    auto last = first + 1;
    while (last != faces.end() && last->angle - (last - 1)->angle <= same_angle) ++last;
    std::stable_partition(first, last, [](const RadialFace& f) { return !f.forward; });
    first = last;
  }
}

void pair_up(std::uint32_t a, std::uint32_t b, Twins& twins) {
  twins[a] = b;
  twins[b] = a;
}

// Across the material: an inner pair of neighbours `-+` is taken out until none is left.
void pair_across_material(std::vector<RadialFace> faces, Twins& twins) {
  for (std::size_t i = 0; faces.size() >= 2;) {
    const std::size_t j = (i + 1) % faces.size();
    if (!faces[i].forward && faces[j].forward) {
      pair_up(faces[i].halfedge, faces[j].halfedge, twins);
      faces.erase(faces.begin() + static_cast<std::ptrdiff_t>(std::max(i, j)));
      faces.erase(faces.begin() + static_cast<std::ptrdiff_t>(std::min(i, j)));
      i = 0;
    } else {
      ++i;
      if (i == faces.size()) break;  // only faces of one direction are left
    }
  }
}

// Where directions do not balance: the two that make the flattest surface, then the next.
void pair_flattest(std::vector<RadialFace> faces, Twins& twins) {
  while (faces.size() >= 2) {
    std::size_t best_i = 0, best_j = 1;
    double best = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < faces.size(); ++i)
      for (std::size_t j = i + 1; j < faces.size(); ++j) {
        const double bend = std::abs(faces[j].angle - faces[i].angle - std::numbers::pi) +
                            (faces[i].forward == faces[j].forward ? 2 * std::numbers::pi : 0);
        if (bend < best) best = bend, best_i = i, best_j = j;
      }
    pair_up(faces[best_i].halfedge, faces[best_j].halfedge, twins);
    faces.erase(faces.begin() + static_cast<std::ptrdiff_t>(best_j));
    faces.erase(faces.begin() + static_cast<std::ptrdiff_t>(best_i));
  }
}

// Turns faces so that twins run through their edge in opposite directions, each connected part so that less area is
// turned. Twins that cannot agree are cut. `turned` tells of each face whether it was turned an odd number of times.
void orient(SurfaceMesh& mesh, Twins& twins, std::vector<char>& turned) {
  const auto n = static_cast<std::uint32_t>(mesh.triangles.size());
  enum : char { Unseen, Kept, Flipped };
  std::vector<char> state(n, Unseen);
  std::vector<std::uint32_t> part;
  std::vector<char> flip(n, 0);
  for (std::uint32_t seed = 0; seed < n; ++seed) {
    if (state[seed] != Unseen) continue;
    part.assign(1, seed);
    state[seed] = Kept;
    double kept_area = 0, flipped_area = 0;
    bool any_flipped = false;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const std::uint32_t f = part[i];
      for (std::uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
        const std::uint32_t t = twins[h];
        if (t == no_twin) continue;
        const bool same_direction = start_vertex(mesh, h) == start_vertex(mesh, t);
        const char wanted = same_direction == (state[f] == Kept) ? Flipped : Kept;
        if (state[t / 3] == Unseen) {
          state[t / 3] = wanted;
          any_flipped |= wanted == Flipped;
          part.push_back(t / 3);
        } else if (state[t / 3] != wanted) {
          twins[h] = twins[t] = no_twin;
        }
      }
    }
    if (!any_flipped) continue;
    for (const std::uint32_t f : part)
      (state[f] == Kept ? kept_area : flipped_area) += area_vector(mesh, mesh.triangles[f]).norm();
    const char minority = flipped_area <= kept_area ? Flipped : Kept;
    for (const std::uint32_t f : part) flip[f] = state[f] == minority;
  }

  // A turned face's corners 1 and 2 change places, and so do its half-edges 0 and 2.
  const auto after = [&](std::uint32_t h) { return flip[h / 3] != 0 ? 3 * (h / 3) + 2 - h % 3 : h; };
  if (std::find(flip.begin(), flip.end(), 1) == flip.end()) return;
  Twins new_twins(twins.size());
  for (std::uint32_t h = 0; h < twins.size(); ++h)
    new_twins[after(h)] = twins[h] == no_twin ? no_twin : after(twins[h]);
  twins = std::move(new_twins);
  for (std::uint32_t f = 0; f < n; ++f)
    if (flip[f] != 0) {
      std::swap(mesh.triangles[f][1], mesh.triangles[f][2]);
      turned[f] ^= 1;
    }
}

// Half-edges of edges that the mesh's indices tell otherwise than the twins.
std::vector<std::uint32_t> inconsistent_halfedges(const SurfaceMesh& mesh, const Twins& twins) {
  std::vector<std::uint32_t> found;
  EdgeGroups(mesh).for_each([&](const std::uint32_t* first, const std::uint32_t* last) {
    if (last - first > 2 || (last - first == 2 && twins[first[0]] != first[1])) found.insert(found.end(), first, last);
  });
  return found;
}

}  // namespace

EdgeGroups::EdgeGroups(const SurfaceMesh& mesh) {
  const auto halfedge_count = static_cast<std::uint32_t>(3 * mesh.triangles.size());
  std::vector<std::uint32_t> first(mesh.vertices.size() + 1, 0);  // by the lower vertex
  const auto low = [&](std::uint32_t h) { return std::min(start_vertex(mesh, h), end_vertex(mesh, h)); };
  const auto high = [&](std::uint32_t h) { return std::max(start_vertex(mesh, h), end_vertex(mesh, h)); };
  for (std::uint32_t h = 0; h < halfedge_count; ++h) ++first[low(h) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());

  struct Entry {
    std::uint32_t high, halfedge;
    bool operator<(const Entry& o) const { return high != o.high ? high < o.high : halfedge < o.halfedge; }
  };
  std::vector<Entry> entries(halfedge_count);
  std::vector<std::uint32_t> fill(first.begin(), first.end() - 1);
  for (std::uint32_t h = 0; h < halfedge_count; ++h) entries[fill[low(h)]++] = {high(h), h};

  halfedge_.reserve(halfedge_count);
  start_.reserve(halfedge_count / 2 + 1);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    std::sort(entries.begin() + first[v], entries.begin() + first[v + 1]);
    for (std::uint32_t i = first[v]; i < first[v + 1]; ++i) {
      if (i == first[v] || entries[i].high != entries[i - 1].high) start_.push_back(i);
      halfedge_.push_back(entries[i].halfedge);
    }
  }
  start_.push_back(halfedge_count);
}

Twins make_manifold(SurfaceMesh& mesh, RepairResult& result) {
  for (;;) {
    std::vector<char> turned(mesh.triangles.size(), 0);
    Twins twins(3 * mesh.triangles.size(), no_twin);
    bool has_non_manifold_edges = false;
    const EdgeGroups edges(mesh);
    edges.for_each([&](const std::uint32_t* first, const std::uint32_t* last) {
      if (last - first == 2) pair_up(first[0], first[1], twins);
      has_non_manifold_edges |= last - first > 2;
    });
    orient(mesh, twins, turned);

    if (has_non_manifold_edges) {  // now that directions mean something
      const EdgeGroups oriented_edges(mesh);
      oriented_edges.for_each([&](const std::uint32_t* first, const std::uint32_t* last) {
        if (last - first <= 2) return;
        std::vector<RadialFace> faces = sort_about_edge(mesh, {first, last});
        const auto forward = std::count_if(faces.begin(), faces.end(), [](const RadialFace& f) { return f.forward; });
        if (2 * forward == last - first) {
          begin_before_end(faces);
          pair_across_material(std::move(faces), twins);
        } else
          pair_flattest(std::move(faces), twins);
      });
      orient(mesh, twins, turned);
    }
    for (std::size_t f = 0; f < turned.size(); ++f)
      if (turned[f]) {
        const Triangle& t = mesh.triangles[f];
        const Vec3 centre = centroid(mesh, t);
        result.changes.push_back({RepairKind::TurnedFaces, centre, area_vector(mesh, t).norm() / 2});
      }
    for (const std::uint32_t v : split_vertices(mesh, twins))
      result.changes.push_back({RepairKind::SplitVertex, mesh.vertices[v], 0});

    // A fan may meet one edge twice, and cut twins may still name the same vertices: no pairing mends that.
    const std::vector<std::uint32_t> inconsistent = inconsistent_halfedges(mesh, twins);
    if (inconsistent.empty()) return twins;
    std::vector<char> bad(mesh.triangles.size(), 0);
    for (const std::uint32_t h : inconsistent) bad[h / 3] = 1;
    log_faces(mesh, bad, RepairKind::NonManifoldFaces, result);
    remove_faces(mesh, bad, result);
  }
}

std::vector<std::uint32_t> split_vertices(SurfaceMesh& mesh, const Twins& twins) {
  std::vector<std::uint32_t> copied;
  std::vector<char> taken(mesh.vertices.size(), 0);
  std::vector<char> visited(twins.size(), 0);
  for (std::uint32_t corner = 0; corner < twins.size(); ++corner) {
    if (visited[corner]) continue;
    const std::uint32_t old = start_vertex(mesh, corner);
    std::uint32_t vertex = old;
    if (taken[old]) {
      vertex = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(Vec3(mesh.vertices[old]));
      copied.push_back(old);
    }
    taken[old] = 1;
    const auto visit = [&](std::uint32_t h) {
      visited[h] = 1;
      mesh.triangles[h / 3][h % 3] = vertex;
    };
    std::uint32_t h = corner;
    do {  // counter-clockwise, to a border or around
      visit(h);
      h = twins[previous_halfedge(h)];
    } while (h != no_twin && h != corner);
    if (h == corner) continue;
    for (std::uint32_t t = twins[corner]; t != no_twin; t = twins[h]) {  // clockwise to the other border
      h = next_halfedge(t);
      visit(h);
    }
  }
  return copied;
}

Twins find_twins(const SurfaceMesh& mesh) {
  Twins twins(3 * mesh.triangles.size(), no_twin);
  EdgeGroups(mesh).for_each([&](const std::uint32_t* first, const std::uint32_t* last) {
    assert(last - first <= 2);
    if (last - first == 2) pair_up(first[0], first[1], twins);
  });
  return twins;
}

std::vector<BorderLoop> find_border_loops(const SurfaceMesh& mesh, const Twins& twins) {
  // In a manifold mesh each vertex ends at most one border half-edge.
  std::vector<std::uint32_t> ending_at(mesh.vertices.size(), no_twin);
  for (std::uint32_t h = 0; h < twins.size(); ++h)
    if (twins[h] == no_twin) ending_at[end_vertex(mesh, h)] = h;
  std::vector<char> visited(twins.size(), 0);
  std::vector<BorderLoop> loops;
  for (std::uint32_t seed = 0; seed < twins.size(); ++seed) {
    if (twins[seed] != no_twin || visited[seed]) continue;
    auto& loop = loops.emplace_back();
    for (std::uint32_t h = seed; !visited[h]; h = ending_at[start_vertex(mesh, h)]) {
      visited[h] = 1;
      loop.push_back(h);
    }
  }
  return loops;
}

}  // namespace scan2fea
