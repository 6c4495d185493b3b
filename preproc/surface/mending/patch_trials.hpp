// The states that a patch (refinement_patch.hpp) may take, each tried against the scan and the surface around it.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/kernel/locate.hpp"
#include "preproc/surface/mending/scan_of_patch.hpp"
#include "quality/deviation_bound.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace scan2fea {

struct PatchGoal {
  double limit = 0;    // largest deviation, two-sided, model units, that is worked towards
  double allowed = 0;  // and that does, at least the limit
  // Where these hold, and the limit elsewhere; 0: they hold everywhere.
  Ball where = {};
  double elsewhere = 0;
  double fidelity = 0;            // residual that costs as much as F(eta) = 1 (see shape_fit.hpp), model units
  double least_angle_deg = 35;    // smaller angles are not made, nor made smaller
  std::size_t most_vertices = 0;  // that may be inserted
  // The shape is to gain, with the deviation kept, instead of the other way round: angles of triangles, and halves of
  // those between faces, below `least_angle_deg` are what lacks.
  bool for_shape = false;
  // Faces may cross or be folded before: then any sound state is better, and reached, however far it is.
  bool may_be_tangled = false;
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
  SurfaceMesh patch{};
  std::vector<LineEdge> lines{};
  double missing_angles = 0;  // degrees
  // The sharpest angle between two faces, inside of the body or, eased, outside: elsewhere, and at edges on lines.
  double sharpest_deg = 180, sharpest_on_line_deg = 180;
  // Per face of the patch, of both sides: the scan's points belong to the face nearest to them.
  std::vector<double> deviation{};
  double merit = 0;        // sum of ((deviation - limit) / limit)^4 over the faces beyond the limit
  double lack = 0;         // sum of the squares of what angles lack of the least, degrees; only where that is the goal,
                           // and infinite where faces cross
  bool certified = false;  // the deviation is an upper bound for all points, not of samples
  std::uint32_t worst = 0;  // face of the patch, by what the goal is about

  std::size_t vertices() const { return patch.vertices.size(); }
  std::vector<FeatureEdge> edges_on_lines() const;  // sorted
};

// All that stays as it is while a patch changes.
class Surroundings {
 public:
  // `patch`: as it was cut out of `mesh`. `around`: the other faces of the mesh that the box meets. `scan_faces`: those
  // that it meets. Keeps references to outline and goal.
  Surroundings(const SurfaceMesh& mesh, const PatchOutline& outline, const SurfaceMesh& patch,
               const std::vector<std::uint32_t>& around, const SurfaceMesh& scan,
               const std::vector<std::uint32_t>& scan_faces, const PatchGoal& goal);

  // False where no part of the scan belongs to the patch, or so much of it is too far away that a piece of the surface
  // is missing, which no few vertices more bring back: then there is nothing to try.
  bool may_help(const SurfaceMesh& patch) const;

  // Shape and fit, see shape_fit.hpp; residuals of `fidelity` cost as much as F(eta) = 1.
  void fit(Trial& trial, double fidelity) const;

  // Brings points of both sides that are too far, or nearly, within the limit, and opens folds where shape is the goal,
  // by the least moves of the vertices there (see constraint_projection.hpp): without a word on the triangles' shape,
  // which such small moves change little. Not guaranteed: that all comes out.
  void pull(Trial& trial) const;

  // Lays the patch as a membrane over its rim and lines, which seldom crosses or folds, wherever the scan is: a sound
  // start for fits that a tangle leads astray.
  void relax(Trial& trial) const;

  // All but the deviation. False where the trial leaves the box or is worse in shape than `now`: smaller angles than
  // the least, or faces that close on one another more sharply than they did and than tetrahedra can bear.
  bool keeps_shape(Trial& trial, const Trial& now) const;

  // Whether faces close on one another so sharply that no fit will open them.
  bool is_folded(Trial& trial, const Trial& now) const;

  // The deviation of samples: much cheaper than a bound, and a little below it. Where the merit is more than `useful`
  // it is only told that it is.
  void sample_deviation(Trial& trial, double useful) const;

  // Raises the deviation to a bound.
  void certify(Trial& trial) const;

  // Whether it meets neither itself nor the surface around.
  bool is_clear(const Trial& trial) const;

 private:
  void find_rim_normals(const SurfaceMesh& patch);
  // What is allowed there, over the goal's limit.
  double allowance(const Vec3& p) const;

  struct PatchPoint {
    Location place;
    std::uint32_t scan_face;  // near it
  };
  // Both call visit until it says false, and return whether it did not. Points of the scan that are left to the patch:
  // visit(point, nearest), but for those within the distance of the face of the point before. The patch's own samples:
  // visit(face, point, nearest of the scan). Distances are over what is allowed at the point.
  template <class Visit>
  bool for_each_scan_point(const SurfaceMesh& patch, double distance, const Visit& visit) const;
  template <class Visit>
  bool for_each_own_point(const SurfaceMesh& patch, const Visit& visit) const;
  std::vector<Vec3> scan_points_beyond(const SurfaceMesh& patch, double distance) const;
  std::vector<PatchPoint> own_points_beyond(const SurfaceMesh& patch, double distance) const;
  // On the rim, or on lines.
  std::vector<bool> held_vertices(const Trial& trial) const;
  SurfaceMesh with_frozen(const SurfaceMesh& patch) const;
  template <class Visit>
  void for_each_hinge(const SurfaceMesh& patch, const Visit& visit) const;
  void open_folds(Trial& trial, const std::vector<bool>& held) const;
  void measure_shape(Trial& trial) const;
  void measure_lack(Trial& trial) const;
  void set_merit(Trial& trial) const;

  const PatchOutline& outline_;
  const PatchGoal& goal_;
  SurfaceMesh frozen_;  // the surface around; the patch's vertices as they were come first
  // Edges of the rim, sorted, and the normals of the faces beyond them.
  std::vector<std::pair<FeatureEdge, Vec3>> rim_normals_;
  std::optional<ScanOfPatch> scan_;  // none where the box meets none
};

}  // namespace scan2fea
