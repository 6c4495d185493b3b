// The scan, made ready for edges as short as its shape needs at each place: for parts on which the lattice gave way.
#pragma once

#include "preproc/surface/simplification/prepared_scan.hpp"
#include "preproc/surface/simplification/simplify_options.hpp"

#include <vector>

namespace scan2fea {

struct ScanByShape {
  PreparedScanPointer scan;
  std::vector<double> length;  // of edges, per vertex of its mesh
};

// Edges as they were wanted of `scan`, and no longer than its shape allows (shape_lengths.hpp); all of them longer
// where these need more than `most_triangles`. Edges too short to matter are gone, as a union of shells leaves between
// corners that nearly meet. Creases are those of the scan for which these lengths leave room. Throws what
// compute_sizing_field throws.
ScanByShape prepare_by_shape(const PreparedScan& scan, const SizingOptions& sizing, const SimplifyOptions& options,
                             double most_triangles);

}  // namespace scan2fea
