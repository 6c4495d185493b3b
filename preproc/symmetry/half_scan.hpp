// Half of a symmetric scan, closed along its mirror plane.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/features/feature_file.hpp"
#include "preproc/symmetry/mirror_plane.hpp"

#include <array>

namespace scan2fea {

// Coordinates in which the plane is x = 0. Where its normal is a coordinate axis they are the scan's own, turned
// cyclically and shifted, so that points go there and back without rounding but for the shift.
class MirrorFrame {
 public:
  explicit MirrorFrame(const MirrorPlane& plane);
  Vec3 to_frame(const Vec3& p) const;
  Vec3 from_frame(const Vec3& p) const;
  static Vec3 mirrored(const Vec3& in_frame) { return {-in_frame.x(), in_frame.y(), in_frame.z()}; }

 private:
  std::array<Vec3, 3> axes_;
  double offset_;
};

struct HalfScan {
  SurfaceMesh mesh;        // in the frame, x >= 0; the cut's vertices have x = 0 exactly
  std::size_t cut_faces;   // the last of its triangles, which close the cut
  double cut_share;        // of the half's area
  FeatureLines cut_lines;  // the border of the cut
};

// The side to which the plane's normal points. Vertices nearer to the plane than a fiftieth of their shortest edge are
// put onto it, so that the cut leaves no slivers; the others stay. Preconditions: closed, manifold, no crossings; the
// plane meets the surface. Throws NotMeshable where the cut's border crosses itself. O(n log n).
HalfScan halve(const SurfaceMesh& scan, const MirrorFrame& frame);

// Both sides' lines on the half's side, each once.
FeatureLines lines_on_half(const FeatureLines& lines, const MirrorFrame& frame);

}  // namespace scan2fea
