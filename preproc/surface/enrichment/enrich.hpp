// Enrichment: new points where the scanner left too few, and creases where it hardly ever puts any.
// Source: [1], section 2 (README.md lists the sources). A point with at most K neighbours within the sampling radius
// R_s, and an empty sector of at least 90 degrees among them (importance.hpp), gets a new point on the sector's
// bisector, which is lifted from the tangent plane to the surface. Four things differ from the letter of [1], because
// measuring asked for them:
//  - The new point's base lies on the triangulation, at 0.586 R_s, and is refused nearer than 0.414 R_s to another
//    point. 0.414 R_s is the radius of the largest circle that fits into a sector of 90 degrees and radius R_s, and
//    0.586 R_s the distance of its centre, so that a needed point is never refused for lack of room; and packing bounds
//    the number of points.
//  - It is inserted into the mesh (1 to 3, or an edge split, then Delaunay flips), so that topology and borders stay
//    and neighbours are found along the surface.
//  - On a part its height is that of the plane, cylinder or other primitive that the measured points around lie on
//    (find_primitives.hpp); before, the creases and corners are put back where these meet (cut_creases.hpp).
//  - Elsewhere it comes from the smoothest surface through the measured points (triharmonic_lift.hpp).
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/placement/lifting.hpp"
#include "preproc/surface/placement/star_objective.hpp"
#include "preproc/surface/primitives/find_primitives.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace scan2fea {

struct EnrichOptions {
  // Section 2 of [1] as it is written, so far as that goes on a mesh: for comparison.
  static EnrichOptions literal();

  // R_s, the wanted spacing, model units, > 0. Not given: three quarters of the median distance of the sixth neighbour
  // in the domain, which levels out an uneven scan and about triples its points, and at least as much of the spacing of
  // as many points spread evenly, which bounds the growth where most points crowd in one place;
  // nor less than a hundredth of the bounding box's diagonal, which is the edge length of usual meshes; and nothing is
  // inserted where fewer than one point in fifty asks for it. So a scan that is dense enough stays as it is. Before a
  // simplification give the edge length that it will be asked for: then only places where the scan's own spacing
  // exceeds what the mesh needs are enriched, and none where there are points enough.
  std::optional<double> sampling_radius = {};

  // Per vertex whether it may ask for points; new ones then lie between such vertices only. Not given: all may.
  std::optional<std::vector<bool>> domain = {};

  // K of [1], 3 to 20: a point with more neighbours within R_s is content.
  std::size_t most_neighbours = 6;

  // Content too if no sector of the tangent plane as wide as this is empty. Degrees, 60 to 180.
  double empty_sector_deg = 90;

  // Whether a part's primitives are looked for. They are used where they describe it (see find_primitives.hpp); organic
  // scans are the same without.
  bool primitives = true;

  // How the height is found where no primitive tells it. tests/benchmark/README.md has the errors of each.
  Lifting lifting = Lifting::triharmonic;

  // Move each new point, before it is lifted, to where this objective of its star is best ([1] takes an entropy there).
  // The place on the bisector is nearly as good already, and closer to the truth after lifting: none.
  std::optional<StarObjective> place_by = {};

  // How far from the point that asks for it a new one is put, over R_s, and how near others may be. 1 and 0.05, with
  // placement by the entropy, Shepard's lifting and no primitives, are [1] to the letter.
  double placement_distance = 0.586;
  double separation = 0.414;

  // Insertion stops here. A bound for mistaken units, not a setting.
  std::size_t most_new_vertices = 20'000'000;
};

enum class EnrichStop {
  all_content,        // every vertex of the domain meets the condition
  no_room,            // the remaining ones look over a border, or have no room for another point
  too_many_vertices,  // most_new_vertices
};

struct EnrichResult {
  double sampling_radius = 0;        // R_s as used
  std::size_t added = 0;             // new vertices, after the original ones in the mesh
  std::size_t on_primitives = 0;     // of these: put onto a primitive, beside those on creases
  std::size_t not_lifted = 0;        // vertices left on the triangulation, or put back there, because faces turned over
  std::size_t domain_vertices = 0;   // at the end
  std::size_t content = 0;           // of these: meet the condition
  double largest_height = 0;         // of a new vertex over the triangulation, model units
  double largest_correction = 0;     // of a measured one, model units
  std::vector<FeatureEdge> creases;  // edges of the mesh that were restored, sorted
  std::vector<Primitive> primitives;  // that the scan was found to consist of
  int rounds = 0;
  EnrichStop stop = EnrichStop::all_content;
  // Nothing was added, since the volume would have changed by more than points between those of a bent scan can tell.
  bool gave_up = false;
};

// Precondition: `mesh` is an oriented manifold (NotMeshable otherwise); it may have borders. Original vertices keep
// their order (vertices that no face uses are dropped), borders their edges, the surface its topology. They keep their
// places, too, but for those on primitives (by at most 4 of its sigmas, or an eighth of an edge onto a crease) and
// those of noisy scans, which are smoothed. On free forms new and smoothed points lie outside of round surfaces by as
// much as gives back what chords of the scan cut off (curved_volume.hpp). Edges are flipped near new vertices only, and
// never across creases. Faces that a move turned over or drove through others are put back. Where nothing is missing
// nothing changes; nor where the triharmonic lift of a bent surface would change the volume by more than twice what the
// scan's triangles cut off (curved_volume.hpp). Throws WrongUsage for options out of range. On any throw `mesh` is as
// it was. Deterministic, one thread; O((n + m) log n) for n vertices and m new ones, about 100 microseconds a new
// vertex. Not guaranteed: that what a gap of the scan hid is known; that a surface that crossed itself before does not
// afterwards.
EnrichResult enrich(SurfaceMesh& mesh, const EnrichOptions& options = {}, const Progress& progress = {});

}  // namespace scan2fea
