// A piece of a surface around a place that lies too far from the scan, brought nearer by itself.
//
// Tries, in turn: the least moves that bring near what is too far (constraint_projection.hpp), a fit with more weight
// on what is far (shape_fit.hpp), edges of the worst face and around it flipped (an edge that runs along a ridge
// follows it, one that crosses it cuts it off), then split at their middle, the longest first, each followed by that
// fit. The first that is within the limit is taken; where none is, what lowers the deviation most, and it goes on from
// there. The rest of the surface stays as it is, so that the triangles around are not disturbed and patches apart from
// each other can be worked on at once.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/mending/patch_trials.hpp"
#include "preproc/surface/sizing/shorter_edges.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

struct PatchOutcome {
  bool improved = false;  // came nearer to the limit
  bool reached = false;   // is within it
};

class RefinementPatch {
 public:
  // The faces around the vertices `seeds` and those within `rings` rings of them. `deviation`: of the place; so
  // far, and a bit more, the scan and the surface around are looked at. `lines`: edges of the mesh whose vertices
  // stay as they are, which may be split where their lines are; see line_edges. O(faces of the patch).
  RefinementPatch(const SurfaceMesh& mesh, const VertexStars& stars, std::span<const std::uint32_t> seeds, int rings,
                  double deviation, const std::vector<LineEdge>& lines);

  // Everything that `improve` reads and writes lies in here: patches whose boxes do not meet may be improved at once
  // and written one after the other.
  const BoundingBox& box() const { return outline_.box; }
  const std::vector<std::uint32_t>& faces() const { return outline_.faces; }

  // `around`, `scan_faces`: other faces of the mesh, and faces of the scan, that the box meets, ascending. The patch
  // never passes through itself or the surface around, and its faces never close on one another or the surface around
  // more sharply than tetrahedra can bear. About a ms a trial and thousand scan faces. Deterministic, whatever the
  // number of threads.
  PatchOutcome improve(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& around, const SurfaceMesh& scan,
                       const std::vector<std::uint32_t>& scan_faces, const FeatureNet& net, const PatchGoal& goal);

  // Makes the edges in a place shorter, then works towards the goal as `improve` does. Kept where shape and deviation
  // are no worse, or where the deviation is the goal, so little that the next patches can mend it.
  PatchOutcome shorten(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& around, const SurfaceMesh& scan,
                       const std::vector<std::uint32_t>& scan_faces, const FeatureNet& net, const PatchGoal& goal,
                       const ShorterEdges& place);

  std::size_t inserted() const { return patch_.vertices.size() - outline_.vertices.size(); }

  // Puts the patch in its place, and its new vertices on the net's lines; new vertices and faces go to the end of the
  // mesh's.
  void write(SurfaceMesh& mesh, FeatureNet& net) const;

 private:
  Trial after_steps(Trial now, const Surroundings& surroundings, const FeatureNet& net, const PatchGoal& goal) const;
  Trial first_state(const Surroundings& surroundings, const PatchGoal& goal) const;
  bool holds(Trial& first, Trial& now, const Surroundings& surroundings) const;
  void take(Trial trial);

  PatchOutline outline_;
  SurfaceMesh patch_;
  std::vector<LineEdge> lines_;  // by the patch's vertices
};

}  // namespace scan2fea
