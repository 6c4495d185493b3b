// The sizing field: how long the edges of the result are to be at each place of the scan.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/cut_surface.hpp"

#include <cmath>
#include <span>
#include <vector>

namespace scan2fea {

enum class Sizing {
  uniform,    // one edge length for all
  curvature,  // shorter edges where the surface bends
  error,      // by curvature, then renewed from the measured error of a first result (given as `factors`)
};

struct SizingOptions {
  double triangles = 10000;  // wanted in the result, > 0; may be more than the scan has
  Sizing sizing = Sizing::curvature;
  // Exponent of the curvature in the edge length, h ~ curvature^-strength, 0 to 1. The length that spreads the error of
  // linear triangles evenly is 0.5; a little more serves tips and folds, where most of the squared error sits.
  double strength = 0.6;
  // Bounds of the edge length over the one that is uniform for the same count. Beyond them the lattice loses more shape
  // than the surface gains.
  double smallest = 0.45;
  double largest = 2.5;
  double gradation = 0.12;  // largest |grad h|, 0.02 to 1: how fast edge lengths may change from place to place
  // Of several components each gets at least about so many triangles, so that small ones keep a shape and a closed
  // surface.
  double triangles_per_component = 60;
  // Where creases ask for shorter edges along them, all others grow so that the number of triangles stays; or there are
  // more triangles.
  bool keeps_count = true;
  // Per scan vertex, multiplies the edge length (before clamping and grading); empty for none. Made from a measured
  // error, or from a user's boxes and spheres.
  std::span<const double> factors;
};

// Per vertex of the scan, the wanted edge length in model units.
struct SizingField {
  std::vector<double> edge_length;
};

// The number of equilateral triangles that the field asks for: the integral of dA / (sqrt(3)/4 h^2).
double predicted_triangles(const SurfaceMesh& scan, const SizingField& field);

// A field with predicted_triangles equal to options.triangles (more only where small components ask for it).
// From curvature: normals are smoothed, a shape operator is fitted to their change along the edges of each star, its
// squared norm k^2 smoothed, and ln h = -strength/2 ln(k^2 + median k^2), clamped, graded, smoothed. The widths of the
// smoothing follow the wanted edge length, so that a scan twice as dense gives the same field.
// `cut`: the scan cut along its features, across which nothing bends then; absent where it has none.
// Precondition: manifold, vertices all used, coordinates finite. Throws WrongUsage for options out of range,
// InvalidInput where the scan has no area. O(n log n); parallel. After smoothing the gradation holds within a few per
// cent, not exactly.
SizingField compute_sizing_field(const SurfaceMesh& scan, const SizingOptions& options,
                                 const CutSurface* cut = nullptr);

// The longest edges that a deviation asks for, where the scan is plane, over it.
inline constexpr double longest_over_deviation = 36;

// Per vertex of the scan, the edge lengths with which a fitted surface comes about within `deviation` (model units) of
// it almost everywhere, by its curvature; see compute_sizing_field for `cut`. `roughness`: how far single vertices may
// be beside, model units, as by noise. Not guaranteed: that it does, or that longer ones would not do. O(n log n);
// parallel.
std::vector<double> lengths_for_deviation(const SurfaceMesh& scan, double deviation, double roughness, double gradation,
                                          const CutSurface* cut = nullptr);

// Asks for these lengths, and for the number of triangles that they give. Keeps a reference to them.
void ask_for_lengths(const SurfaceMesh& scan, std::span<const double> edge_length, SizingOptions& options);

// Lowers lengths until none exceeds a neighbour's by more than `gradation` times the edge between them. O(n log n).
void limit_gradation(const SurfaceMesh& scan, double gradation, std::vector<double>& edge_length);

}  // namespace scan2fea
