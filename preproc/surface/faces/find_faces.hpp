// The faces of a part: what a drawing would call its planes, bores and fillets, each with a name and figures.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/features/find_features.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/primitives/shape.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scan2fea {

struct SurfaceFace {
  std::string name;            // FACE_1, ...
  std::optional<Shape> shape;  // none: free-form
  std::vector<std::uint32_t> triangles;
  double area = 0;            // on its shape, where it has one
  Vec3 place = Vec3::Zero();  // the mean of its surface: off it where it is curved
  // Of its vertices from its shape, but for those at its border, where others belong as much to the next face.
  double mean_misfit = 0, largest_misfit = 0;
};

// "plane", ..., "free-form".
std::string_view kind_of(const SurfaceFace& face);

struct SurfaceFaces {
  std::vector<SurfaceFace> list;
  std::vector<std::uint32_t> of_triangle;  // in the list
  double noise = 0;                        // of distances from shapes that noise, facets or rounding explain
};

// Triangles belong together where no crease parts them (find_features.hpp) and one shape describes them
// (find_primitives.hpp): creases alone leave a fillet with the planes that it joins. What is narrower than a row of
// triangles is no face of its own but where it has creases on both sides and is exactly plane, as a chamfer of CAD is.
// Pieces that no shape describes are free-form, one for each that creases part; so an organic scan has one face.
//
// Order: planes, cylinders, cones, spheres, tori, free-form faces. Planes, cones and free-form faces by area, the
// others by radius, the largest first. These count as equal where they differ by less than a tolerance of 0.5 to 8 %
// (more than noise makes of equal ones), which lies in the widest gap between the differences, so that it is the same
// for another triangulation; equal ones go by place: x, then y, then z, each with a tolerance of 0.05 to 1 % of the
// diagonal that is found likewise. The order of triangles and the number of threads have no say.
//
// Precondition: manifold. Cost: that of find_thinned_primitives, 1 to 10 s on a part. Throws Cancelled.
// Not guaranteed: that the border of two faces that are tangent is found nearer than an edge, or a stretch over which
// they differ by less than the noise.
SurfaceFaces find_faces(const SurfaceMesh& scan, const FeatureOptions& features = {}, const Progress& progress = {});

// The edges between triangles of different labels, one per triangle; sorted.
std::vector<FeatureEdge> borders_between(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& label_of_triangle);

}  // namespace scan2fea
