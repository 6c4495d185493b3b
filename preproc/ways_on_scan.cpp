#include "preproc/ways_on_scan.hpp"

#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/components.hpp"
#include "preproc/surface/kernel/cut_surface.hpp"
#include "preproc/surface/kernel/locate.hpp"
#include "preproc/surface/kernel/nearest.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace scan2fea {
namespace {

constexpr std::uint32_t none = ~0U;

class WaysOnScan {
 public:
  WaysOnScan(const SurfaceMesh& surface, const FeatureNet& net, const ReferenceSurface& scan,
             const PlanesOfScan& planes, double most)
      : net_(net),
        scan_(scan),
        planes_(planes),
        most_(most),
        given_(surface.vertices),
        normals_(vertex_normals(surface)),
        vertices_(surface.vertices.size()) {
    if (!planes.empty()) of_planes_ = planes.planes_of(surface, net);
    put_on_lines();
    put_on_faces(surface);
  }

  std::optional<WayPoint> at(std::uint32_t v, const Vec3& wanted) {
    if (vertices_[v].stays) return {};
    Vec3 way = wanted - given_[v];
    if (const double length = way.norm(); length > most_) way *= most_ / length;
    // What goes up and down with the scan, or turns with it, may end farther away than the place that is wanted.
    for (int trial = 0; trial < trials; ++trial, way *= shorter) {
      const WayPoint point = way_point(v, given_[v] + way);
      if ((point.place - given_[v]).norm() <= most_) return point;
    }
    WayPoint start = way_point(v, given_[v]);
    start.place = given_[v];
    return start;
  }

 private:
  static constexpr int trials = 4;
  static constexpr double shorter = 0.9;

  struct Vertex {
    bool stays = false;
    std::uint32_t line = none;
    double place = 0;              // on the line, where it was given
    Vec3 beside = Vec3::Zero();    // the line
    std::uint32_t face = no_face;  // of the scan, where it was asked last
    double height = 0;             // over the scan
  };

  void put_on_lines() {
    for (std::uint32_t l = 0; l < net_.lines.size(); ++l) {
      const FeatureLine& line = net_.lines[l];
      for (std::size_t i = 0; i < line.vertices.size(); ++i) {
        const VertexOnLine& on = line.vertices[i];
        Vertex& vertex = vertices_[on.vertex];
        const bool is_end = !line.closed && (i == 0 || i + 1 == line.vertices.size());
        vertex.stays = vertex.stays || is_end || vertex.line != none || line.border;
        vertex.line = l;
        vertex.place = on.place;
        vertex.beside = given_[on.vertex] - line.point_at(on.place);
      }
    }
  }

  void put_on_faces(const SurfaceMesh& surface) {
    const std::vector<std::uint32_t> nearest = nearest_of_own_patch(surface);
    for (std::uint32_t v = 0; v < given_.size(); ++v) {
      Vertex& vertex = vertices_[v];
      if (vertex.stays || vertex.line != none) continue;
      vertex.face = scan_.stars.corners(nearest[v]).front() / 3;
      const Foot foot = foot_of(v, given_[v]);
      vertex.height = (given_[v] - foot.place).dot(foot.normal);
    }
  }

  // Vertices of the scan. What is nearest to one vertex beside a line may lie on the other side of it, but not what is
  // nearest to most of those between the lines.
  std::vector<std::uint32_t> nearest_of_own_patch(const SurfaceMesh& surface) const {
    const double spacing = scan_.mean_edge(surface.triangles.size());
    std::vector<std::uint32_t> nearest = nearest_vertices(given_, normals_, scan_.mesh, spacing);
    const std::vector<std::uint32_t>& patch_of_scan = scan_.patch_of_vertex;
    if (patch_of_scan.empty()) return nearest;
    const std::vector<std::uint32_t> part =
        find_components(cut_along(surface, edges_of(net_)).mesh).of_vertex;  // of what the lines part
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> votes;    // of vertices, by part and patch
    for (std::uint32_t v = 0; v < given_.size(); ++v)
      if (vertices_[v].line == none) ++votes[{part[v], patch_of_scan[nearest[v]]}];
    std::map<std::uint32_t, std::pair<std::size_t, std::uint32_t>> most;  // votes and patch, by part
    for (const auto& [choice, count] : votes)
      if (auto& best = most[choice.first]; count > best.first) best = {count, choice.second};
    std::vector<std::uint32_t> patch(given_.size(), 0);
    for (std::uint32_t v = 0; v < given_.size(); ++v)
      if (vertices_[v].line == none) patch[v] = most[part[v]].second;
    return nearest_vertices_of_patch(given_, normals_, patch, scan_.mesh, patch_of_scan, spacing);
  }

  WayPoint way_point(std::uint32_t v, const Vec3& wanted) {
    WayPoint point = vertices_[v].line != none ? on_line(vertices_[v], wanted) : on_face(v, wanted);
    if (!of_planes_.empty() && !of_planes_[v].empty()) point.place += planes_.step_onto(of_planes_[v], point.place);
    return point;
  }

  WayPoint on_line(const Vertex& vertex, const Vec3& wanted) const {
    const FeatureLine& line = net_.lines[vertex.line];
    double place = vertex.place;
    for (int step = 0; step < 3; ++step)
      place = advanced(line, place, (wanted - vertex.beside - line.point_at(place)).dot(direction_at(line, place)));
    return {line.point_at(place) + vertex.beside, direction_at(line, place), true};
  }

  struct Foot {
    Vec3 place, normal;
  };
  Foot foot_of(std::uint32_t v, const Vec3& wanted) {
    const WalkableMesh on{scan_.mesh, scan_.stars, scan_.neighbours, scan_.face_normals};
    const Location at = descend_to_nearest(on, {wanted, normals_[v], 0}, vertices_[v].face);
    vertices_[v].face = at.face;
    const Triangle& t = scan_.mesh.triangles[at.face];
    Vec3 normal = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) normal += at.barycentric[k] * scan_.vertex_normals[t[k]];
    return {point_at(scan_.mesh, at), normal.normalized()};
  }

  WayPoint on_face(std::uint32_t v, const Vec3& wanted) {
    const Foot foot = foot_of(v, wanted);
    return {foot.place + vertices_[v].height * foot.normal, foot.normal, false};
  }

  const FeatureNet& net_;
  const ReferenceSurface& scan_;
  const PlanesOfScan& planes_;
  double most_;
  std::vector<Vec3> given_, normals_;
  std::vector<PlaneNumbers> of_planes_;
  std::vector<Vertex> vertices_;
};

}  // namespace

BoundaryWays ways_on_scan(const SurfaceMesh& surface, const FeatureNet& net, const ReferenceSurface& scan,
                          const PlanesOfScan& planes, double most) {
  auto ways = std::make_shared<WaysOnScan>(surface, net, scan, planes, most);
  return [ways](std::uint32_t v, const Vec3& wanted) { return ways->at(v, wanted); };
}

}  // namespace scan2fea
