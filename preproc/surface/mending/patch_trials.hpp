// The states that a patch (refinement_patch.hpp) may take, each tried against the scan and the surface around it.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/fit/reference_surface.hpp"
#include "quality/triangle_tree.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace scan2fea {

struct PatchGoal {
  double limit = 0;               // largest deviation, two-sided, model units
  double fidelity = 0;            // residual that costs as much as F(eta) = 1 (see shape_fit.hpp), model units
  double least_angle_deg = 35;    // smaller angles are not made, nor made smaller
  std::size_t most_vertices = 0;  // that may be inserted
};

// Where a patch was cut out of the surface; it stays as it was while the patch changes.
struct PatchOutline {
  std::vector<std::uint32_t> faces;     // of the surface, ascending
  std::vector<std::uint32_t> vertices;  // of the surface, in the order of the patch's
  std::vector<bool> rim;                // per vertex: on the patch's rim
  double edge = 0;                      // mean edge length of the patch
  BoundingBox box;                      // the patch stays in here, and what it can meet reaches in here
};

// One state of a patch, and how good it is.
struct Trial {
  SurfaceMesh patch;
  std::vector<LineEdge> lines;
  bool sound = false;         // meets nothing, is within the box, no worse in shape than the state before, and nearer
  bool meets = false;         // the surface around, or itself, or leaves the box
  std::size_t inverted = 0;   // faces
  double merit = 0;           // sum of ((deviation - limit) / limit)^4 over the faces of both sides beyond the limit
  double missing_angles = 0;  // degrees
  double shape = 0;           // sum of F(eta)
  std::uint32_t worst = 0;    // face of the patch

  std::size_t vertices() const { return patch.vertices.size(); }
  bool is_better(const Trial& other) const {
    if (merit > 0 || other.merit > 0) return merit < other.merit;
    return vertices() != other.vertices() ? vertices() < other.vertices() : shape < other.shape;
  }
};

// All that stays as it is while a patch changes.
class Surroundings {
 public:
  // `patch`: as it was cut out of `mesh`. `scan_faces`: those that the box meets. Keeps references to outline and goal.
  Surroundings(const SurfaceMesh& mesh, const PatchOutline& outline, const SurfaceMesh& patch, const SurfaceMesh& scan,
               const std::vector<std::uint32_t>& scan_faces, const PatchGoal& goal);

  // False where no part of the scan belongs to the patch: then there is nothing to try.
  bool has_scan() const { return fit_scan_.has_value(); }

  // The state itself, without any fit.
  Trial judged(Trial trial) const;

  // The state after a fit, or as far towards it as nothing meets; shapes worse than those of `now` are not sound.
  Trial fitted(Trial trial, const Trial& now) const;

  // The state without a fit, its last vertex on the scan.
  Trial placed(Trial trial, const Trial& now) const;

 private:
  // Tells the parts of the scan for which the patch answers.
  void cut_scan(const SurfaceMesh& scan, const std::vector<std::uint32_t>& scan_faces, const SurfaceMesh& patch);

  SurfaceMesh with_frozen(const SurfaceMesh& patch) const;
  void fit(Trial& trial) const;
  void judge(Trial& trial, const Trial& now) const;
  double merit_of(const std::vector<double>& deviation) const;

  // The face of the patch nearest to a point of the scan, one that faces the other way only if all others are far.
  std::uint32_t face_at(const SurfaceMesh& patch, const Vec3& point, const Vec3& normal) const;

  const PatchOutline& outline_;
  const PatchGoal& goal_;
  SurfaceMesh frozen_;  // the surface around; the patch's vertices as they were come first
  SurfaceMesh scan_;    // within the box
  std::optional<TriangleTree> scan_tree_;
  SurfaceMesh answered_;  // parts of it whose nearest face, whichever way that looks, was one of the patch
  SurfaceMesh fit_part_;  // and those that belong to the patch
  std::optional<ReferenceSurface> fit_scan_;
};

// The faces with the vertices that they use; `vertices` says which of the mesh's each was, and may hold some already.
SurfaceMesh part_of(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& faces,
                    std::vector<std::uint32_t>& vertices);

}  // namespace scan2fea
