// A piece of a surface around a place that lies too far from the scan, brought nearer by itself.
//
// Tries, in turn and all around the worst face: a fit with more weight on what is far (shape_fit.hpp), edges flipped
// (an edge that runs along a ridge follows it, one that crosses it cuts it off), edges split at their middle, each
// followed by that fit; takes what lowers the deviation most, and goes on from there. The rest of the surface stays as
// it is, so that the triangles around are not disturbed and patches apart from each other can be worked on at once.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace scan2fea {

struct PatchGoal {
  double limit = 0;               // largest deviation, two-sided, model units
  double fidelity = 0;            // residual that costs as much as F(eta) = 1 (see shape_fit.hpp), model units
  double least_angle_deg = 35;    // smaller angles are not made, nor made smaller
  double edge = 0;                // mean edge length of the surface, model units
  std::size_t most_vertices = 0;  // that may be inserted
};

struct PatchOutcome {
  bool improved = false;  // came nearer to the limit
  bool reached = false;   // is within it
};

BoundingBox face_box(const SurfaceMesh& mesh, const Triangle& t);

class RefinementPatch {
 public:
  // The faces around the vertices of face `seed` and those within `rings` rings of them. `deviation`: of the place; so
  // far, and a bit more, the scan and the surface around are looked at. `lines`: edges of the mesh whose vertices
  // stay as they are, which may be split where their lines are; see line_edges. O(faces of the patch).
  RefinementPatch(const SurfaceMesh& mesh, const VertexStars& stars, std::uint32_t seed, int rings, double deviation,
                  const std::vector<LineEdge>& lines);

  // Everything that `improve` reads and writes lies in here: patches whose boxes do not meet may be improved at once
  // and written one after the other.
  const BoundingBox& box() const { return box_; }
  const std::vector<std::uint32_t>& faces() const { return faces_; }

  // `scan_faces`: those in the box, ascending. The patch never passes through itself or the surface around, and never
  // inverts a face against the scan. A few ms a trial and thousand scan faces; about 20 trials a step, at most 6 steps.
  // Deterministic, whatever the number of threads.
  PatchOutcome improve(const SurfaceMesh& mesh, const SurfaceMesh& scan, const std::vector<std::uint32_t>& scan_faces,
                       const FeatureNet& net, const PatchGoal& goal);

  std::size_t inserted() const { return patch_.vertices.size() - vertices_.size(); }

  // Puts the patch in its place, and its new vertices on the net's lines; new vertices and faces go to the end of the
  // mesh's.
  void write(SurfaceMesh& mesh, FeatureNet& net) const;

 private:
  std::vector<std::uint32_t> faces_;     // of the mesh
  std::vector<std::uint32_t> vertices_;  // of the mesh, in the order of the patch's
  std::vector<bool> rim_;                // per vertex: on the patch's rim
  std::vector<LineEdge> lines_;          // by the patch's vertices
  SurfaceMesh patch_;
  double edge_ = 0;  // mean edge length of the patch as it was
  BoundingBox box_;
};

}  // namespace scan2fea
