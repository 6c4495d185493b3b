// benchmark_parts FOLDER [FANDISK]: writes the mechanical parts of tests/benchmark/feature_table, and FANDISK with
// noise.
#include "preproc/mesh/read_surface.hpp"
#include "preproc/mesh/write_surface.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <list>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

namespace {

using namespace scan2fea;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using Loop = std::vector<Point>;

// A region of the plane: loops[0] counter-clockwise around it, the others around its holes, each with a point inside.
struct Region {
  std::vector<Loop> loops;
  std::list<Point> hole_seeds;
};

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

Region rectangle(double width, double depth) {
  return {{{Point(0, 0), Point(width, 0), Point(width, depth), Point(0, depth)}}, {}};
}

void add_hole(Region& region, Point centre, double radius, int corners) {
  region.loops.push_back(circle(centre, radius, corners));
  region.hole_seeds.push_back(centre);
}

struct Planar {
  std::vector<Point> points;
  std::vector<Triangle> triangles;                   // counter-clockwise
  std::vector<std::array<std::uint32_t, 2>> border;  // the region on its left
};

// Triangles of edges up to `size`, or of the loops' corners alone.
Planar triangulate(const Region& region, std::optional<double> size) {
  using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
      Kernel, CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_2<Kernel>,
                                                   CGAL::Delaunay_mesh_face_base_2<Kernel>>>;
  using Criteria = CGAL::Delaunay_mesh_size_criteria_2<Triangulation>;
  Triangulation cdt;
  for (const Loop& loop : region.loops)
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

// Walls of `layers` rows over the border, with or without the two ends.
SurfaceMesh extrude(const Planar& planar, double height, int layers, bool ends = true) {
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

SurfaceMesh flat(const Planar& planar) {
  SurfaceMesh mesh;
  for (const Point& p : planar.points) mesh.vertices.emplace_back(p.x(), p.y(), 0);
  mesh.triangles = planar.triangles;
  return mesh;
}

// Vertices that no triangle uses go, as those inside a tube's ends do.
SurfaceMesh compacted(const SurfaceMesh& mesh) {
  SurfaceMesh result;
  std::map<std::uint32_t, std::uint32_t> index;
  for (Triangle t : mesh.triangles) {
    for (std::uint32_t& v : t) {
      const auto [at, added] = index.try_emplace(v, static_cast<std::uint32_t>(result.vertices.size()));
      if (added) result.vertices.push_back(mesh.vertices[v]);
      v = at->second;
    }
    result.triangles.push_back(t);
  }
  return result;
}

Region plate_with_holes(int corners) {
  Region region = rectangle(100, 60);
  for (const Point& p : {Point(15, 15), Point(85, 15), Point(15, 45), Point(85, 45)}) add_hole(region, p, 5, corners);
  add_hole(region, Point(50, 30), 14, 2 * corners);
  return region;
}

// An angle of two legs with a fillet between them, rounded ends and three holes.
Region bracket(int pieces) {
  Loop outline{Point(0, 0)};
  add_arc(outline, Point(72, 8), 8, -90, 0, pieces);
  add_arc(outline, Point(72, 17), 8, 0, 90, pieces);
  add_arc(outline, Point(37, 37), 12, 270, 180, pieces);
  add_arc(outline, Point(17, 52), 8, 0, 90, pieces);
  add_arc(outline, Point(8, 52), 8, 90, 180, pieces);
  Region region{{outline}, {}};
  for (const Point& p : {Point(12.5, 12.5), Point(60, 12.5), Point(12.5, 45)}) add_hole(region, p, 5, 4 * pieces);
  return region;
}

SurfaceMesh cube_of_twelve() {
  return extrude(triangulate(rectangle(1, 1), std::nullopt), 1, 1);
}

SurfaceMesh noisy(SurfaceMesh mesh, double sigma) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0, sigma);
  for (Vec3& v : mesh.vertices)
    for (int k = 0; k < 3; ++k) v[k] += normal(random);
  return mesh;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) {
    std::fprintf(stderr, "usage: benchmark_parts FOLDER [FANDISK]\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  try {
    const auto write = [&](const SurfaceMesh& mesh, const char* name) { write_surface(mesh, folder / name); };
    const Region disc20{{circle(Point(0, 0), 20, 160)}, {}}, disc50{{circle(Point(0, 0), 50, 240)}, {}};
    write(cube_of_twelve(), "cube-12.ply");
    write(extrude(triangulate(rectangle(50, 50), 1.8), 50, 35), "cube.ply");
    write(extrude(triangulate(rectangle(100, 100), 2), 2, 2), "plate.ply");
    write(extrude(triangulate(disc20, 1.5), 60, 60), "cylinder.ply");
    write(extrude(triangulate(plate_with_holes(60), 1.5), 6, 6), "plate-with-holes.ply");
    write(compacted(extrude(triangulate(disc20, 2), 80, 80, false)), "tube.ply");
    write(flat(triangulate(rectangle(100, 60), 1.2)), "sheet.ply");
    write(extrude(triangulate(disc50, 2), 3, 3), "coin.ply");
    write(extrude(triangulate(bracket(24), 1.3), 10, 10), "bracket.ply");
    write(extrude(triangulate(bracket(4), std::nullopt), 10, 1), "coarse-bracket.ply");
    if (argc == 3) {
      const SurfaceMesh fandisk = read_surface(argv[2]);
      const double diagonal = bounding_box(fandisk.vertices).diagonal();
      write(fandisk, "fandisk.ply");
      write(noisy(fandisk, 0.0005 * diagonal), "fandisk-noise-0.05.ply");
      write(noisy(fandisk, 0.001 * diagonal), "fandisk-noise-0.1.ply");
    }
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "benchmark_parts: %s\n", e.what());
    return 1;
  }
}
