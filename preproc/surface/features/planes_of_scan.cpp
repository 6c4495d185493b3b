#include "preproc/surface/features/planes_of_scan.hpp"

#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/cut_surface.hpp"

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <span>

namespace scan2fea {
namespace {

using Index = std::uint32_t;

// Of an edge: a vertex that stands for a place in planes goes no farther than the first, and is beside their triangles
// by no more than the second.
constexpr double reach_of_edge = 0.2, beside_of_edge = 0.01;
constexpr double least_slope = 0.5;

// The shortest step that changes the heights over these planes by these amounts; planes that are nearly parallel count
// as one.
Vec3 step_by(const std::vector<Plane>& planes, const PlaneNumbers& which, const Eigen::VectorXd& heights) {
  constexpr double parallel = 0.13;  // 15 degrees
  Eigen::MatrixXd normals(which.size(), 3);
  for (Eigen::Index i = 0; i < normals.rows(); ++i) normals.row(i) = planes[which[static_cast<std::size_t>(i)]].normal;
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(normals, Eigen::ComputeThinU | Eigen::ComputeThinV);
  svd.setThreshold(parallel);
  return svd.solve(heights);
}

void add(Index plane, PlaneNumbers& planes) {
  if (plane == no_plane) return;
  const auto at = std::ranges::lower_bound(planes, plane);
  if (at == planes.end() || *at != plane) planes.insert(at, plane);
}

// Of the vertices on borders.
std::vector<bool> on_borders(const SurfaceMesh& surface) {
  std::vector<bool> is_on(surface.vertices.size(), false);
  for (const auto& edge : boundary_edges(surface))
    for (const Index v : edge) is_on[v] = true;
  return is_on;
}

}  // namespace

PlanesOfScan::PlanesOfScan(const SurfaceMesh& scan, double noise, double edge)
    : regions_(find_plane_regions(scan, noise, edge)) {
  std::vector<Index> plane;
  for (Index f = 0; f < regions_.of_triangle.size(); ++f)
    if (regions_.of_triangle[f] != no_plane) plane.push_back(f);
  if (!plane.empty()) tree_.emplace(scan, plane);
}

// That p, on a surface with this normal there, stands for.
Index PlanesOfScan::region_at(const Vec3& p, const Vec3& normal, double edge) const {
  const auto nearest = tree_->closest_within(p, reach_of_edge * edge);
  if (!nearest) return no_plane;
  const Index region = regions_.of_triangle[nearest->triangle];
  const Plane& plane = regions_.list[region];
  if (plane.normal.dot(normal) < least_slope * normal.norm()) return no_plane;
  // Of a noisy scan the nearest place is off the plane itself.
  const Vec3 away = p - nearest->point;
  const Vec3 beside = away - plane.normal.dot(away) * plane.normal;
  return beside.norm() <= beside_of_edge * edge + regions_.tolerance ? region : no_plane;
}

std::vector<PlaneNumbers> PlanesOfScan::planes_of(const SurfaceMesh& surface, const FeatureNet& net) const {
  std::vector<PlaneNumbers> planes(surface.vertices.size());
  if (empty()) return planes;
  const double edge = mean_edge_length(surface);
  const std::vector<bool> is_on_line = vertices_on_lines(net, surface.vertices.size());
  const std::vector<bool> is_on_border = on_borders(surface);
  const std::vector<Vec3> normals = vertex_normals(surface);
  for (Index v = 0; v < planes.size(); ++v)
    if (!is_on_line[v] && !is_on_border[v]) add(region_at(surface.vertices[v], normals[v], edge), planes[v]);
  // On lines those of the triangles beside.
  for (const Triangle& t : surface.triangles) {
    if (std::ranges::none_of(t, [&](Index v) { return is_on_line[v]; })) continue;
    PlaneNumbers of_face;
    bool is_in_one = true;
    for (const Index v : t) {
      if (is_on_line[v] || is_on_border[v]) continue;
      if (planes[v].empty()) is_in_one = false;
      for (const Index plane : planes[v]) add(plane, of_face);
    }
    if (of_face.empty() && is_in_one) add(region_at(centroid(surface, t), area_vector(surface, t), edge), of_face);
    if (of_face.size() != 1 || !is_in_one) continue;
    for (const Index v : t)
      if (is_on_line[v] && !is_on_border[v]) add(of_face[0], planes[v]);
  }
  for (Index v = 0; v < planes.size(); ++v)
    if (!planes[v].empty() && step_onto(planes[v], surface.vertices[v]).norm() > reach_of_edge * edge)
      planes[v].clear();
  return planes;
}

VerticesOnPlanes PlanesOfScan::vertices_of(const SurfaceMesh& surface, const FeatureNet& net) const {
  VerticesOnPlanes result{.places = surface.vertices,
                          .outwards = std::vector<Vec3>(surface.vertices.size(), Vec3::Zero())};
  const std::vector<PlaneNumbers> planes = planes_of(surface, net);
  for (Index v = 0; v < planes.size(); ++v) {
    if (planes[v].empty()) continue;
    result.places[v] += step_onto(planes[v], surface.vertices[v]);
    result.outwards[v] =
        step_by(regions_.list, planes[v], Eigen::VectorXd::Ones(static_cast<Eigen::Index>(planes[v].size())));
  }
  return result;
}

Vec3 PlanesOfScan::step_onto(const PlaneNumbers& planes, const Vec3& p) const {
  Eigen::VectorXd heights(planes.size());
  for (Eigen::Index i = 0; i < heights.size(); ++i)
    heights[i] = -regions_.list[planes[static_cast<std::size_t>(i)]].height(p);
  return step_by(regions_.list, planes, heights);
}

}  // namespace scan2fea
