#include "preproc/surface/fit/preserve_volume.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/components.hpp"
#include "preproc/surface/kernel/nearest.hpp"
#include "quality/self_intersections.hpp"
#include "quality/validity.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

namespace scan2fea {
namespace {

// The part of a volume that may be missing in the end: far above rounding, far below any other error.
constexpr double largest_rest = 1e-9;

// The parts of a surface that hang together, without the vertices that have no triangle.
struct Parts {
  std::vector<std::uint32_t> of_vertex;           // no_face without a triangle
  std::vector<std::vector<std::uint32_t>> faces;  // of each part, ascending

  explicit Parts(const SurfaceMesh& mesh) : of_vertex(mesh.vertices.size(), no_face) {
    const Components components = find_components(mesh);
    std::vector<std::uint32_t> number(components.count, no_face);
    for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
      std::uint32_t& part = number[components.of_vertex[mesh.triangles[f][0]]];
      if (part == no_face) {
        part = static_cast<std::uint32_t>(faces.size());
        faces.emplace_back();
      }
      faces[part].push_back(f);
    }
    for (std::size_t v = 0; v < of_vertex.size(); ++v) of_vertex[v] = number[components.of_vertex[v]];
  }
};

// About `centre`, so that far-off coordinates cost no digits.
double volume_of(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& faces, const Vec3& centre) {
  double six_volumes = 0;
  for (const std::uint32_t f : faces) {
    const Triangle& t = mesh.triangles[f];
    const Vec3 a = mesh.vertices[t[0]] - centre;
    six_volumes += a.dot((mesh.vertices[t[1]] - centre).cross(mesh.vertices[t[2]] - centre));
  }
  return six_volumes / 6;
}

// Per part of `mesh` the part of `like` that most of its vertices lie nearest to; empty where two share one.
std::vector<std::uint32_t> pair_parts(const SurfaceMesh& mesh, const Parts& parts, const SurfaceMesh& like,
                                      const Parts& like_parts) {
  const std::size_t count = parts.faces.size();
  if (count != like_parts.faces.size()) return {};
  if (count == 1) return {0};
  const double spacing = std::sqrt(surface_area(like) / static_cast<double>(like.triangles.size()));
  const std::vector<std::uint32_t> nearest = nearest_vertices(mesh.vertices, vertex_normals(mesh), like, spacing);
  std::vector<std::vector<std::uint32_t>> votes(count, std::vector<std::uint32_t>(count, 0));
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if (parts.of_vertex[v] != no_face) ++votes[parts.of_vertex[v]][like_parts.of_vertex[nearest[v]]];
  }
  std::vector<std::uint32_t> pair(count);
  std::vector<bool> taken(count, false);
  for (std::size_t c = 0; c < count; ++c) {
    pair[c] = static_cast<std::uint32_t>(std::max_element(votes[c].begin(), votes[c].end()) - votes[c].begin());
    if (taken[pair[c]]) return {};
    taken[pair[c]] = true;
  }
  return pair;
}

// Newton's method on the volume as a function of the shift; its derivative is the area swept by the moving vertices.
// The normals stay those of the start, so the volume is a cubic, nearly linear one, and three or four steps reach the
// rounding of the coordinates. Returns the shift.
double shift_to_volume(SurfaceMesh& mesh, const std::vector<std::uint32_t>& faces, double volume, const Vec3& centre,
                       const std::vector<Vec3>& directions) {
  std::vector<std::uint32_t> vertices;
  double doubled_area = 0;
  double edges = 0;
  for (const std::uint32_t f : faces) {
    const Triangle& t = mesh.triangles[f];
    vertices.insert(vertices.end(), t.begin(), t.end());
    doubled_area += area_vector(mesh, t).norm();
    edges += (mesh.vertices[t[1]] - mesh.vertices[t[0]]).norm() / static_cast<double>(faces.size());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());

  constexpr int most_steps = 8;
  double total = 0;
  for (int step = 0; step < most_steps; ++step) {
    const double missing = volume - volume_of(mesh, faces, centre);
    double swept = 0;
    for (const std::uint32_t f : faces) {
      const Triangle& t = mesh.triangles[f];
      swept += area_vector(mesh, t).dot(directions[t[0]] + directions[t[1]] + directions[t[2]]) / 6;
    }
    if (!(swept > 0)) break;
    const double shift = missing / swept;
    total += shift;
    if (std::abs(total) > edges) {
      throw NotMeshable({.what = "volume cannot be kept",
                         .where = "component of " + std::to_string(faces.size()) + " triangles",
                         .value = "shift of " + std::to_string(total),
                         .limit = "mean edge length " + std::to_string(edges),
                         .advice = "use more triangles"});
    }
    for (const std::uint32_t v : vertices) mesh.vertices[v] += shift * directions[v];
    if (std::abs(missing) <= 1e-14 * doubled_area * edges) break;
  }
  // No free vertex, or a surface so coarse that its normals do not tell which way is out.
  const double missing = volume - volume_of(mesh, faces, centre);
  if (std::abs(missing) > largest_rest * std::abs(volume)) {
    throw NotMeshable({.what = "volume cannot be kept",
                       .where = "component of " + std::to_string(faces.size()) + " triangles",
                       .value = std::to_string(volume - missing),
                       .limit = std::to_string(volume),
                       .advice = "use more triangles"});
  }
  return total;
}

// A part's plane faces stay plane as long as something else can give the volume: vertices in them get no direction,
// unless that leaves too little of the component's area to move.
void hold_planes(const SurfaceMesh& mesh, const Parts& parts, const std::vector<Vec3>& outwards,
                 std::vector<Vec3>& directions) {
  std::vector<Vec3> all = directions;
  std::vector<bool> is_plane = vertices_in_planes(mesh);
  for (std::size_t v = 0; v < outwards.size(); ++v) {
    if (outwards[v].isZero()) continue;
    all[v] = outwards[v];
    is_plane[v] = true;
  }
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
    if (is_plane[v]) directions[v].setZero();
  for (const std::vector<std::uint32_t>& faces : parts.faces) {
    double moving = 0, whole = 0;
    for (const std::uint32_t f : faces)
      for (const std::uint32_t v : mesh.triangles[f]) {
        const double area = area_vector(mesh, mesh.triangles[f]).norm();
        whole += area;
        if (!directions[v].isZero()) moving += area;
      }
    if (moving >= least_moving_area * whole) continue;
    for (const std::uint32_t f : faces)
      for (const std::uint32_t v : mesh.triangles[f]) directions[v] = all[v];
  }
}

}  // namespace

std::vector<bool> vertices_in_planes(const SurfaceMesh& mesh) {
  const std::vector<Vec3> normals = vertex_normals(mesh);
  std::vector<bool> is_plane(mesh.vertices.size(), true);
  for (const Triangle& t : mesh.triangles) {
    const Vec3 area = area_vector(mesh, t);
    for (const std::uint32_t v : t)
      if (area.cross(normals[v]).norm() > plane_rad * area.norm()) is_plane[v] = false;
  }
  return is_plane;
}

VolumeShift preserve_volume(SurfaceMesh& mesh, const SurfaceMesh& like, const VertexConstraints& constraints,
                            const std::vector<Vec3>& outwards) {
  if (mesh.triangles.empty() || like.triangles.empty()) return {};
  if (!encloses_volume(mesh) || !encloses_volume(like)) {
    throw NotMeshable({.what = "no volume to keep",
                       .where = "",
                       .value = "an open surface",
                       .limit = "closed and oriented",
                       .advice = "repair the scan, or leave its holes open and the volume unkept"});
  }
  Parts parts(mesh), like_parts(like);
  std::vector<std::uint32_t> pair = pair_parts(mesh, parts, like, like_parts);
  if (pair.empty()) {
    parts.faces.assign(1, std::vector<std::uint32_t>(mesh.triangles.size()));
    like_parts.faces.assign(1, std::vector<std::uint32_t>(like.triangles.size()));
    std::iota(parts.faces[0].begin(), parts.faces[0].end(), 0U);
    std::iota(like_parts.faces[0].begin(), like_parts.faces[0].end(), 0U);
    pair = {0};
  }
  const BoundingBox box = bounding_box(like.vertices);
  const Vec3 centre = 0.5 * (box.low + box.high);
  std::vector<Vec3> directions = vertex_normals(mesh);
  for (std::size_t v = 0; v < constraints.size(); ++v) {
    if (constraints[v] == VertexConstraint::fixed) directions[v].setZero();
  }
  hold_planes(mesh, parts, outwards, directions);

  VolumeShift result{0, parts.faces.size()};
  for (std::size_t c = 0; c < parts.faces.size(); ++c) {
    const double volume = volume_of(like, like_parts.faces[pair[c]], centre);
    const double shift = shift_to_volume(mesh, parts.faces[c], volume, centre, directions);
    result.largest_displacement = std::max(result.largest_displacement, std::abs(shift));
  }
  return result;
}

bool preserve_volume_clear(SurfaceMesh& mesh, const SurfaceMesh& like, VertexConstraints constraints,
                           const std::vector<Vec3>& outwards) {
  constexpr int trials = 10;
  constraints.resize(mesh.vertices.size(), VertexConstraint::free);
  for (int trial = 0; trial < trials; ++trial) {
    SurfaceMesh shifted = mesh;
    try {
      preserve_volume(shifted, like, constraints, outwards);
    } catch (const NotMeshable&) {
      return false;
    }
    const std::vector<FacePair> crossings = find_self_intersections(shifted);
    if (crossings.empty()) {
      mesh = std::move(shifted);
      return true;
    }
    for (const FacePair& pair : crossings)
      for (const std::uint32_t f : {pair.face, pair.other})
        for (const std::uint32_t v : mesh.triangles[f]) constraints[v] = VertexConstraint::fixed;
  }
  return false;
}

}  // namespace scan2fea
