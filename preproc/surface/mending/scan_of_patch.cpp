#include "preproc/surface/mending/scan_of_patch.hpp"

#include "preproc/surface/kernel/locate.hpp"
#include "preproc/surface/kernel/nearest.hpp"
#include "preproc/surface/sizing/split_long_edges.hpp"
#include "quality/triangle_measures.hpp"
#include "quality/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace scan2fea {
namespace {

// Scan triangles longer than this part of the mean edge are cut, so that a patch answers for parts of large ones.
constexpr double longest_scan_edge = 0.7;
// Within this part of the limit of the surface around, vertices of the scan are held by it: what lies between them may
// be a little farther.
constexpr double held_within = 0.75;

// The scan with its triangles cut where they are long, for a mesh of this edge length.
SurfaceMesh cut_fine(const SurfaceMesh& scan, double edge) {
  const double longest = longest_scan_edge * edge;
  const bool is_fine = std::all_of(scan.triangles.begin(), scan.triangles.end(), [&](const Triangle& t) {
    const Vec3 &a = scan.vertices[t[0]], &b = scan.vertices[t[1]], &c = scan.vertices[t[2]];
    return std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}) <= longest * longest;
  });
  if (is_fine) return scan;
  return refine_scan(scan, {std::vector<double>(scan.vertices.size(), edge)}, longest_scan_edge, 8).mesh;
}

// Per face of the scan, the face of the mesh that it belongs to: the nearest, or where that looks another way, as
// across a wall, the nearest of those that do not.
std::vector<std::uint32_t> faces_beneath(const SurfaceMesh& scan, const SurfaceMesh& mesh, double edge) {
  const MeshAdjacency adjacency(mesh);
  const std::vector<Vec3> normals = face_normals(mesh), scan_normals = face_normals(scan);
  const WalkableMesh on{mesh, adjacency.stars, adjacency.neighbours, normals};
  const TriangleTree tree(mesh);
  constexpr double alike = 0.6;  // cosine of 53 degrees, as where samples are located
  std::vector<std::uint32_t> beneath(scan.triangles.size()), astray;
  std::vector<Vec3> points, their_normals;
  std::uint32_t hint = tree.leaf_order().front();
  for (std::uint32_t f = 0; f < beneath.size(); ++f) {
    const Vec3 centre = centroid(scan, scan.triangles[f]);
    beneath[f] = hint = tree.closest(centre, hint).triangle;
    if (normals[hint].dot(scan_normals[f]) > alike) continue;
    astray.push_back(f);
    points.push_back(centre);
    their_normals.push_back(scan_normals[f]);
  }
  if (astray.empty()) return beneath;
  const std::vector<std::uint32_t> start = nearest_vertices(points, their_normals, mesh, edge);
  for (std::size_t i = 0; i < astray.size(); ++i) {
    const std::uint32_t first = adjacency.stars.corners(start[i]).front() / 3;
    beneath[astray[i]] = descend_to_nearest(on, {points[i], their_normals[i], 0}, first).face;
  }
  return beneath;
}

// Per point of the scan, whether it is the patch's to come within the limit of: nearer to it than to the surface
// around, and too far from that.
std::vector<bool> left_to_patch(const std::vector<Vec3>& points, const SurfaceMesh& patch, const SurfaceMesh& frozen,
                                double limit) {
  std::vector<bool> left(points.size(), true);
  if (frozen.triangles.empty()) return left;
  const TriangleTree of_patch(patch), of_frozen(frozen);
  std::uint32_t hint = of_patch.leaf_order().front();
  for (std::size_t i = 0; i < points.size(); ++i) {
    left[i] = !of_frozen.closest_within(points[i], held_within * limit);
    if (!left[i]) continue;
    const ClosestPoint own = of_patch.closest(points[i], hint);
    hint = own.triangle;
    left[i] = !of_frozen.closest_within(points[i], std::sqrt(own.squared_distance));
  }
  return left;
}

}  // namespace

SurfaceMesh part_of(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& faces,
                    std::vector<std::uint32_t>& vertices) {
  std::unordered_map<std::uint32_t, std::uint32_t> place;
  for (std::uint32_t i = 0; i < vertices.size(); ++i) place.emplace(vertices[i], i);
  SurfaceMesh part;
  part.triangles.reserve(faces.size());
  for (const std::uint32_t f : faces) {
    Triangle t = mesh.triangles[f];
    for (std::uint32_t& v : t) {
      const auto [at, is_new] = place.emplace(v, static_cast<std::uint32_t>(vertices.size()));
      if (is_new) vertices.push_back(v);
      v = at->second;
    }
    part.triangles.push_back(t);
  }
  part.vertices.reserve(vertices.size());
  for (const std::uint32_t v : vertices) part.vertices.push_back(mesh.vertices[v]);
  return part;
}

ScanOfPatch::ScanOfPatch(const SurfaceMesh& scan, const std::vector<std::uint32_t>& scan_faces,
                         const SurfaceMesh& patch, const SurfaceMesh& frozen, const SurfaceMesh& whole, double edge,
                         double limit) {
  std::vector<std::uint32_t> vertices;
  scan_ = part_of(scan, scan_faces, vertices);
  reference_.emplace(scan_);
  const SurfaceMesh fine = cut_fine(scan_, edge);
  const std::vector<std::uint32_t> beneath = faces_beneath(fine, whole, edge);
  const std::vector<bool> is_free = left_to_patch(fine.vertices, patch, frozen, limit);
  std::vector<std::uint32_t> fits, answered, near(fine.vertices.size(), 0);
  for (std::uint32_t f = 0; f < fine.triangles.size(); ++f) {
    const Triangle& t = fine.triangles[f];
    if (is_free[t[0]] || is_free[t[1]] || is_free[t[2]]) answered.push_back(f);
    if (beneath[f] >= patch.triangles.size()) continue;
    fits.push_back(f);
    for (const std::uint32_t v : t) near[v] = patch.triangles[beneath[f]][0];
  }
  std::vector<std::uint32_t> of_fit, of_answered;
  answered_ = part_of(fine, answered, of_answered);
  for (const std::uint32_t v : of_answered)
    if (is_free[v]) to_answer_.push_back(fine.vertices[v]);
  for (const Triangle& t : answered_.triangles)
    if (std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return is_free[of_answered[v]]; }))
      to_answer_.push_back(centroid(answered_, t));
  fit_part_ = part_of(fine, fits, of_fit);
  for (const std::uint32_t v : of_fit) start_of_fit_.push_back(near[v]);
  if (!fit_part_.triangles.empty()) fit_.emplace(fit_part_);
}

}  // namespace scan2fea
