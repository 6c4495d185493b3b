#include "preproc/surface/simplification/plane_patches.hpp"

#include "preproc/surface/kernel/adjacency.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

namespace scan2fea {
namespace {

constexpr double plane_of_diagonal = 1e-6;
// Around what is turned over, in triangles; and how often.
constexpr int rings = 4, sweeps = 60;
// Of the mean area of the triangles around: less is none.
constexpr double least_area = 0.02;

struct PatchPlane {
  Vec3 point = Vec3::Zero(), normal = Vec3::Zero();  // the sum of its triangles' area vectors at first
  bool is_plane = true;
};

std::map<std::uint32_t, PatchPlane> planes_of(const ReferenceSurface& scan) {
  std::map<std::uint32_t, PatchPlane> planes;
  const auto patch = [&](const Triangle& t) { return scan.patch_of_vertex.empty() ? 0 : scan.patch_of_vertex[t[0]]; };
  for (const Triangle& t : scan.mesh.triangles) {
    PatchPlane& plane = planes[patch(t)];
    plane.normal += area_vector(scan.mesh, t);
    plane.point = scan.mesh.vertices[t[0]];
  }
  for (auto& [number, plane] : planes) plane.normal.normalize();
  for (const Triangle& t : scan.mesh.triangles) {
    PatchPlane& plane = planes[patch(t)];
    for (const std::uint32_t v : t)
      if (!(std::abs(plane.normal.dot(scan.mesh.vertices[v] - plane.point)) <= plane_of_diagonal * scan.diagonal))
        plane.is_plane = false;
  }
  return planes;
}

class Flattening {
 public:
  Flattening(SurfaceMesh& mesh, const FeatureNet& net, const ReferenceSurface& scan)
      : mesh_(mesh),
        patch_of_face_(net.patch_of_face.empty() ? std::vector<std::uint32_t>(mesh.triangles.size(), 0)
                                                 : net.patch_of_face),
        planes_(planes_of(scan)),
        is_held_(vertices_on_lines(net, mesh.vertices.size())),
        stars_(mesh) {}

  std::size_t run() {
    for (std::uint32_t f = 0; f < patch_of_face_.size(); ++f)
      for (const std::uint32_t v : mesh_.triangles[f])
        if (const PatchPlane* plane = plane_of(f); plane != nullptr && !is_held_[v])
          mesh_.vertices[v] -= plane->normal.dot(mesh_.vertices[v] - plane->point) * plane->normal;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      const std::vector<std::uint32_t> turned = turned_over();
      if (turned.empty()) return 0;
      relax_around(turned);
    }
    return turned_over().size();
  }

 private:
  const PatchPlane* plane_of(std::uint32_t f) const {
    const auto at = planes_.find(patch_of_face_[f]);
    return at != planes_.end() && at->second.is_plane ? &at->second : nullptr;
  }

  std::vector<std::uint32_t> turned_over() const {
    std::vector<std::uint32_t> turned;
    const double edge = mean_edge_length(mesh_);
    for (std::uint32_t f = 0; f < patch_of_face_.size(); ++f) {
      const PatchPlane* plane = plane_of(f);
      if (plane == nullptr) continue;
      const Triangle& t = mesh_.triangles[f];
      double longest = 0;
      for (std::size_t k = 0; k < 3; ++k)
        longest = std::max(longest, (mesh_.vertices[t[k]] - mesh_.vertices[t[(k + 1) % 3]]).norm());
      if (area_vector(mesh_, t).dot(plane->normal) <= least_area * longest * std::min(longest, edge))
        turned.push_back(f);
    }
    return turned;
  }

  // Towards the middle of their neighbours.
  void relax_around(const std::vector<std::uint32_t>& turned) {
    std::vector<bool> is_near(mesh_.vertices.size(), false);
    std::vector<std::uint32_t> near;
    const auto add = [&](std::uint32_t f) {
      for (const std::uint32_t v : mesh_.triangles[f])
        if (!is_near[v]) {
          is_near[v] = true;
          near.push_back(v);
        }
    };
    for (const std::uint32_t f : turned) add(f);
    for (int ring = 1; ring < rings; ++ring)
      for (std::size_t i = 0, count = near.size(); i < count; ++i)
        for (const std::uint32_t corner : stars_.corners(near[i])) add(corner / 3);
    std::sort(near.begin(), near.end());
    for (const std::uint32_t v : near) {
      if (is_held_[v] || !is_in_plane(v)) continue;
      mesh_.vertices[v] = middle_of_neighbours(mesh_, stars_, v);
    }
  }

  bool is_in_plane(std::uint32_t v) const {
    return std::ranges::all_of(stars_.corners(v),
                               [&](std::uint32_t corner) { return plane_of(corner / 3) != nullptr; });
  }

  SurfaceMesh& mesh_;
  std::vector<std::uint32_t> patch_of_face_;
  std::map<std::uint32_t, PatchPlane> planes_;
  std::vector<bool> is_held_;
  VertexStars stars_;
};

}  // namespace

std::size_t flatten_plane_patches(SurfaceMesh& mesh, const FeatureNet& net, const ReferenceSurface& scan) {
  return Flattening(mesh, net, scan).run();
}

}  // namespace scan2fea
