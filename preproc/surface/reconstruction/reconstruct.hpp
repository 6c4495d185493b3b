// A surface through the points of a cloud.
#pragma once

#include "preproc/mesh/names.hpp"
#include "preproc/mesh/point_cloud.hpp"
#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "quality/point_distances.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scan2fea {

enum class ReconstructionMethod {
  automatic,        // what fits clouds best: today always the next one
  advancing_front,  // through the points (delaunay.hpp, minimum_cut.hpp)
  poisson,          // smooth, near the points, for noisy organic scans (poisson.hpp)
};
inline constexpr NameTable<ReconstructionMethod, 3> reconstruction_method_names{
    {{ReconstructionMethod::automatic, "auto"},
     {ReconstructionMethod::advancing_front, "advancing-front"},
     {ReconstructionMethod::poisson, "poisson"}}};
constexpr std::string_view name_of(ReconstructionMethod method) {
  return name_in(reconstruction_method_names, method);
}

struct ReconstructOptions {
  ReconstructionMethod method = ReconstructionMethod::automatic;

  // Of larger clouds one point in each cell of a grid is taken, so that at most these are left. 1000 and more. 100,000:
  // a surface of 200,000 triangles, ten times what a mesh for a solver has, in some ten seconds.
  std::size_t largest_cloud = 100'000;

  // Gaps of the scan, where no front finds triangles, are closed up to this fraction of the bounding box's diagonal; a
  // larger one is an error. Unset: all are closed. [0, 1]. As RepairOptions::largest_hole_of_diagonal.
  std::optional<double> largest_gap_of_diagonal = 0.35;

  // Where the scanner stood, model units, whatever the cloud tells: each point was seen from one of these.
  std::vector<Vec3> scanners = {};
};

// A place where the surface spans what no points are near, a gap of the scan or a hole that was bridged, or where it
// closes a hole whose wall was found.
struct Bridge {
  Vec3 place;      // the middle of its longest edge; of a hole, on the surface at the axis
  double length;   // of that edge; of a hole, its diameter
  double spacing;  // of the points at its ends, the larger
  std::size_t triangles;
  std::optional<double> hole_radius = {};  // there
};

struct ReconstructResult {
  SurfaceMesh surface;  // vertices are points of the cloud, but of Poisson; closed and oriented outwards

  std::size_t kept = 0;          // points that the surface goes through, or by, before Poisson
  std::size_t repeated = 0;      // points in the place of others
  std::size_t thinned = 0;       // left out since a neighbour stays
  std::size_t merged = 0;        // nearer to another than noise
  std::vector<Vec3> outliers;    // left out: no surface through their neighbours holds them; where there are more than
                                 // corners look like, those off the surface, too
  std::size_t gaps = 0;          // patches that close what no front does
  double made_up_area = 0;       // of them
  std::vector<bool> is_made_up;  // per triangle of the surface: it closes a gap; empty for Poisson
  std::size_t off_surface = 0;   // points that were kept, but lie off the surface by half of the spacing
  double cell = 0;               // of the grid by which was thinned; 0: it was not
  double noise = 0;              // of single points: an estimate
  double spacing = 0;            // of the points that stayed: median
  PointDistances distances;      // of the given points without outliers from the surface
  std::vector<Bridge> bridges;   // holes first, longest first
  std::string choice;            // which surface was taken, and why
  std::vector<std::string> views;  // of normals and scanners that came with the cloud: what was used, and what not
};

// The cloud is cleaned (clean_cloud.hpp); advancing fronts of several settings and what they agree on are each made a
// closed surface by a minimum cut; the one taken is the most consistent: few pieces, points off it, edges of four
// triangles, and triangles that are far longer than the spacing. It may still have such edges, and pieces that are no
// body: repair.hpp mends that. Poisson takes its normals from that surface, which turns them by how it winds. Throws
// NotMeshable: too few points, all in one place, on a line or in a plane, or no closed surface through most of them.
// Parallel in part; the same for any number of threads, but of Poisson.
//
// Not guaranteed: that details finer than the spacing come out, that holes with fewer than about eight points along
// their rim stay open, nor that an open scene (terrain, a room) becomes what it shows.
ReconstructResult reconstruct(const PointCloud& cloud, const ReconstructOptions& options = {},
                              const Progress& progress = {});

}  // namespace scan2fea
