// Enrichment: new points where the scanner left too few.
// Source: [1], section 2 (README.md lists the sources). A point with at most K neighbours within the sampling radius
// R_s, and an empty sector of at least 90 degrees among them (importance.hpp), gets a new point on the sector's
// bisector, which is lifted from the tangent plane to the surface. Three things differ from the letter of [1], because
// measuring asked for them:
//  - The new point's base lies on the triangulation, at 0.586 R_s, and is refused nearer than 0.414 R_s to another
//    point. 0.414 R_s is the radius of the largest circle that fits into a sector of 90 degrees and radius R_s, and
//    0.586 R_s the distance of its centre, so that a needed point is never refused for lack of room; and packing bounds
//    the number of points.
//  - It is inserted into the mesh (1 to 3, or an edge split, then Delaunay flips), so that topology and borders stay
//    and neighbours are found along the surface.
//  - Its height comes from measured points alone, never from other new points.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/placement/lifting.hpp"

#include <cstddef>
#include <optional>
#include <variant>

namespace scan2fea {

struct WholeSurface {};
// The part of the surface that may be enriched.
using EnrichDomain = std::variant<WholeSurface, BoundingBox, Ball>;

struct EnrichOptions {
  // R_s, the wanted spacing, model units, > 0. Not given: 1.5 times the median distance of the sixth neighbour in the
  // domain, which levels out an uneven scan (1.0 times triples the points for little accuracy), and at least the
  // spacing of as many points spread evenly, which bounds the growth where most points crowd in one place. Before a
  // simplification give the edge length that it will be asked for: then only places where the scan's own spacing
  // exceeds what the mesh needs are enriched, and none where there are points enough.
  std::optional<double> sampling_radius = {};

  EnrichDomain domain = WholeSurface{};

  // K of [1], 3 to 20: a point with more neighbours within R_s is content.
  std::size_t most_neighbours = 6;

  // Content too if no sector of the tangent plane as wide as this is empty. Degrees, 60 to 180.
  double empty_sector_deg = 90;

  // How the height is found. Distance of the new points to the truth over that of the flat triangulation, on an uneven
  // scan of the Horse / of a part with sharp edges: hermite 0.62 / 0.81; before creases were told apart, moving least
  // squares 0.77 / 1.19, modified quadratic Shepard 0.77 / 1.13, the Shepard of [1] 1.4 / 1.6 against hermite's 0.60 /
  // 0.88.
  Lifting lifting = Lifting::hermite;

  // Move each new point, before it is lifted, to where its star's Phi is best ([1] uses its entropy there). The
  // place on the bisector is nearly as good already, and closer to the truth after lifting: off.
  bool place_by_entropy = false;

  // Insertion stops here. A bound for mistaken units, not a setting.
  std::size_t most_new_vertices = 20'000'000;
};

enum class EnrichStop {
  all_content,        // every vertex of the domain meets the condition
  no_room,            // the remaining ones look over a border, or have no room for another point
  too_many_vertices,  // most_new_vertices
};

struct EnrichResult {
  double sampling_radius = 0;       // R_s as used
  std::size_t added = 0;            // new vertices, after the original ones in the mesh
  std::size_t not_lifted = 0;       // of these: left on the triangulation, because their height was not credible
  std::size_t domain_vertices = 0;  // at the end
  std::size_t content = 0;          // of these: meet the condition
  double largest_height = 0;        // model units
  int rounds = 0;
  EnrichStop stop = EnrichStop::all_content;
};

// Precondition: `mesh` is an oriented manifold (NotMeshable otherwise); it may have borders. Original vertices keep
// place and order (vertices that no face uses are dropped), borders their edges, the surface its topology; edges are
// flipped near new vertices only, and never across creases of more than 40 degrees. Throws WrongUsage for options out
// of range. On any throw `mesh` is as it was. Deterministic, one thread; O((n + m) log n) for n vertices and m new
// ones, about 10 microseconds a new vertex. Not guaranteed: that sharp edges are restored (points on both sides of one
// are lifted from both); that what a gap of the scan hid is known; absence of self-intersections.
EnrichResult enrich(SurfaceMesh& mesh, const EnrichOptions& options = {}, const Progress& progress = {});

}  // namespace scan2fea
