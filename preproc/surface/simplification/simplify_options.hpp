// What simplification is told, and what it tells.
#pragma once

#include "preproc/mesh/effort.hpp"
#include "preproc/surface/collapse/collapse_options.hpp"
#include "preproc/surface/features/feature_file.hpp"
#include "preproc/surface/features/find_features.hpp"
#include "preproc/surface/sizing/size_limits.hpp"
#include "preproc/surface/sizing/sizing_field.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace scan2fea {

// How large the triangles are to be: exactly one of these.
struct FaceCount {
  std::size_t faces;  // at least 4 per component
};
struct FaceRatio {
  double of_input;  // triangles of the result over those of the input, > 0
};
struct MeanEdgeLength {
  double length;  // model units
};
struct LargestDeviation {
  enum class Unit {
    model,
    // Of the scan's bounding box. run_pipeline takes the box along the given axes for what is required, else the
    // smallest along any: no larger, and the same however the scan lies.
    of_diagonal,
  };
  double distance;  // two-sided Hausdorff distance to the scan, > 0, bounded for all points
  Unit unit = Unit::model;
  bool required = true;  // false: where it is not reached, the nearest surface found is given
};
using TargetSize = std::variant<FaceCount, FaceRatio, MeanEdgeLength, LargestDeviation>;

// The same size; a deviation that is a part of the diagonal in model units.
TargetSize in_model_units(const TargetSize& size, const BoundingBox& scan);

enum class SimplifyMethod {
  collapse,  // the paper's: contractions predicted by a cost, vertices placed by a star objective
  lattice,   // fields on the scan, extraction, then entropy and fit optimised together
};

struct SimplifyOptions {
  SimplifyMethod method = SimplifyMethod::lattice;
  // An aim and no bound: nothing is refused that can be meshed at all, and where it is not reached, the result says so.
  TargetSize size = LargestDeviation{.distance = 0.002, .unit = LargestDeviation::Unit::of_diagonal, .required = false};
  Effort effort = Effort::normal;
  Sizing sizing = Sizing::curvature;
  // Whether a deviation is that of the curved triangles that are fitted afterwards (Simplification::curved), of which
  // fewer do.
  bool curved = false;
  double gradation = 0.12;  // largest |grad h| of the edge length h, 0.02 to 1; smaller is smoother
  SizeLimits limits;        // for the `lattice` method
  // Creases and their corners are kept exactly by the `lattice` method, and open borders always are. The angle unset:
  // no creases.
  FeatureOptions features;
  std::optional<FeatureLines> given_features;  // instead of those that would be found; see match_features.hpp
  // Whether given creases that triangles of this size cannot keep are given up, as those found are.
  bool may_drop_given = false;
  // Edges of the scan that are lines of the result besides its creases, whatever triangles they take: borders of sets.
  // For the `lattice` method; where it gives way, there are none.
  FeatureLines kept_lines;
  // Whether what is plane on the scan is plane on the result: vertices of lines may then leave them a little.
  bool keep_planes = true;
  CollapseOptions collapse;  // objective, placement and cost of the `collapse` method; its face count is set by `size`
};

struct SurfaceOnScan;

struct SimplifyResult {
  SimplifyMethod method = SimplifyMethod::lattice;  // the one that made the result
  std::string fallback_reason;                      // why `lattice` gave way to `collapse`; empty where it did not
  std::size_t faces_before = 0;
  std::size_t faces_after = 0;
  std::size_t crossings_mended = 0;  // pairs of faces that passed through one another before any was mended
  double largest_deviation = 0;      // an upper bound, two-sided, model units; only where the size is a deviation
  bool is_of_curved = false;         // triangles, that deviation
  double aimed_deviation = 0;        // what it was to be
  // The noise of single vertices, model units, for whose farthest the aim was made larger; 0: it was not.
  double noise_in_aim = 0;
  std::size_t feature_edges = 0;  // of the scan, that were found or given; the sharp ones of the next two as well
  std::vector<UnsupportedCreases> unsupported_creases;  // taken for folds, roundings or noise (see judge_creases)
  std::size_t feature_edges_too_fine = 0;               // creases that triangles of the wanted size cannot keep
  FeatureLines features;                                // the creases of the scan that were to be kept
  // Where triangles of the wanted size are too large for the features: how that was settled; empty where it was not so.
  std::string feature_remark;
  std::string size_remark;                       // where more triangles were made than were asked for
  std::size_t feature_edges_kept = 0;            // edges of the result that stand for creases and borders
  std::vector<FeatureEdge> line_edges;           // these edges, and those that stand for lines; sorted
  std::shared_ptr<const SurfaceOnScan> on_scan;  // for Simplification::curved; of `simplify`, none

  // Whether a deviation was asked for, and reached.
  bool keeps_deviation() const { return aimed_deviation > 0 && largest_deviation <= aimed_deviation; }
};

}  // namespace scan2fea
