#include "preproc/symmetry/half_scan.hpp"

#include "preproc/surface/kernel/cut_surface.hpp"
#include "preproc/surface/kernel/unused_vertices.hpp"
#include "preproc/surface/sizing/split_long_edges.hpp"
#include "preproc/symmetry/fill_outline.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

// Vertices that are all but on the plane.
void put_onto_plane(SurfaceMesh& mesh) {
  constexpr double share_of_edge = 0.02;
  std::vector<double> shortest(mesh.vertices.size(), HUGE_VAL);
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = (mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]).norm();
      for (const std::uint32_t v : {t[k], t[(k + 1) % 3]}) shortest[v] = std::min(shortest[v], length);
    }
  for (std::size_t v = 0; v < shortest.size(); ++v)
    if (std::abs(mesh.vertices[v].x()) < share_of_edge * shortest[v]) mesh.vertices[v].x() = 0;
}

void split_at_plane(SurfaceMesh& mesh) {
  std::vector<EdgeSplit> splits;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const FeatureEdge edge = feature_edge(t[k], t[(k + 1) % 3]);
      const double a = mesh.vertices[edge[0]].x(), b = mesh.vertices[edge[1]].x();
      if (t[k] == edge[0] && ((a < 0 && b > 0) || (a > 0 && b < 0))) splits.push_back({edge, a / (a - b)});
    }
  const std::size_t before = mesh.vertices.size();
  std::vector<double> no_lengths(before, 0);
  std::vector<FeatureEdge> no_features;
  split_edges(mesh, no_lengths, no_features, splits);
  for (std::size_t v = before; v < mesh.vertices.size(); ++v) mesh.vertices[v].x() = 0;
}

}  // namespace

MirrorFrame::MirrorFrame(const MirrorPlane& plane) : offset_(plane.offset) {
  for (int k = 0; k < 3; ++k)
    if (plane.normal == Vec3::Unit(k)) {
      axes_ = {Vec3::Unit(k), Vec3::Unit((k + 1) % 3), Vec3::Unit((k + 2) % 3)};
      return;
    }
  axes_[0] = plane.normal;
  axes_[1] = plane.normal.unitOrthogonal();
  axes_[2] = plane.normal.cross(axes_[1]);
}

Vec3 MirrorFrame::to_frame(const Vec3& p) const {
  return {axes_[0].dot(p) - offset_, axes_[1].dot(p), axes_[2].dot(p)};
}

Vec3 MirrorFrame::from_frame(const Vec3& p) const {
  return (p.x() + offset_) * axes_[0] + p.y() * axes_[1] + p.z() * axes_[2];
}

HalfScan halve(const SurfaceMesh& scan, const MirrorFrame& frame) {
  HalfScan half;
  half.mesh = scan;
  for (Vec3& p : half.mesh.vertices) p = frame.to_frame(p);
  put_onto_plane(half.mesh);
  split_at_plane(half.mesh);
  std::erase_if(half.mesh.triangles, [&](const Triangle& t) {
    return std::ranges::none_of(t, [&](std::uint32_t v) { return half.mesh.vertices[v].x() > 0; });
  });
  drop_unused_vertices(half.mesh);
  const std::vector<FeatureEdge> border = boundary_edges(half.mesh);
  half.cut_lines = lines_of(half.mesh, border);
  const double outside = surface_area(half.mesh);
  const std::vector<Triangle> cut = fill_outline(half.mesh.vertices, border);
  half.cut_faces = cut.size();
  half.mesh.triangles.insert(half.mesh.triangles.end(), cut.begin(), cut.end());
  half.cut_share = 1 - outside / surface_area(half.mesh);
  return half;
}

FeatureLines lines_on_half(const FeatureLines& lines, const MirrorFrame& frame) {
  FeatureLines half;
  for (const bool other_side : {false, true}) {
    const auto first = static_cast<std::uint32_t>(half.points.size());
    for (const Vec3& p : lines.points) {
      const Vec3 q = frame.to_frame(p);
      half.points.push_back(other_side ? MirrorFrame::mirrored(q) : q);
    }
    for (const auto& [a, b] : lines.segments) {
      const double x = half.points[first + a].x() + half.points[first + b].x();
      if (x > 0 || (x == 0 && !other_side)) half.segments.push_back({first + a, first + b});
    }
  }
  return half;
}

}  // namespace scan2fea
