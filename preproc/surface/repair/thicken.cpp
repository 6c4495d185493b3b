#include "preproc/surface/repair/thicken.hpp"

#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/repair/shells.hpp"
#include "preproc/surface/repair/soup_adjacency.hpp"

#include <Eigen/Cholesky>

#include <algorithm>

namespace scan2fea {
namespace {

// Such that the planes of the vertex's faces move by 1.
Vec3 direction_at(const SurfaceMesh& mesh, const VertexStars& stars, std::uint32_t v) {
  constexpr double damping = 1e-6;  // along the plane, which its face says nothing of
  constexpr double farthest = 3;
  Eigen::Matrix3d planes = Eigen::Matrix3d::Zero();
  Vec3 sum = Vec3::Zero();
  for (const std::uint32_t corner : stars.corners(v)) {
    const Vec3 area = area_vector(mesh, mesh.triangles[corner / 3]);
    if (area.isZero()) continue;
    planes += area * area.transpose() / area.norm();
    sum += area;
  }
  const double weight = planes.trace();
  if (!(weight > 0)) return Vec3::Zero();
  // Damped towards the mean normal, which fills in what a single plane leaves open.
  const Vec3 mean = sum.normalized();
  planes += damping * weight * Eigen::Matrix3d::Identity();
  const Vec3 move = planes.ldlt().solve(Vec3(sum + damping * weight * mean));
  return move * std::min(1.0, farthest / move.norm());
}

}  // namespace

void thicken_sheets(SurfaceMesh& mesh, const Thickness& thickness, RepairResult& result) {
  const double front = thickness.side == ThickenTo::both    ? thickness.thickness / 2
                       : thickness.side == ThickenTo::front ? thickness.thickness
                                                            : 0;
  const VertexStars stars(mesh);
  const Twins twins = find_twins(mesh);
  const SurfaceMesh sheets = mesh;
  for (const Shell& shell : find_shells(sheets, true)) {
    if (!shell.open) continue;
    std::vector<std::uint32_t> behind(sheets.vertices.size(), no_twin);
    for (const std::uint32_t f : shell.faces) {
      Triangle back = sheets.triangles[f];
      for (std::uint32_t& v : back) {
        if (behind[v] == no_twin) {
          const Vec3 direction = direction_at(sheets, stars, v);
          behind[v] = static_cast<std::uint32_t>(mesh.vertices.size());
          mesh.vertices.push_back(sheets.vertices[v] + (front - thickness.thickness) * direction);
          mesh.vertices[v] = sheets.vertices[v] + front * direction;
        }
        v = behind[v];
      }
      mesh.triangles.push_back({back[0], back[2], back[1]});
    }
    for (const std::uint32_t f : shell.faces)
      for (std::uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
        if (twins[h] != no_twin) continue;
        const std::uint32_t a = start_vertex(sheets, h), b = end_vertex(sheets, h);
        mesh.triangles.push_back({b, a, behind[a]});
        mesh.triangles.push_back({b, behind[a], behind[b]});
      }
    result.changes.push_back(
        {RepairKind::ThickenedSheet, (shell.box.low + shell.box.high) / 2, thickness.thickness, shell.area});
  }
  result.faces_added += mesh.triangles.size() - sheets.triangles.size();
}

}  // namespace scan2fea
