#include "preproc/volume/fill_regions.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/volume/face_links.hpp"

#include <algorithm>
#include <string>

namespace scan2fea {
namespace {

enum class Side : std::uint8_t { unknown, behind, in_front };

// Of one kind of Error.
template <class Failure>
Failure failed_at(const std::vector<Vec3>& nodes, const std::vector<Triangle>& triangles, std::size_t i,
                  std::string what, std::string advice) {
  const Triangle& t = triangles[i];
  return Failure({.what = std::move(what),
                  .where = "triangle " + std::to_string(i),
                  .value = {},
                  .limit = {},
                  .advice = std::move(advice),
                  .at = Vec3((nodes[t[0]] + nodes[t[1]] + nodes[t[2]]) / 3)});
}

void make_positive(const std::vector<Vec3>& nodes, std::vector<Tetrahedron>& tetrahedra) {
  for (Tetrahedron& t : tetrahedra) {
    const Vec3& a = nodes[t[0]];
    if ((nodes[t[1]] - a).cross(nodes[t[2]] - a).dot(nodes[t[3]] - a) < 0) std::swap(t[0], t[1]);
  }
}

// Whether the face turns the same way as the triangle with the same corners.
bool same_turn(const Triangle& face, const Triangle& triangle) {
  const std::size_t k =
      static_cast<std::size_t>(std::find(triangle.begin(), triangle.end(), face[0]) - triangle.begin());
  return triangle[(k + 1) % 3] == face[1];
}

// Interior nodes come last and are numbered along a space-filling curve: in the order of their last nodes, tetrahedra
// that are near in space are near in memory.
std::vector<std::uint32_t> by_largest_corner(const std::vector<Tetrahedron>& tetrahedra, std::size_t node_count) {
  std::vector<std::uint32_t> begin(node_count + 1, 0);
  const auto largest = [&](const Tetrahedron& t) { return *std::max_element(t.begin(), t.end()); };
  for (const Tetrahedron& t : tetrahedra) ++begin[largest(t) + 1];
  for (std::size_t v = 0; v < node_count; ++v) begin[v + 1] += begin[v];
  std::vector<std::uint32_t> order(tetrahedra.size());
  for (std::uint32_t t = 0; t < tetrahedra.size(); ++t) order[begin[largest(tetrahedra[t])]++] = t;
  return order;
}

// The tetrahedra that can be reached from the first without crossing a triangle, and on which side of these they lie.
struct Region {
  std::vector<std::uint32_t> tetrahedra;
  Side side = Side::unknown;
  std::uint32_t disagreeing = no_link;  // a triangle that tells the other side
};

Region flood(std::uint32_t seed, const std::vector<Tetrahedron>& tetrahedra, const std::vector<Triangle>& triangles,
             const FaceLinks& links, std::vector<bool>& reached) {
  Region region;
  region.tetrahedra.push_back(seed);
  reached[seed] = true;
  for (std::size_t i = 0; i < region.tetrahedra.size(); ++i) {
    const std::uint32_t t = region.tetrahedra[i];
    for (std::size_t k = 0; k < 4; ++k) {
      if (const std::uint32_t triangle = links.triangle[t][k]; triangle != no_link) {
        const Side side =
            same_turn(face_opposite(tetrahedra[t], k), triangles[triangle]) ? Side::behind : Side::in_front;
        if (region.side == Side::unknown) region.side = side;
        if (region.side != side) region.disagreeing = triangle;
      } else if (const std::uint32_t n = links.neighbour[t][k]; n != no_link && !reached[n]) {
        reached[n] = true;
        region.tetrahedra.push_back(n);
      }
    }
  }
  return region;
}

}  // namespace

TetMesh fill_regions(std::vector<Vec3> nodes, std::vector<Tetrahedron> tetrahedra,
                     const std::vector<Triangle>& triangles, std::size_t surface_nodes) {
  make_positive(nodes, tetrahedra);
  const FaceLinks links = link_faces(tetrahedra, triangles, nodes.size());

  std::vector<bool> reached(tetrahedra.size(), false), filled(tetrahedra.size(), false);
  for (std::uint32_t seed = 0; seed < tetrahedra.size(); ++seed) {
    if (reached[seed]) continue;
    const Region region = flood(seed, tetrahedra, triangles, links, reached);
    if (region.disagreeing != no_link)
      throw failed_at<NotMeshable>(nodes, triangles, region.disagreeing,
                                   "a shell lies within another one and both face the same way",
                                   "turn the inner shell around for a cavity, or remove it");
    if (region.side == Side::behind)
      for (const std::uint32_t t : region.tetrahedra) filled[t] = true;
  }

  TetMesh mesh;
  mesh.boundary.assign(triangles.size(), {no_link, 0});
  for (const std::uint32_t t : by_largest_corner(tetrahedra, nodes.size())) {
    if (!filled[t]) continue;
    for (std::size_t k = 0; k < 4; ++k)
      if (const std::uint32_t triangle = links.triangle[t][k]; triangle != no_link)
        mesh.boundary[triangle] = {static_cast<std::uint32_t>(mesh.tetrahedra.size()), face_of_opposite_corner[k]};
    mesh.tetrahedra.push_back(tetrahedra[t]);
  }
  if (mesh.tetrahedra.empty())
    throw NotMeshable({.what = "the surface encloses nothing: it is inside out",
                       .where = {},
                       .value = {},
                       .limit = {},
                       .advice = "scan2fea repair"});
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if (mesh.boundary[i].tetrahedron == no_link)
      throw failed_at<MeshingFailed>(nodes, triangles, i, "the mesher did not keep a boundary triangle",
                                     "scan2fea check on the surface, or allow the boundary to be split");

  std::vector<std::uint32_t> renumbered(nodes.size(), no_link);
  for (const Tetrahedron& t : mesh.tetrahedra)
    for (const std::uint32_t v : t) renumbered[v] = 0;
  for (std::size_t v = 0; v < nodes.size(); ++v) {
    if (v >= surface_nodes && renumbered[v] == no_link) continue;
    renumbered[v] = static_cast<std::uint32_t>(mesh.nodes.size());
    mesh.nodes.push_back(nodes[v]);
  }
  for (Tetrahedron& t : mesh.tetrahedra)
    for (std::uint32_t& v : t) v = renumbered[v];
  return mesh;
}

}  // namespace scan2fea
