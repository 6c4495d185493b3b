#include "preproc/surface/mending/local_moves.hpp"

#include "preproc/surface/kernel/halfedge_mesh.hpp"
#include "preproc/surface/kernel/locate.hpp"
#include "preproc/surface/kernel/rings.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace scan2fea {
namespace {

// 1 / eta of a triangle whose height is about a hundredth of its longest side: it counts as having no area.
constexpr double cap_quality = 0.02;

double worst_of_star(const SurfaceMesh& mesh, const ReferenceSurface& scan, const std::vector<std::uint32_t>& near,
                     std::span<const std::uint32_t> corners) {
  double worst = 1;
  for (const std::uint32_t corner : corners) {
    const std::uint32_t f = corner / 3;
    worst = std::min(worst, signed_quality(mesh, mesh.triangles[f], scan.vertex_normals[near[f]]));
  }
  return worst;
}

Vec3 centroid_of_link(const SurfaceMesh& mesh, std::span<const std::uint32_t> corners) {
  Vec3 sum = Vec3::Zero();
  for (const std::uint32_t corner : corners) {
    const Triangle& t = mesh.triangles[corner / 3];
    const std::uint32_t k = corner % 3;
    sum += mesh.vertices[t[(k + 1) % 3]] + mesh.vertices[t[(k + 2) % 3]];
  }
  return sum / (2.0 * static_cast<double>(corners.size()));
}

// An edge as one of its two faces turns, that face first.
struct Flip {
  std::array<std::uint32_t, 2> edge, faces;
  std::array<Triangle, 2> before, after;
};

// Flips each edge that may be flipped, is not `kept` (sorted), and that `wants` of it, in turn from both sides; returns
// the number of flips. Faces keep their indices.
template <class Wants>
std::size_t flip_edges(SurfaceMesh& mesh, const std::vector<FeatureEdge>& kept, Wants wants) {
  using Index = HalfedgeMesh::Index;
  HalfedgeMesh halfedges(mesh);
  std::size_t flips = 0;
  for (Index h = 0; h < 3 * halfedges.face_slots(); ++h) {
    const Index a = halfedges.origin(h), b = halfedges.target(h);
    if (halfedges.is_border(h)) continue;
    const Index o = halfedges.opposite(h);
    const std::uint32_t f = HalfedgeMesh::face(h), g = HalfedgeMesh::face(o);
    const Index c = halfedges.target(HalfedgeMesh::next(h)), d = halfedges.target(HalfedgeMesh::next(o));
    const Flip flip{{a, b}, {f, g}, {halfedges.triangle(f), halfedges.triangle(g)}, {Triangle{a, d, c}, {d, b, c}}};
    if (!wants(flip) || std::binary_search(kept.begin(), kept.end(), feature_edge(a, b)) || !halfedges.can_flip(h))
      continue;
    halfedges.flip(h);
    ++flips;
  }
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) mesh.triangles[f] = halfedges.triangle(f);
  return flips;
}

bool share_a_vertex(const Triangle& a, const Triangle& b) {
  return std::any_of(a.begin(), a.end(), [&](std::uint32_t v) { return std::find(b.begin(), b.end(), v) != b.end(); });
}

}  // namespace

double signed_quality(const SurfaceMesh& mesh, const Triangle& t, const Vec3& normal) {
  const double quality = 1 / eta(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  return area_vector(mesh, t).dot(normal) < 0 ? -quality : quality;
}

void smooth_worst(SurfaceMesh& mesh, const ReferenceSurface& scan, const std::vector<std::uint32_t>& near,
                  const std::vector<bool>& movable, int sweeps) {
  const VertexStars stars(mesh);
  const WalkableMesh on{scan.mesh, scan.stars, scan.neighbours, scan.face_normals};
  constexpr std::array<double, 4> parts{1, 0.5, 0.25, 0.1};
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    bool helped = false;
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      const std::span<const std::uint32_t> corners = stars.corners(v);
      if (!movable[v] || corners.empty()) continue;
      Vec3 best = mesh.vertices[v];
      double best_quality = worst_of_star(mesh, scan, near, corners);
      const Vec3 start = mesh.vertices[v];
      const Vec3 towards = centroid_of_link(mesh, corners);
      const std::uint32_t scan_vertex = near[corners.front() / 3];
      const Vec3& normal = scan.vertex_normals[scan_vertex];
      const auto consider = [&](const Vec3& p) {
        mesh.vertices[v] = p;
        const double quality = worst_of_star(mesh, scan, near, corners);
        if (quality > best_quality + 1e-3) {
          best_quality = quality;
          best = p;
          helped = true;
        }
      };
      for (const double part : parts) {
        const Vec3 p = start + part * (towards - start);
        consider(p);
        consider(
            point_at(scan.mesh, descend_to_nearest(on, {p, normal, 0}, scan.stars.corners(scan_vertex).front() / 3)));
      }
      mesh.vertices[v] = best;
    }
    if (!helped) return;
  }
}

std::size_t flip_worst(SurfaceMesh& mesh, const ReferenceSurface& scan, const std::vector<std::uint32_t>& near,
                       const std::vector<bool>& around, const std::vector<FeatureEdge>& kept) {
  return flip_edges(mesh, kept, [&](const Flip& flip) {
    if (!around[flip.edge[0]] || !around[flip.edge[1]]) return false;
    const auto worse_quality = [&](const std::array<Triangle, 2>& faces) {
      return std::min(signed_quality(mesh, faces[0], scan.vertex_normals[near[flip.faces[0]]]),
                      signed_quality(mesh, faces[1], scan.vertex_normals[near[flip.faces[1]]]));
    };
    // For less than 0.05 an edge would flip to and fro, with the fits between the flips. It seldom decides: 0 and 0.3
    // give the same Horse, igea and fandisk at 8,000 faces.
    return worse_quality(flip.after) > worse_quality(flip.before) + 0.05;
  });
}

std::size_t flip_caps(SurfaceMesh& mesh, const std::vector<FeatureEdge>& kept) {
  const auto is_cap = [&](const Triangle& t) {
    return 1 / eta(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]) < cap_quality;
  };
  if (std::none_of(mesh.triangles.begin(), mesh.triangles.end(), is_cap)) return 0;
  return flip_edges(mesh, kept, [&](const Flip& flip) {
    const auto& [cap, beside] = flip.before;
    if (!is_cap(cap) || is_cap(beside)) return false;
    const Vec3 normal = area_vector(mesh, beside);
    return std::all_of(flip.after.begin(), flip.after.end(),
                       [&](const Triangle& t) { return signed_quality(mesh, t, normal) >= cap_quality; });
  });
}

bool push_apart(SurfaceMesh& mesh, const ReferenceSurface& scan, const std::vector<std::uint32_t>& near,
                const std::vector<FacePair>& crossings, const VertexConstraints& constraints) {
  // The difference of two unit normals 29 degrees apart: sheets that cross at less do not tell which way is apart.
  constexpr double least_difference = 0.5;
  // A quarter of an edge, for each of the two sheets.
  constexpr int most_steps = 16;
  const double step = scan.mean_edge(mesh.triangles.size()) / 64;
  std::vector<FacePair> pairs = crossings;
  for (int k = 0; k < most_steps; ++k) {
    std::erase_if(pairs,
                  [&](const FacePair& p) { return share_a_vertex(mesh.triangles[p.face], mesh.triangles[p.other]); });
    if (pairs.empty()) return true;
    std::vector<Vec3> push(mesh.vertices.size(), Vec3::Zero());
    std::vector<std::uint32_t> faces;
    for (const FacePair& p : pairs) {
      const Triangle& t = mesh.triangles[p.face];
      const Triangle& u = mesh.triangles[p.other];
      Vec3 apart = area_vector(mesh, t).normalized() - area_vector(mesh, u).normalized();
      if (apart.norm() < least_difference) continue;
      apart.normalize();
      if (apart.dot(scan.mesh.vertices[near[p.face]] - scan.mesh.vertices[near[p.other]]) < 0) apart = -apart;
      for (const std::uint32_t v : t) push[v] += apart;
      for (const std::uint32_t v : u) push[v] -= apart;
      faces.insert(faces.end(), {p.face, p.other});
    }
    if (faces.empty()) return false;
    for (std::uint32_t v = 0; v < push.size(); ++v) {
      const bool fixed = !constraints.empty() && constraints[v] == VertexConstraint::fixed;
      // A push is a sum of unit vectors. Where it is this short they cancel, as at a vertex between two sheets that
      // push it both ways, and its direction would be that of rounding.
      if (!fixed && push[v].norm() > 0.1) mesh.vertices[v] += step * push[v].normalized();
    }
    // Their neighbours moved along: all faces around the pairs are checked.
    const std::vector<bool> touched = vertices_around(mesh, faces, 0);
    faces.clear();
    for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
      const Triangle& t = mesh.triangles[f];
      if (touched[t[0]] || touched[t[1]] || touched[t[2]]) faces.push_back(f);
    }
    pairs = find_self_intersections(mesh, faces);
  }
  return false;
}

}  // namespace scan2fea
