// Many places of a surface mended at once, each by its patch (refinement_patch.hpp).
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/surface/kernel/face_boxes.hpp"
#include "preproc/surface/mending/refinement_patch.hpp"
#include "quality/triangle_tree.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace scan2fea {

struct PatchPlace {
  std::vector<std::uint32_t> seeds;  // vertices of the surface, around which the patch is made
  double deviation = 0;              // so far the scan is looked for
  ShorterEdges shorter{};            // what is wanted there where edges are to be shorter
};

enum class Mending { improve, shorten };

// What the patches changed, and where the distance between mesh and scan may therefore be another.
struct PatchChanges {
  std::size_t patches = 0;                // that are better than they were
  std::size_t inserted = 0;               // vertices
  std::vector<std::uint32_t> changed;     // faces of the mesh
  std::vector<std::uint32_t> scan_faces;  // in the boxes of the patches
};

class PatchMender {
 public:
  // Keeps references to all. The net's patches of faces are emptied. `scan_tree`: of scan.mesh, where there is one;
  // without it each set of places that are apart costs a pass over the scan, and no memory, however large the scan is.
  PatchMender(SurfaceMesh& mesh, FeatureNet& net, const ReferenceSurface& scan, const TriangleTree* scan_tree);

  // Mends places that are apart from each other at once, until each has had its turn or lay within the patch of
  // another, which then stood for it. At most goal.most_vertices are inserted by all. Returns the places whose patches
  // have not reached the goal. Deterministic.
  std::vector<PatchPlace> mend(std::vector<PatchPlace> places, int rings, Mending how, const PatchGoal& goal,
                               const Progress& progress = {});

  // What has changed since the last time.
  PatchChanges take_changes() { return std::exchange(changes_, {}); }

 private:
  // Places apart from each other, with their patches, and those that must wait.
  struct Batch {
    std::vector<RefinementPatch> patches;
    std::vector<PatchPlace> places, later;
  };
  Batch next_batch(std::vector<PatchPlace> places, int rings, std::vector<bool>& is_covered) const;
  std::vector<std::vector<std::uint32_t>> scan_faces_near(const std::vector<RefinementPatch>& patches) const;
  std::vector<std::uint32_t> faces_around(const RefinementPatch& patch) const;
  void write(const RefinementPatch& patch, const std::vector<std::uint32_t>& scan_faces);

  SurfaceMesh& mesh_;
  FeatureNet& net_;
  const ReferenceSurface& scan_;
  const TriangleTree* scan_tree_;
  std::vector<BoundingBox> scan_blocks_;  // of the scan's faces by parallel block, where there is no tree
  FaceBoxes boxes_;
  std::size_t built_;  // faces that have a box there
  PatchChanges changes_;
};

}  // namespace scan2fea
