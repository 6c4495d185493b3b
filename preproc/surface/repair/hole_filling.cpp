#include "preproc/surface/repair/hole_filling.hpp"

#include "quality/triangle_measures.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/fair.h>
#include <CGAL/Polygon_mesh_processing/refine.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/Euler_operations.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

namespace scan2fea {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Face = Surface::Face_index;
using Vertex = Surface::Vertex_index;
using Halfedge = Surface::Halfedge_index;

constexpr double sharp_border_deg = 50;
constexpr std::size_t most_edges_of_cubic_search = 150;

// The faces that touch the loop's vertices, as a mesh of their own: all that triangulation, refinement and fairing look
// at.
struct Surroundings {
  Surface surface;
  std::vector<std::uint32_t> vertex_in_mesh;  // of each vertex of `surface`
  Halfedge hole;                              // a border half-edge of the hole
};

std::vector<std::uint32_t> faces_touching(const BorderLoop& loop, const Twins& twins) {
  std::vector<std::uint32_t> faces;
  for (const std::uint32_t border : loop) {
    std::uint32_t h = border;  // about its start, to the other border
    do {
      faces.push_back(h / 3);
      h = twins[previous_halfedge(h)];
    } while (h != no_twin);
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

Surroundings extract_surroundings(const SurfaceMesh& mesh, const Twins& twins, const BorderLoop& loop) {
  Surroundings result;
  SurfaceMesh local;
  const std::vector<std::uint32_t> faces = faces_touching(loop, twins);
  auto& vertices = result.vertex_in_mesh;
  for (const std::uint32_t f : faces)
    vertices.insert(vertices.end(), mesh.triangles[f].begin(), mesh.triangles[f].end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  for (const std::uint32_t v : vertices) local.vertices.push_back(mesh.vertices[v]);
  for (const std::uint32_t f : faces) {
    Triangle& t = local.triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i)
      t[i] = static_cast<std::uint32_t>(std::lower_bound(vertices.begin(), vertices.end(), mesh.triangles[f][i]) -
                                        vertices.begin());
  }
  // At the outer rim a vertex may now have several fans, which CGAL's structure does not hold.
  for (const std::uint32_t v : split_vertices(local, find_twins(local)))
    vertices.push_back(static_cast<std::uint32_t>(vertices[v]));

  for (const Vec3& p : local.vertices) result.surface.add_vertex({p.x(), p.y(), p.z()});
  for (const Triangle& t : local.triangles) result.surface.add_face(Vertex(t[0]), Vertex(t[1]), Vertex(t[2]));
  const auto local_face =
      static_cast<std::size_t>(std::lower_bound(faces.begin(), faces.end(), loop[0] / 3) - faces.begin());
  const Triangle& t = local.triangles[local_face];
  const std::uint32_t from = t[loop[0] % 3], to = t[(loop[0] + 1) % 3];
  result.hole = result.surface.halfedge(Vertex(to), Vertex(from));
  return result;
}

// Mean angle between the patch and the faces beside it, weighted by edge length.
double mean_border_angle_deg(const Surface& surface, const std::vector<Halfedge>& border) {
  const auto position = [&](Vertex v) {
    const auto& p = surface.point(v);
    return Vec3(p.x(), p.y(), p.z());
  };
  const auto normal = [&](Face f) {  // zero for a face of no area
    const Halfedge h = surface.halfedge(f);
    const Vec3 a = position(surface.source(h)), b = position(surface.target(h));
    return Vec3((b - a).cross(position(surface.target(surface.next(h))) - a).normalized());
  };
  double sum = 0, length_sum = 0;
  for (const Halfedge h : border) {
    const Vec3 inside = normal(surface.face(h)), outside = normal(surface.face(surface.opposite(h)));
    if (inside.isZero() || outside.isZero()) continue;
    const double length = (position(surface.source(h)) - position(surface.target(h))).norm();
    sum += length * angle_between(inside, outside);
    length_sum += length;
  }
  return length_sum > 0 ? sum / length_sum * 180 / std::numbers::pi : 0;
}

// Fairing solves a linear system that slivers can make near-singular; a patch that left its surroundings is not faired.
void fair_patch(Surface& surface, const std::vector<Vertex>& inner, const CGAL::Bbox_3& box, unsigned continuity) {
  if (inner.empty()) return;
  std::vector<Kernel::Point_3> before;
  for (const Vertex v : inner) before.push_back(surface.point(v));
  bool sound = PMP::fair(surface, inner, CGAL::parameters::fairing_continuity(continuity));
  const double reach = std::sqrt(CGAL::squared_distance(Kernel::Point_3(box.xmin(), box.ymin(), box.zmin()),
                                                        Kernel::Point_3(box.xmax(), box.ymax(), box.zmax())));
  for (std::size_t i = 0; i < inner.size() && sound; ++i) {
    const double moved = CGAL::squared_distance(before[i], surface.point(inner[i]));
    sound = moved <= reach * reach;  // false for NaN too
  }
  if (sound) return;
  for (std::size_t i = 0; i < inner.size(); ++i) surface.point(inner[i]) = before[i];
}

// Whether no two corners of a hole lie on one another where CGAL's planar triangulation looks at them. It projects them
// along the mean of the normals of a fan from the first corner, turned to one side; where two then coincide, 5.5.1
// reads through a null pointer. Linear but for a sort, and for corners in lines that lie in that direction.
bool can_be_projected(const Surface& surface, const std::vector<Halfedge>& border) {
  std::vector<Vec3> corners;
  for (const Halfedge h : border) {
    const auto& p = surface.point(surface.target(h));
    corners.push_back({p.x(), p.y(), p.z()});
  }
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Vec3 n = (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
    const bool turned = n.x() < 0 || (n.x() == 0 && (n.y() < 0 || (n.y() == 0 && n.z() < 0)));
    normal += turned ? -n : n;
  }
  if (normal.isZero()) return false;
  normal.normalize();
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  const double rounding = 1e-12 * bounding_box(corners).diagonal();
  std::vector<std::array<double, 2>> plane;
  for (const Vec3& p : corners) plane.push_back({(p - corners[0]).dot(u), (p - corners[0]).dot(v)});
  std::sort(plane.begin(), plane.end());
  for (std::size_t i = 0; i < plane.size(); ++i)
    for (std::size_t k = i + 1; k < plane.size() && plane[k][0] - plane[i][0] <= rounding; ++k)
      if (std::abs(plane[k][1] - plane[i][1]) <= rounding) return false;
  return true;
}

std::vector<Face> add_fan(Surface& surface, Halfedge hole) {
  Vec3 sum = Vec3::Zero();
  std::size_t count = 0;
  for (const Halfedge h : CGAL::halfedges_around_face(hole, surface)) {
    const auto& p = surface.point(surface.target(h));
    sum += Vec3(p.x(), p.y(), p.z());
    ++count;
  }
  const Vec3 centre = sum / static_cast<double>(count);
  CGAL::Euler::fill_hole(hole, surface);
  const Halfedge first = CGAL::Euler::add_center_vertex(hole, surface);
  surface.point(surface.target(first)) = {centre.x(), centre.y(), centre.z()};
  std::vector<Face> faces;
  for (const Face f : surface.faces_around_target(first)) faces.push_back(f);
  return faces;
}

}  // namespace

Patch make_patch(const SurfaceMesh& mesh, const Twins& twins, const BorderLoop& loop, PatchShape shape) {
  if (loop.size() == 3) {  // nothing to choose; and it may have no area, as at a vertex that lies on an edge
    const Triangle only{end_vertex(mesh, loop[0]), start_vertex(mesh, loop[0]), start_vertex(mesh, loop[1])};
    return {{}, {only}, static_cast<std::uint32_t>(mesh.vertices.size())};
  }
  Surroundings around = extract_surroundings(mesh, twins, loop);
  Surface& surface = around.surface;
  std::vector<Halfedge> border;
  CGAL::Bbox_3 box;
  for (const Halfedge h : CGAL::halfedges_around_face(around.hole, surface)) {
    border.push_back(h);
    box += surface.point(surface.target(h)).bbox();
  }

  const auto face_count = static_cast<std::uint32_t>(surface.number_of_faces());
  std::vector<Face> faces;
  PMP::triangulate_hole(surface, around.hole, std::back_inserter(faces),
                        CGAL::parameters::use_2d_constrained_delaunay_triangulation(can_be_projected(surface, border))
                            .do_not_use_cubic_algorithm(border.size() > most_edges_of_cubic_search));
  if (faces.empty()) faces = add_fan(surface, around.hole);

  if (shape != PatchShape::Triangles) {
    const bool sharp = mean_border_angle_deg(surface, border) > sharp_border_deg;
    std::vector<Vertex> inner;
    PMP::refine(surface, faces, CGAL::Emptyset_iterator(), std::back_inserter(inner));
    fair_patch(surface, inner, box, sharp || shape == PatchShape::Membrane ? 0 : 1);
  }

  Patch patch;
  patch.first_vertex = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::size_t v = around.vertex_in_mesh.size(); v < surface.number_of_vertices(); ++v) {
    const auto& p = surface.point(Vertex(static_cast<std::uint32_t>(v)));
    around.vertex_in_mesh.push_back(patch.first_vertex + static_cast<std::uint32_t>(patch.vertices.size()));
    patch.vertices.push_back({p.x(), p.y(), p.z()});
  }
  for (const Face f : surface.faces()) {
    if (f.idx() < face_count) continue;
    Triangle& t = patch.triangles.emplace_back();
    std::size_t i = 0;
    for (const Vertex v : surface.vertices_around_face(surface.halfedge(f))) t[i++] = around.vertex_in_mesh[v.idx()];
  }
  return patch;
}

void append_patch(SurfaceMesh& mesh, const Patch& patch) {
  const auto shift = static_cast<std::uint32_t>(mesh.vertices.size()) - patch.first_vertex;
  mesh.vertices.insert(mesh.vertices.end(), patch.vertices.begin(), patch.vertices.end());
  for (Triangle t : patch.triangles) {
    for (std::uint32_t& v : t)
      if (v >= patch.first_vertex) v += shift;
    mesh.triangles.push_back(t);
  }
}

}  // namespace scan2fea
