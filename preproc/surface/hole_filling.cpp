#include "preproc/surface/hole_filling.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/fair.h>
#include <CGAL/Polygon_mesh_processing/refine.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
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
  const auto normal = [&](Face f) {
    const Halfedge h = surface.halfedge(f);
    const auto n = CGAL::normal(surface.point(surface.source(h)), surface.point(surface.target(h)),
                                surface.point(surface.target(surface.next(h))));
    return Vec3(n.x(), n.y(), n.z()).normalized();
  };
  double sum = 0, length_sum = 0;
  for (const Halfedge h : border) {
    const Vec3 inside = normal(surface.face(h)), outside = normal(surface.face(surface.opposite(h)));
    const double length =
        std::sqrt(CGAL::squared_distance(surface.point(surface.source(h)), surface.point(surface.target(h))));
    const double angle = std::atan2(inside.cross(outside).norm(), inside.dot(outside));
    if (!std::isfinite(angle)) continue;
    sum += length * angle;
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

void append_fan(SurfaceMesh& mesh, const BorderLoop& loop) {
  Vec3 centre = Vec3::Zero();
  for (const std::uint32_t h : loop) centre += mesh.vertices[start_vertex(mesh, h)];
  const auto apex = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(centre / static_cast<double>(loop.size()));
  for (const std::uint32_t h : loop) mesh.triangles.push_back({end_vertex(mesh, h), start_vertex(mesh, h), apex});
}

}  // namespace

void fill_hole(SurfaceMesh& mesh, const Twins& twins, const BorderLoop& loop, PatchShape shape) {
  Surroundings around = extract_surroundings(mesh, twins, loop);
  Surface& surface = around.surface;
  std::vector<Halfedge> border;
  CGAL::Bbox_3 box;
  for (const Halfedge h : CGAL::halfedges_around_face(around.hole, surface)) {
    border.push_back(h);
    box += surface.point(surface.target(h)).bbox();
  }

  const auto face_count = static_cast<std::uint32_t>(surface.number_of_faces());
  std::vector<Face> patch;
  PMP::triangulate_hole(surface, around.hole, std::back_inserter(patch),
                        CGAL::parameters::use_2d_constrained_delaunay_triangulation(true));
  if (patch.empty()) return append_fan(mesh, loop);

  if (shape != PatchShape::Triangles) {
    const bool sharp = mean_border_angle_deg(surface, border) > sharp_border_deg;
    std::vector<Vertex> inner;
    PMP::refine(surface, patch, CGAL::Emptyset_iterator(), std::back_inserter(inner));
    fair_patch(surface, inner, box, sharp || shape == PatchShape::Membrane ? 0 : 1);
  }

  for (std::size_t v = around.vertex_in_mesh.size(); v < surface.number_of_vertices(); ++v) {
    const auto& p = surface.point(Vertex(static_cast<std::uint32_t>(v)));
    around.vertex_in_mesh.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    mesh.vertices.push_back({p.x(), p.y(), p.z()});
  }
  for (const Face f : surface.faces()) {
    if (f.idx() < face_count) continue;
    Triangle& t = mesh.triangles.emplace_back();
    std::size_t i = 0;
    for (const Vertex v : surface.vertices_around_face(surface.halfedge(f))) t[i++] = around.vertex_in_mesh[v.idx()];
  }
}

}  // namespace scan2fea
