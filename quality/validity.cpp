#include "quality/validity.hpp"

#include "preproc/mesh/face_neighbours.hpp"
#include "preproc/mesh/splitmix64.hpp"
#include "preproc/mesh/union_find.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

namespace scan2fea {
namespace {

// A face's side from its corner k to corner k + 1, seen from the edge's vertex of smaller index.
struct Side {
  std::uint32_t larger_vertex;
  std::uint32_t from_corner;     // 3 * face + k
  std::uint32_t smaller_corner;  // the corner at the vertex of smaller index
  std::uint32_t larger_corner;

  bool runs_upwards() const { return from_corner == smaller_corner; }
};

// The sides of all faces by their smaller vertex: those of v are sides[first[v]] to sides[first[v + 1]], sorted by the
// larger vertex so that the sides of one edge are adjacent.
struct SidesByVertex {
  std::vector<std::uint32_t> first;
  std::vector<Side> sides;
};

bool is_degenerate(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

SidesByVertex sort_sides(const SurfaceMesh& mesh) {
  SidesByVertex sorted;
  auto& first = sorted.first;
  first.assign(mesh.vertices.size() + 1, 0);
  for (const Triangle& t : mesh.triangles) {
    if (is_degenerate(t)) continue;
    for (std::size_t k = 0; k < 3; ++k) ++first[std::min(t[k], t[(k + 1) % 3]) + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());

  sorted.sides.resize(first.back());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    if (is_degenerate(t)) continue;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k], to = t[(k + 1) % 3];
      const std::uint32_t from_corner = 3 * f + k, to_corner = 3 * f + (k + 1) % 3;
      sorted.sides[next[std::min(from, to)]++] =
          from < to ? Side{to, from_corner, from_corner, to_corner} : Side{from, from_corner, to_corner, from_corner};
    }
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    std::sort(sorted.sides.begin() + first[v], sorted.sides.begin() + first[v + 1], [](const Side& a, const Side& b) {
      return a.larger_vertex != b.larger_vertex ? a.larger_vertex < b.larger_vertex : a.from_corner < b.from_corner;
    });
  return sorted;
}

// Whether a walk around the vertex from face to face comes past all of its faces. `neighbours` are mutual, and each
// face has three.
bool is_one_fan(const SurfaceMesh& mesh, const VertexStars& stars, const std::vector<Triangle>& neighbours,
                std::uint32_t vertex) {
  const std::span<const std::uint32_t> star = stars.corners(vertex);
  if (star.empty()) return true;
  std::size_t passed = 0;
  std::uint32_t f = star.front() / 3;
  do {
    const Triangle& t = mesh.triangles[f];
    const std::size_t k = t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2;
    f = neighbours[f][(k + 1) % 3];  // across the edge that arrives at the vertex
    ++passed;
  } while (f != star.front() / 3);
  return passed == star.size();
}

std::size_t count_components(const std::vector<Triangle>& neighbours) {
  std::vector<bool> reached(neighbours.size(), false);
  std::vector<std::uint32_t> stack;
  std::size_t components = 0;
  for (std::uint32_t seed = 0; seed < neighbours.size(); ++seed) {
    if (reached[seed]) continue;
    ++components;
    reached[seed] = true;
    for (stack.push_back(seed); !stack.empty();) {
      const std::uint32_t f = stack.back();
      stack.pop_back();
      for (const std::uint32_t g : neighbours[f]) {
        if (reached[g]) continue;
        reached[g] = true;
        stack.push_back(g);
      }
    }
  }
  return components;
}

// What there is to say about a closed and oriented manifold; nothing where the surface is none. Most are, and this
// takes a third of the time that sets of faces and of corners do.
std::optional<SurfaceValidity> validity_of_closed(const SurfaceMesh& mesh) {
  if (std::any_of(mesh.triangles.begin(), mesh.triangles.end(), is_degenerate)) return {};
  const VertexStars stars(mesh);
  const std::vector<Triangle> neighbours = face_neighbours(mesh, stars);
  for (const Triangle& across : neighbours)
    if (std::find(across.begin(), across.end(), no_face) != across.end()) return {};
  SurfaceValidity validity;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    validity.unused_vertices += stars.corners(v).empty();
    if (!is_one_fan(mesh, stars, neighbours, v)) return {};
  }
  validity.components = count_components(neighbours);
  const auto faces = static_cast<long>(mesh.triangles.size());
  const auto vertices = static_cast<long>(mesh.vertices.size() - validity.unused_vertices);
  const long euler = vertices - 3 * faces / 2 + faces;  // 2 * components - 2 * genus
  validity.genus = static_cast<int>(static_cast<long>(validity.components) - euler / 2);
  return validity;
}

}  // namespace

SurfaceValidity check_validity(const SurfaceMesh& mesh) {
  if (const std::optional<SurfaceValidity> closed = validity_of_closed(mesh)) return *closed;
  SurfaceValidity validity;
  UnionFind faces(mesh.triangles.size());
  UnionFind corners(3 * mesh.triangles.size());  // joined where two faces share an edge at the corner
  const auto [first, sides] = sort_sides(mesh);

  long edges = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    for (std::size_t i = first[v]; i < first[v + 1];) {
      const Side& side = sides[i];
      long faces_here = 0, upwards = 0;
      for (; i < first[v + 1] && sides[i].larger_vertex == side.larger_vertex; ++i) {
        ++faces_here;
        upwards += sides[i].runs_upwards();
        faces.unite(side.from_corner / 3, sides[i].from_corner / 3);
        corners.unite(side.smaller_corner, sides[i].smaller_corner);
        corners.unite(side.larger_corner, sides[i].larger_corner);
      }
      ++edges;
      validity.boundary_edges += faces_here == 1;
      validity.non_manifold_edges += faces_here > 2;
      validity.misoriented_edges += faces_here > 1 && 2 * upwards != faces_here;
    }
  }

  long face_count = 0;
  std::vector<std::uint32_t> fans(mesh.vertices.size(), 0);
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    if (is_degenerate(t)) {
      ++validity.degenerate_faces;
      continue;
    }
    ++face_count;
    validity.components += faces.find(f) == f;
    for (std::uint32_t k = 0; k < 3; ++k) fans[t[k]] += corners.find(3 * f + k) == 3 * f + k;
  }
  for (const std::uint32_t count : fans) {
    validity.unused_vertices += count == 0;
    validity.non_manifold_vertices += count > 1;
  }

  if (validity.closed() && validity.manifold()) {
    const long vertices = static_cast<long>(mesh.vertices.size() - validity.unused_vertices);
    const long euler = vertices - edges + face_count;  // 2 * components - 2 * genus
    validity.genus = static_cast<int>(static_cast<long>(validity.components) - euler / 2);
  }
  return validity;
}

bool encloses_volume(const SurfaceMesh& mesh) {
  std::uint64_t sum = 0;  // modulo 2^64
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t from = t[k], to = t[(k + 1) % 3];
      if (from < to)
        sum += splitmix64(from << 32U | to);
      else if (to < from)
        sum -= splitmix64(to << 32U | from);
    }
  return sum == 0;
}

}  // namespace scan2fea
