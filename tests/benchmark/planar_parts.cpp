#include "tests/benchmark/planar_parts.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesher_2.h>

#include <cmath>
#include <map>
#include <numbers>

namespace scan2fea {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

void add_arc(Loop& loop, Point centre, double radius, double from_deg, double to_deg, int pieces) {
  for (int i = 0; i <= pieces; ++i) {
    const double a = (from_deg + (to_deg - from_deg) * i / pieces) * std::numbers::pi / 180;
    loop.emplace_back(centre.x() + radius * std::cos(a), centre.y() + radius * std::sin(a));
  }
}

Loop circle(Point centre, double radius, int corners) {
  Loop loop;
  add_arc(loop, centre, radius, 0, 360, corners);
  loop.pop_back();
  return loop;
}

Loop rectangle_loop(Point low, Point high) {
  return {low, Point(high.x(), low.y()), high, Point(low.x(), high.y())};
}

Region rectangle(double width, double depth) {
  return {{rectangle_loop(Point(0, 0), Point(width, depth))}, {}};
}

void add_hole(Region& region, Point centre, double radius, int corners) {
  region.loops.push_back(circle(centre, radius, corners));
  region.hole_seeds.push_back(centre);
}

Planar triangulate(const Region& region, std::optional<double> size) {
  using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
      Kernel,
      CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_2<Kernel>,
                                           CGAL::Delaunay_mesh_face_base_2<Kernel>>,
      CGAL::Exact_predicates_tag>;  // lines may cross
  using Criteria = CGAL::Delaunay_mesh_size_criteria_2<Triangulation>;
  Triangulation cdt;
  for (const std::vector<Loop>* loops : {&region.loops, &region.lines})
    for (const Loop& loop : *loops)
      for (std::size_t i = 0; i < loop.size(); ++i) cdt.insert_constraint(loop[i], loop[(i + 1) % loop.size()]);
  CGAL::Delaunay_mesher_2<Triangulation, Criteria> mesher(cdt, size ? Criteria(0.125, *size) : Criteria());
  mesher.set_seeds(region.hole_seeds.begin(), region.hole_seeds.end());  // these components are outside
  if (size)
    mesher.refine_mesh();
  else
    mesher.init();

  Planar planar;
  std::map<Triangulation::Vertex_handle, std::uint32_t> index;
  const auto index_of = [&](Triangulation::Vertex_handle v) {
    const auto [at, added] = index.try_emplace(v, static_cast<std::uint32_t>(planar.points.size()));
    if (added) planar.points.push_back(v->point());
    return at->second;
  };
  for (const auto f : cdt.finite_face_handles()) {
    if (!f->is_in_domain()) continue;
    planar.triangles.push_back({index_of(f->vertex(0)), index_of(f->vertex(1)), index_of(f->vertex(2))});
    for (int k = 0; k < 3; ++k)
      if (!f->neighbor(k)->is_in_domain())
        planar.border.push_back({index_of(f->vertex(cdt.ccw(k))), index_of(f->vertex(cdt.cw(k)))});
  }
  return planar;
}

SurfaceMesh extrude(const Planar& planar, double height, int layers, bool ends) {
  SurfaceMesh mesh;
  const auto n = static_cast<std::uint32_t>(planar.points.size());
  if (ends)
    for (const Triangle& t : planar.triangles) {
      mesh.triangles.push_back({t[0], t[2], t[1]});
      mesh.triangles.push_back({n + t[0], n + t[1], n + t[2]});
    }
  for (const double z : {0.0, height})
    for (const Point& p : planar.points) mesh.vertices.emplace_back(p.x(), p.y(), z);
  std::map<std::uint32_t, std::uint32_t> first_above;  // of a border point, the wall's vertices between the ends
  for (const auto& edge : planar.border) {
    const std::uint32_t v = edge[0];
    first_above[v] = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int k = 1; k < layers; ++k)
      mesh.vertices.emplace_back(planar.points[v].x(), planar.points[v].y(), height * k / layers);
  }
  const auto at = [&](std::uint32_t v, int k) {
    if (k == 0 || k == layers) return k == 0 ? v : n + v;
    return first_above.at(v) + static_cast<std::uint32_t>(k - 1);
  };
  for (const auto& [a, b] : planar.border)
    for (int k = 0; k < layers; ++k) {
      mesh.triangles.push_back({at(a, k), at(b, k), at(b, k + 1)});
      mesh.triangles.push_back({at(a, k), at(b, k + 1), at(a, k + 1)});
    }
  return mesh;
}

}  // namespace scan2fea
