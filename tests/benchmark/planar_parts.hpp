// Regions of the plane and their triangles, from which the mechanical parts of this folder are made.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <array>
#include <cstdint>
#include <list>
#include <optional>
#include <vector>

namespace scan2fea {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_2;
using Loop = std::vector<Point>;

// A region of the plane: loops[0] counter-clockwise around it, the others around its holes, each with a point inside.
// `lines` are closed lines that triangles do not cross.
struct Region {
  std::vector<Loop> loops;
  std::list<Point> hole_seeds;
  std::vector<Loop> lines = {};
};

void add_arc(Loop& loop, Point centre, double radius, double from_deg, double to_deg, int pieces);
Loop circle(Point centre, double radius, int corners);
Loop rectangle_loop(Point low, Point high);
Region rectangle(double width, double depth);
void add_hole(Region& region, Point centre, double radius, int corners);

struct Planar {
  std::vector<Point> points;
  std::vector<Triangle> triangles;                   // counter-clockwise
  std::vector<std::array<std::uint32_t, 2>> border;  // the region on its left
};

// Triangles of edges up to `size`, or of the loops' corners alone.
Planar triangulate(const Region& region, std::optional<double> size);

// Walls of `layers` rows over the border, with or without the two ends.
SurfaceMesh extrude(const Planar& planar, double height, int layers, bool ends = true);

}  // namespace scan2fea
