// The pieces of surface on which bodies of a complex meet, and the lines along which these end.
#pragma once

#include "preproc/bodies/body_complex.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <vector>

namespace scan2fea {

// Edges of triangles with other bodies on their sides than their neighbours have, sorted.
struct ComplexLines {
  std::vector<FeatureEdge> outer;  // on the outside of all bodies
  std::vector<FeatureEdge> inner;  // where three bodies or more meet, within
};
ComplexLines find_lines(const BodyComplex& complex);

// Connected, between the same two bodies; without a border where one body lies within another.
struct Sheet {
  Sides sides;
  std::vector<std::uint32_t> triangles;  // of the complex
  bool is_closed = false;
};
std::vector<Sheet> find_sheets(const BodyComplex& complex);

// A sheet by itself, with those of `points` that lie on its border as vertices of it. What the cuts of several borders
// left of short edges and narrow triangles is merged where the shape stays.
struct SheetSurface {
  SurfaceMesh mesh;
  std::vector<std::uint32_t> point_of_vertex;  // or no_point
};
inline constexpr std::uint32_t no_point = ~std::uint32_t{0};
// `candidates`: the points that may lie on a border. The border's edges times the candidates.
SheetSurface extract_sheet(const BodyComplex& complex, const Sheet& sheet, const std::vector<Vec3>& points,
                           const std::vector<std::uint32_t>& candidates);

}  // namespace scan2fea
