// The whole chain from a scan to a mesh: of a cloud reconstruct, repair, enrich, simplify, tetrahedralize, second
// order.
#pragma once

#include "preproc/layers/layer_heights.hpp"
#include "preproc/mesh/point_cloud.hpp"
#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/mesh/tet_mesh.hpp"
#include "preproc/surface/enrichment/enrich.hpp"
#include "preproc/surface/faces/idealise.hpp"
#include "preproc/surface/faces/select_sets.hpp"
#include "preproc/surface/reconstruction/reconstruct.hpp"
#include "preproc/surface/repair/repair.hpp"
#include "preproc/surface/simplification/simplify.hpp"
#include "preproc/volume/tetrahedralize.hpp"
#include "preproc/weak_places.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace scan2fea {

// One half of a part is meshed and mirrored.
struct SymmetryOptions {
  std::optional<int> axis = {};  // across this coordinate axis, 0 to 2; without, the best plane that there is
  bool operator==(const SymmetryOptions&) const = default;
};

// Vertices of a surface that was simplified may go along the scan where that makes better tetrahedra; none farther than
// this (slide_boundary.hpp). Of whole parts and first order: else WrongUsage.
struct SlideOptions {
  double distance = 0;  // > 0
  LargestDeviation::Unit unit = LargestDeviation::Unit::model;
};

// Layers of elements behind the triangles of a set, or of all of the surface; see add_layers.hpp. Of whole parts,
// without `slide`: else WrongUsage.
struct LayerOptions {
  std::string set = {};  // one of those that are asked for, or given; empty: all of the surface
  LayerHeights heights;
};

// A stage that is not asked for is left out; its input then goes on as it is.
struct PipelineOptions {
  ReconstructOptions reconstruct;  // of a cloud
  std::optional<RepairOptions> repair = RepairOptions{};
  std::optional<EnrichOptions> enrich;               // not by default: a scan that is dense enough needs none
  std::optional<NamedSelection> enrich_domain = {};  // instead of its own domain: the vertices of what is selected
  std::optional<SymmetryOptions> symmetry = {};
  std::optional<SimplifyOptions> simplify = SimplifyOptions{};
  std::optional<TetrahedralizeOptions> tetrahedralize = TetrahedralizeOptions{};
  std::optional<SlideOptions> slide = {};
  std::vector<LayerOptions> layers = {};
  int order = 1;  // 1: 4-node tetrahedra, 2: 10-node tetrahedra
  // Parts of the surface that get a name; their borders become lines of the mesh.
  std::vector<NamedSelection> sets = {};
  // Of the triangles of the scan as it is given: names that came with it. They are kept as sets, but for those that a
  // selection has taken, and those of all triangles, and expressions may name them.
  std::vector<NamedSet> given_sets = {};
  bool name_faces = false;                // each face of the scan is a set, FACE_1, ...; no lines are added
  std::optional<Idealise> idealise = {};  // the scan before it is simplified
};

// A set of the result's triangles.
struct MadeSet {
  std::string name;
  double area_of_scan = 0;  // of what was selected, without noise where faces of known shape were asked for
  double area = 0;          // of what was made; of second order, curved
  std::size_t triangles = 0;
};

// What became of one of several bodies that were given.
struct MadeBody {
  std::string name;
  double volume_of_scan = 0;  // of the solid that it shows as it was given
  double volume_joined = 0;   // after it was repaired and joined with others
  double volume = 0;          // of the elements as they are
  std::size_t tetrahedra = 0;
};

// Where two of them touch.
struct MadeContact {
  std::string first, second, set;    // bodies, and the set of the faces between them
  std::size_t triangles_closed = 0;  // of the second one's scan, which gave way to the first one's
  double largest_gap = 0, largest_overlap = 0, tolerance = 0;
  Vec3 at = Vec3::Zero();  // of the larger of both
};

// Where two of them face one another across a gap that stays open.
struct MadeGap {
  std::string first, second;
  double size = 0, tolerance = 0;  // where it is narrowest; up to which it would have been closed
  Vec3 at = Vec3::Zero();
};

// Where two of them have a line or a point in common, but no area, and so no nodes.
struct MadeTouch {
  std::string first, second;
  double length = 0, moved = 0;  // 0 of a point; how far they were drawn apart
  Vec3 at = Vec3::Zero();
};

// What one stage cost and did.
struct StageRecord {
  std::string name;
  double seconds = 0;
  std::uint64_t peak_bytes = 0;  // of the process while the stage ran; 0 where the system does not tell
  std::vector<std::pair<std::string, double>> changes;  // "holes_closed" -> 5, in the order they are shown
  std::vector<std::string> warnings;                    // what a person must know: what was lost of what the scan has
  std::vector<std::string> remarks;                     // and should: places of changes, a method that gave way
  std::vector<std::string> reasons;                     // and may: why it came out as it did
};

struct FittedCurves;

struct PipelineResult {
  // The scan as it was given, where repair changed it, and of several bodies all of theirs. What the result is compared
  // with is `reference()`.
  std::optional<SurfaceMesh> given;
  std::vector<Vec3> outliers;          // of a cloud, left out
  std::vector<Bridge> bridges;         // of its first surface
  std::optional<double> solid_volume;  // what `volume_of_solid(reference())` gives, where it is known already
  RepairResult repaired;
  SurfaceMesh scan;                   // after repair
  SurfaceMesh surface;                // the last surface of the chain
  std::vector<Primitive> primitives;  // of a part, where enrichment was asked for
  // Of `surface`, where it is an enriched one: so many vertices, the first, were measured.
  std::optional<std::size_t> measured_vertices;
  // Of `surface`, those that stand for creases and lines of the scan; sorted. None where the simplification was left
  // out.
  std::vector<FeatureEdge> line_edges;
  FeatureLines features;               // the scan's edges that simplification was to keep
  std::optional<TetMesh> volume_mesh;  // with the sets
  std::vector<NamedSet> face_sets;     // of `surface`; after those asked for, what was made up (made_up.hpp)
  std::vector<MadeSet> sets;           // the same in figures
  std::vector<MadeBody> bodies;        // where several were given (bodies_pipeline.hpp), and where these touch
  std::vector<MadeContact> contacts;
  std::vector<MadeGap> gaps;  // between them
  std::vector<MadeTouch> touches;
  // Of `surface`, of order 2 without a volume mesh: what bodies_pipeline.hpp makes of the outside of several.
  std::shared_ptr<const FittedCurves> curved;
  SurfaceFaces faces;  // of the scan as it came to simplification; none where nothing asked for them
  std::vector<StageRecord> stages;
  std::vector<WeakPlace> weak_places;  // of what was made; none of them is unusable
  std::vector<std::string> left_out;   // for want of time, improvements: "better tetrahedra"

  const SurfaceMesh& reference() const { return given ? *given : scan; }
};

// Called after each stage.
using StageListener = std::function<void(const StageRecord&)>;

// Where `progress` has an end, the first surface and the first filling are made until then; what is better is looked
// for while there is time, on the surface in half of what there is, so that as much is left for the tetrahedra. Throws
// what the stages throw: NotMeshable, OutOfTime, MeshingFailed, WrongUsage, Cancelled; and NotMeshable where what came
// out is unusable (see weak_places.hpp).
PipelineResult run_pipeline(SurfaceMesh scan, const PipelineOptions& options = {}, const Progress& progress = {},
                            const StageListener& listener = {});

// The same of a cloud: its scan is the surface reconstructed from it.
PipelineResult run_pipeline(const PointCloud& cloud, const PipelineOptions& options = {}, const Progress& progress = {},
                            const StageListener& listener = {});

}  // namespace scan2fea
