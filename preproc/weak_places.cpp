#include "preproc/weak_places.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/numbers.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "quality/self_intersections.hpp"
#include "quality/tetrahedron_measures.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <optional>
#include <span>

namespace scan2fea {
namespace {

constexpr double large_edge_ratio = 10;  // CalculiX and Abaqus warn of larger ones
// The scan is "about as sharp" up to so many times the angle that an unusable one has.
constexpr double as_sharp = 2;
constexpr double sharp_edge_deg = 30;  // edges that bound a corner of the part

// The worst of both figures over all cells, and which cell it was.
struct Worst {
  double angle_deg = 180;
  double edge_ratio = 1;
  std::size_t sharpest = 0, longest = 0;

  void meet(std::size_t cell, double angle, double ratio) {
    if (angle < angle_deg) {
      angle_deg = angle;
      sharpest = cell;
    }
    if (ratio > edge_ratio) {
      edge_ratio = ratio;
      longest = cell;
    }
  }
};

Worst worst_of(const SurfaceMesh& mesh) {
  Worst worst;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto& [a, b, c] = mesh.triangles[f];
    const auto shape = measure_triangle(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
    worst.meet(f, shape ? shape->min_angle_deg : 0, shape ? shape->edge_ratio : std::numeric_limits<double>::max());
  }
  return worst;
}

Worst worst_of(const TetMesh& mesh, std::size_t flat_tetrahedra) {
  Worst worst;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const TetShape shape = measure_tetrahedron(mesh, t);
    if (t < flat_tetrahedra && shape.min_dihedral_deg >= unusable_angle_deg) continue;
    worst.meet(t, shape.min_dihedral_deg, shape.edge_ratio.value_or(std::numeric_limits<double>::max()));
  }
  return worst;
}

Ball ball_of(const std::vector<Vec3>& points, std::span<const std::uint32_t> cell) {
  Ball ball{Vec3::Zero(), 0};
  for (const std::uint32_t v : cell) ball.centre += points[v] / static_cast<double>(cell.size());
  for (const std::uint32_t v : cell)
    for (const std::uint32_t w : cell) ball.radius = std::max(ball.radius, (points[v] - points[w]).norm());
  return ball;
}

// The sharpest edge between two faces, inwards or outwards, or corner between two sharp edges, within the ball.
double sharpest_of_scan(const SurfaceMesh& scan, const Ball& ball) {
  const MeshAdjacency adjacency(scan);
  double sharpest = 180;
  std::vector<std::array<std::uint32_t, 2>> sharp;
  for (std::uint32_t f = 0; f < scan.triangles.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t g = adjacency.neighbours[f][k];
      const std::uint32_t a = scan.triangles[f][(k + 1) % 3], b = scan.triangles[f][(k + 2) % 3];
      if (g == no_face || g < f) continue;
      const Vec3 &p = scan.vertices[a], &q = scan.vertices[b];
      const double along = std::clamp((ball.centre - p).dot(q - p) / (q - p).squaredNorm(), 0.0, 1.0);
      if ((p + along * (q - p) - ball.centre).norm() > ball.radius) continue;
      const double turn =
          angle_between(area_vector(scan, scan.triangles[f]), area_vector(scan, scan.triangles[g])) * degrees;
      sharpest = std::min(sharpest, 180 - turn);
      if (turn > sharp_edge_deg) sharp.push_back({a, b});
    }
  for (const auto& first : sharp)
    for (const auto& second : sharp)
      for (const std::size_t i : {0U, 1U})
        for (const std::size_t j : {0U, 1U})
          if (first != second && first[i] == second[j])
            sharpest = std::min(sharpest, angle_deg(scan.vertices[first[i]], scan.vertices[first[1 - i]],
                                                    scan.vertices[second[1 - j]]));
  return sharpest;
}

}  // namespace

std::string WeakPlace::describe() const {
  char text[192];
  std::snprintf(text, sizeof text, "%s %.3g at (%.6g, %.6g, %.6g), %s %g", what.c_str(), value, at.x(), at.y(), at.z(),
                value < limit ? "below" : "above", limit);
  return text;
}

std::vector<WeakPlace> find_weak_places(const SurfaceMesh& surface, const TetMesh* volume_mesh, const SurfaceMesh& scan,
                                        std::size_t flat_tetrahedra) {
  const Worst worst = volume_mesh != nullptr ? worst_of(*volume_mesh, flat_tetrahedra) : worst_of(surface);
  const auto ball = [&](std::size_t cell) {
    return volume_mesh != nullptr ? ball_of(volume_mesh->nodes, volume_mesh->tetrahedra[cell])
                                  : ball_of(surface.vertices, surface.triangles[cell]);
  };
  std::vector<WeakPlace> places;
  if (worst.angle_deg < small_angle_deg) {
    const Ball where = ball(worst.sharpest);
    places.push_back({.what = volume_mesh != nullptr ? "smallest dihedral angle" : "smallest angle of a triangle",
                      .value = worst.angle_deg,
                      .limit = small_angle_deg,
                      .at = where.centre,
                      .is_unusable = worst.angle_deg < unusable_angle_deg &&
                                     sharpest_of_scan(scan, where) > as_sharp * unusable_angle_deg});
  }
  if (worst.edge_ratio > large_edge_ratio)
    places.push_back({.what = "largest edge ratio",
                      .value = worst.edge_ratio,
                      .limit = large_edge_ratio,
                      .at = ball(worst.longest).centre});
  return places;
}

void refuse_unusable(const std::vector<WeakPlace>& places) {
  for (const WeakPlace& place : places)
    if (place.is_unusable)
      throw NotMeshable({.what = "no solver takes the mesh that came out: " + place.what,
                         .where = {},
                         .value = std::to_string(place.value),
                         .limit = "half a degree",
                         .advice = "smaller triangles (--deviation, --faces), or --feature-angle off",
                         .at = place.at});
}

void refuse_crossings(const SurfaceMesh& surface) {
  const std::vector<FacePair> crossings = find_self_intersections(surface);
  if (crossings.empty()) return;
  throw NotMeshable({.what = "no solver takes the mesh that came out: its surface runs through itself",
                     .where = {},
                     .value = std::to_string(crossings.size()) + " pairs of triangles",
                     .limit = {},
                     .advice = "another number of triangles (--faces, --deviation), or --feature-angle off",
                     .at = centroid(surface, surface.triangles[crossings.front().face])});
}

}  // namespace scan2fea
