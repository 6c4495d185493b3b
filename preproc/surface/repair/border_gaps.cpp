#include "preproc/surface/repair/border_gaps.hpp"

#include "preproc/mesh/coordinate_step.hpp"
#include "preproc/surface/repair/face_marks.hpp"
#include "preproc/surface/repair/soup_adjacency.hpp"

#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace scan2fea {
namespace {

constexpr double most_of_diagonal = 1e-3;
constexpr double most_of_edge = 1.0 / 8;
constexpr double wall_of_gap = 3;

// The border half-edges, each beside both of its ends.
struct BorderEnd {
  std::uint32_t vertex, halfedge;
  bool operator<(const BorderEnd& o) const { return vertex != o.vertex ? vertex < o.vertex : halfedge < o.halfedge; }
};

using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;

Box box_about(const Vec3& a, const Vec3& b, double margin, std::uint32_t info) {
  CGAL::Bbox_3 box(std::min(a.x(), b.x()) - margin, std::min(a.y(), b.y()) - margin, std::min(a.z(), b.z()) - margin,
                   std::max(a.x(), b.x()) + margin, std::max(a.y(), b.y()) + margin, std::max(a.z(), b.z()) + margin);
  return Box(box, info);
}

class GapSearch {
 public:
  explicit GapSearch(const SurfaceMesh& mesh) : mesh_(mesh) {
    EdgeGroups(mesh).for_each([&](const std::uint32_t* first, const std::uint32_t* last) {
      if (last - first == 1) halfedges_.push_back(*first);
    });
    for (const std::uint32_t h : halfedges_)
      for (const std::uint32_t v : {start_vertex(mesh, h), end_vertex(mesh, h)}) ends_.push_back({v, h});
    std::sort(ends_.begin(), ends_.end());
  }

  std::vector<BorderGap> run() const {
    std::vector<Box> edges, vertices;
    for (const std::uint32_t h : halfedges_)
      edges.push_back(box_about(mesh_.vertices[start_vertex(mesh_, h)], mesh_.vertices[end_vertex(mesh_, h)], 0, h));
    std::vector<double> reach(mesh_.vertices.size(), 0);
    const double most = farthest_gap();
    for (std::size_t i = 0; i < ends_.size();) {
      const std::uint32_t v = ends_[i].vertex;
      double shortest = std::numeric_limits<double>::max();
      for (; i < ends_.size() && ends_[i].vertex == v; ++i) shortest = std::min(shortest, length(ends_[i].halfedge));
      reach[v] = std::min(most, most_of_edge * shortest);
      vertices.push_back(box_about(mesh_.vertices[v], mesh_.vertices[v], reach[v], v));
    }

    std::vector<BorderGap> gaps;
    CGAL::box_intersection_d(vertices.begin(), vertices.end(), edges.begin(), edges.end(),
                             [&](const Box& vertex, const Box& edge) {
                               const BorderGap gap = gap_between(vertex.info(), edge.info());
                               if (gap.distance <= std::min(reach[gap.vertex], most_of_edge * length(gap.halfedge)) &&
                                   !names(gap.halfedge, gap.vertex) && !is_across_wall(gap))
                                 gaps.push_back(gap);
                             });
    std::sort(gaps.begin(), gaps.end(), [](const BorderGap& a, const BorderGap& b) {
      if (a.distance != b.distance) return a.distance < b.distance;
      return a.vertex != b.vertex ? a.vertex < b.vertex : a.halfedge < b.halfedge;
    });
    return gaps;
  }

 private:
  // Where coordinates have visible steps, corners that were one may lie a step apart along each axis.
  double farthest_gap() const {
    const double most = most_of_diagonal * bounding_box(mesh_.vertices).diagonal();
    if (halfedges_.empty()) return most;
    const std::optional<CoordinateStep> step = visible_coordinate_step(mesh_);
    constexpr double rounding = 1 + 1e-9;
    return step ? std::max(most, rounding * step->length.norm()) : most;
  }

  double length(std::uint32_t h) const {
    return (mesh_.vertices[end_vertex(mesh_, h)] - mesh_.vertices[start_vertex(mesh_, h)]).norm();
  }

  // Whether the half-edge's face has the vertex as a corner.
  bool names(std::uint32_t h, std::uint32_t v) const {
    const Triangle& t = mesh_.triangles[h / 3];
    return t[0] == v || t[1] == v || t[2] == v;
  }

  BorderGap gap_between(std::uint32_t v, std::uint32_t h) const {
    const Vec3 &a = mesh_.vertices[start_vertex(mesh_, h)], &p = mesh_.vertices[v];
    const Vec3 edge = mesh_.vertices[end_vertex(mesh_, h)] - a;
    const double squared = edge.squaredNorm();
    const double along = squared > 0 ? std::clamp((p - a).dot(edge) / squared, 0.0, 1.0) : 0;
    return {v, h, along, (a + along * edge - p).norm()};
  }

  bool is_across_wall(const BorderGap& gap) const {
    const auto from = std::lower_bound(ends_.begin(), ends_.end(), BorderEnd{gap.vertex, 0});
    for (auto end = from; end != ends_.end() && end->vertex == gap.vertex; ++end)
      if (lie_upon_one_another(end->halfedge / 3, gap)) return true;
    return false;
  }

  bool lie_upon_one_another(std::uint32_t face, const BorderGap& gap) const {
    const std::uint32_t other = gap.halfedge / 3;
    const Vec3 edge =
        mesh_.vertices[end_vertex(mesh_, gap.halfedge)] - mesh_.vertices[start_vertex(mesh_, gap.halfedge)];
    const Vec3& at = mesh_.vertices[gap.vertex];
    const auto inwards = [&](std::uint32_t f) {
      const Vec3 to_centre = centre_of(mesh_, f) - at;
      return Vec3(to_centre - edge * (to_centre.dot(edge) / edge.squaredNorm()));
    };
    if (inwards(face).dot(inwards(other)) <= 0) return false;
    const double most = wall_of_gap * gap.distance + std::numeric_limits<float>::epsilon() * edge.norm();
    return farthest_from_plane(face, other) <= most && farthest_from_plane(other, face) <= most;
  }

  // Of the corners of one face from the plane of another; none has a plane that has no area.
  double farthest_from_plane(std::uint32_t corners, std::uint32_t plane) const {
    const Vec3 normal = area_vector(mesh_, mesh_.triangles[plane]).normalized();
    double farthest = 0;
    for (const std::uint32_t v : mesh_.triangles[corners])
      farthest =
          std::max(farthest, std::abs(normal.dot(mesh_.vertices[v] - mesh_.vertices[mesh_.triangles[plane][0]])));
    return farthest;
  }

  const SurfaceMesh& mesh_;
  std::vector<std::uint32_t> halfedges_;
  std::vector<BorderEnd> ends_;
};

}  // namespace

std::vector<BorderGap> find_border_gaps(const SurfaceMesh& mesh) {
  return GapSearch(mesh).run();
}

}  // namespace scan2fea
