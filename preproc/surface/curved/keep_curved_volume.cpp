#include "preproc/surface/curved/keep_curved_volume.hpp"

#include "preproc/surface/fit/preserve_volume.hpp"
#include "preproc/surface/kernel/components.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

std::vector<std::vector<std::uint32_t>> faces_of_components(const SurfaceMesh& surface) {
  const Components components = find_components(surface);
  std::vector<std::vector<std::uint32_t>> faces(components.count);
  for (std::uint32_t f = 0; f < surface.triangles.size(); ++f)
    faces[components.of_vertex[surface.triangles[f][0]]].push_back(f);
  return faces;
}

Vec3 centre_of(const SurfaceMesh& surface) {
  const BoundingBox box = bounding_box(surface.vertices);
  return (box.low + box.high) / 2;
}

// Nodes around which the surface is plane get no direction, as long as enough is left to move.
void hold_planes(const CurvedSurface& surface, const std::vector<std::vector<std::uint32_t>>& components,
                 std::vector<Vec3>& directions) {
  std::vector<bool> is_plane(surface.nodes(), true);
  for (std::size_t f = 0; f < surface.corners.triangles.size(); ++f) {
    const SixNodeTriangle x = surface.triangle(f);
    for (const std::array<double, 3>& corner : {std::array{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}) {
      const auto [u, v] = tangents(x, corner);
      const Vec3 area = u.cross(v);
      for (const std::size_t i : surface.nodes_of(f))
        if (area.cross(directions[i]).norm() > plane_rad * area.norm()) is_plane[i] = false;
    }
  }
  for (const std::vector<std::uint32_t>& faces : components) {
    double moving = 0, whole = 0;
    for (const std::uint32_t f : faces) {
      const double area = area_vector(surface.corners, surface.corners.triangles[f]).norm();
      for (const std::size_t i : surface.nodes_of(f)) {
        whole += area;
        if (!is_plane[i] && !directions[i].isZero()) moving += area;
      }
    }
    if (moving < least_moving_area * whole) continue;
    for (const std::uint32_t f : faces)
      for (const std::size_t i : surface.nodes_of(f))
        if (is_plane[i]) directions[i].setZero();
  }
}

}  // namespace

std::vector<double> volumes_of_components(const SurfaceMesh& surface) {
  std::vector<double> volumes;
  const CurvedSurface straight(surface);
  for (const std::vector<std::uint32_t>& faces : faces_of_components(surface))
    volumes.push_back(curved_volume(straight, faces, centre_of(surface)));
  return volumes;
}

bool keep_curved_volume(CurvedSurface& surface, const std::vector<double>& volumes, std::vector<Vec3> directions) {
  constexpr double exact = 1e-12, kept = 1e-9, farthest_of_edge = 0.1;
  constexpr int most_steps = 8;
  const std::vector<std::vector<std::uint32_t>> components = faces_of_components(surface.corners);
  const Vec3 centre = centre_of(surface.corners);
  hold_planes(surface, components, directions);
  const double farthest = farthest_of_edge * mean_edge_length(surface.corners);
  std::vector<Vec3> gradient(surface.nodes());
  bool all_kept = true;
  for (std::size_t c = 0; c < components.size(); ++c) {
    std::vector<std::size_t> nodes;
    for (const std::uint32_t f : components[c])
      for (const std::size_t i : surface.nodes_of(f)) nodes.push_back(i);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    const auto missing_volume = [&] { return volumes[c] - curved_volume(surface, components[c], centre); };
    double total = 0;
    for (int step = 0; step < most_steps; ++step) {
      const double missing = missing_volume();
      if (std::abs(missing) <= exact * std::abs(volumes[c])) break;
      for (const std::size_t i : nodes) gradient[i].setZero();
      add_volume_gradient(surface, components[c], gradient);
      double swept = 0;
      for (const std::size_t i : nodes) swept += gradient[i].dot(directions[i]);
      const double shift = missing / swept;
      if (!(std::abs(total + shift) <= farthest)) break;
      total += shift;
      for (const std::size_t i : nodes) surface.node(i) += shift * directions[i];
    }
    all_kept = all_kept && std::abs(missing_volume()) <= kept * std::abs(volumes[c]);
  }
  return all_kept;
}

}  // namespace scan2fea
