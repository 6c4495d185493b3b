#include "preproc/surface/mending/defects.hpp"

#include "preproc/surface/kernel/cut_surface.hpp"
#include "preproc/surface/kernel/nearest.hpp"
#include "quality/triangle_measures.hpp"

#include <cmath>
#include <unordered_set>

namespace scan2fea {
namespace {

// Whether the scan has a normal on the side of `normal` at any vertex that is connected to `start` within `radius` of
// `centre`, or on any face around these: of a scan with larger triangles than the mesh, there is no other vertex.
bool scan_agrees(const ReferenceSurface& scan, std::uint32_t start, const Vec3& centre, double radius,
                 const Vec3& normal) {
  std::vector<std::uint32_t> reached{start};
  std::unordered_set<std::uint32_t> known{start};  // thousands, where triangles are far larger than the scan's
  for (std::size_t k = 0; k < reached.size(); ++k) {
    if (scan.vertex_normals[reached[k]].dot(normal) > 0) return true;
    for (const std::uint32_t corner : scan.stars.corners(reached[k])) {
      if (scan.face_normals[corner / 3].dot(normal) > 0) return true;
      for (const std::uint32_t v : scan.mesh.triangles[corner / 3]) {
        if ((scan.mesh.vertices[v] - centre).norm() > radius) continue;
        if (known.insert(v).second) reached.push_back(v);
      }
    }
  }
  return false;
}

struct FaceCentres {
  FaceCentres() = default;
  explicit FaceCentres(const SurfaceMesh& mesh) {
    // The mean of the corners' normals: where a single face is inverted it still tells the side.
    const std::vector<Vec3> at_vertices = vertex_normals(mesh);
    centroids.reserve(mesh.triangles.size());
    normals.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
      centroids.push_back(centroid(mesh, t));
      normals.push_back((at_vertices[t[0]] + at_vertices[t[1]] + at_vertices[t[2]]).normalized());
    }
  }

  std::vector<Vec3> centroids, normals;
};

double spacing_of(const SurfaceMesh& mesh, const ReferenceSurface& scan) {
  return std::sqrt(scan.area / static_cast<double>(mesh.triangles.size()));
}

}  // namespace

std::vector<std::uint32_t> scan_vertices_of_faces(const SurfaceMesh& mesh, const ReferenceSurface& scan) {
  return scan_vertices_of_faces(mesh, FeatureNet{}, scan);
}

std::vector<std::uint32_t> scan_vertices_of_faces(const SurfaceMesh& mesh, const FeatureNet& net,
                                                  const ReferenceSurface& scan) {
  const FaceCentres faces(cut_along(mesh, edges_of(net)).mesh);
  const double spacing = spacing_of(mesh, scan);
  return net.empty() ? nearest_vertices(faces.centroids, faces.normals, scan.mesh, spacing)
                     : nearest_vertices_of_patch(faces.centroids, faces.normals, net.patch_of_face, scan.mesh,
                                                 scan.patch_of_vertex, spacing);
}

std::vector<std::uint32_t> scan_vertices_of_faces(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& known,
                                                  const ReferenceSurface& scan) {
  constexpr double near = 0.5;
  const FaceCentres faces(mesh);
  const double spacing = spacing_of(mesh, scan);
  std::vector<std::uint32_t> result = known, others;
  FaceCentres of_others;
  for (std::uint32_t f = 0; f < result.size(); ++f) {
    const std::uint32_t v = known[f];
    if ((scan.mesh.vertices[v] - faces.centroids[f]).norm() <= near * spacing &&
        faces.normals[f].dot(scan.vertex_normals[v]) >= 0)
      continue;
    others.push_back(f);
    of_others.centroids.push_back(faces.centroids[f]);
    of_others.normals.push_back(faces.normals[f]);
  }
  if (others.empty()) return result;
  const std::vector<std::uint32_t> found = nearest_vertices(of_others.centroids, of_others.normals, scan.mesh, spacing);
  for (std::size_t i = 0; i < others.size(); ++i) result[others[i]] = found[i];
  return result;
}

SurfaceDefects find_defects(const SurfaceMesh& mesh, const ReferenceSurface& scan,
                            const std::vector<std::uint32_t>& near, double least_angle_deg) {
  const double edge = equilateral_edge(surface_area(mesh), static_cast<double>(mesh.triangles.size()));
  SurfaceDefects defects;
  defects.crossings = find_self_intersections(mesh);
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    const Vec3 normal = area_vector(mesh, t);
    if (normal.dot(scan.vertex_normals[near[f]]) < 0) {
      const Vec3 centre = centroid(mesh, t);
      if (!scan_agrees(scan, near[f], centre, edge, normal)) defects.inverted.push_back(f);
    }
    const double angle = smallest_angle_deg(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    if (angle < least_angle_deg) {
      defects.small_angles.push_back(f);
      defects.missing_angles_deg += least_angle_deg - angle;
    }
  }
  return defects;
}

}  // namespace scan2fea
