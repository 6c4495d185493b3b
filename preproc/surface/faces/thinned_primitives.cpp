#include "preproc/surface/faces/thinned_primitives.hpp"

#include "preproc/surface/kernel/adjacency.hpp"

#include <algorithm>
#include <utility>

namespace scan2fea {
namespace {

using Index = std::uint32_t;

// The first thinning leaves one vertex in six: with fewer points noise of a tenth of a per cent hides small faces.
constexpr std::size_t most_vertices = 120000, most_points = 60000;
constexpr std::size_t neighbours_per_point = 20;  // as find_primitives has it
constexpr Index none = ~Index{0};

struct Patches {
  std::vector<Index> seeds;      // vertices
  std::vector<Index> of_vertex;  // in `seeds`
};

// Each vertex that is in none yet becomes the seed of a patch of so many rings around it.
Patches patches_of(const SurfaceMesh& mesh, const VertexStars& stars, int rings) {
  Patches patches{{}, std::vector<Index>(mesh.vertices.size(), none)};
  for (Index v = 0; v < mesh.vertices.size(); ++v) {
    if (patches.of_vertex[v] != none || stars.corners(v).empty()) continue;
    const auto patch = static_cast<Index>(patches.seeds.size());
    patches.seeds.push_back(v);
    patches.of_vertex[v] = patch;
    std::vector<Index> front{v};
    for (int ring = 0; ring < rings; ++ring) {
      std::vector<Index> next;
      for (const Index from : front)
        for (const Index corner : stars.corners(from))
          for (const Index w : mesh.triangles[corner / 3])
            if (patches.of_vertex[w] == none) {
              patches.of_vertex[w] = patch;
              next.push_back(w);
            }
      front = std::move(next);
    }
  }
  return patches;
}

// The patches that are reached first over those beside one another, nearest first.
Neighbours neighbours_of(const SurfaceMesh& mesh, const Patches& patches) {
  std::vector<std::vector<Index>> beside(patches.seeds.size());
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = patches.of_vertex[t[k]], b = patches.of_vertex[t[(k + 1) % 3]];
      if (a == b) continue;
      beside[a].push_back(b);
      beside[b].push_back(a);
    }
  for (std::vector<Index>& list : beside) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  Neighbours neighbours;
  for (Index p = 0; p < beside.size(); ++p) {
    constexpr int hops = 3;
    std::vector<Index> near{p};
    for (std::size_t begin = 0, hop = 0; hop < hops && near.size() <= neighbours_per_point; ++hop) {
      const std::size_t end = near.size();
      for (; begin < end; ++begin)
        for (const Index q : beside[near[begin]])
          if (std::find(near.begin(), near.end(), q) == near.end()) near.push_back(q);
    }
    near.erase(near.begin());
    const Vec3& place = mesh.vertices[patches.seeds[p]];
    const auto distance = [&](Index q) { return (mesh.vertices[patches.seeds[q]] - place).squaredNorm(); };
    std::stable_sort(near.begin(), near.end(), [&](Index a, Index b) { return distance(a) < distance(b); });
    near.resize(std::min(near.size(), neighbours_per_point));
    neighbours.all.insert(neighbours.all.end(), near.begin(), near.end());
    neighbours.first.push_back(neighbours.all.size());
  }
  return neighbours;
}

std::vector<Vec3> averaged_normals(const SurfaceMesh& mesh, int rounds) {
  std::vector<Vec3> normals = vertex_normals(mesh);
  for (int round = 0; round < rounds; ++round) {
    std::vector<Vec3> sums = normals;
    for (const Triangle& t : mesh.triangles)
      for (const Index v : t)
        for (const Index w : t) sums[v] += normals[w];
    for (std::size_t v = 0; v < sums.size(); ++v) normals[v] = sums[v].normalized();
  }
  return normals;
}

}  // namespace

Primitives find_thinned_primitives(const SurfaceMesh& mesh, const Progress& progress) {
  if (mesh.vertices.size() <= most_vertices) return find_primitives(mesh, {}, progress);
  const VertexStars stars(mesh);
  int rings = 1;
  Patches patches = patches_of(mesh, stars, rings);
  while (patches.seeds.size() > most_points) patches = patches_of(mesh, stars, ++rings);
  const std::vector<Vec3> normals = averaged_normals(mesh, rings);
  std::vector<Vec3> points, outwards;
  for (const Index v : patches.seeds) {
    points.push_back(mesh.vertices[v]);
    outwards.push_back(normals[v]);
  }
  Primitives found = find_primitives(points, neighbours_of(mesh, patches), outwards, {}, progress);
  std::vector<Index> labels(mesh.vertices.size(), no_primitive);
  for (Index v = 0; v < labels.size(); ++v)
    if (patches.of_vertex[v] != none) labels[v] = found.labels[patches.of_vertex[v]];
  found.labels = std::move(labels);
  found.normals = normals;
  return found;
}

}  // namespace scan2fea
