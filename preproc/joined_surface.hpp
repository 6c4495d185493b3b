// The surfaces of several bodies on the way from their scans to their meshes: the outside made as one, the pieces
// between bodies made to fit it, and each body filled.
#pragma once

#include "preproc/bodies/body_complex.hpp"
#include "preproc/pipeline.hpp"

#include <memory>
#include <vector>

namespace scan2fea {

// What is simplified as one surface: the outside, and closed pieces within, that have no border to fit.
struct Outside {
  SurfaceMesh mesh;
  std::vector<NamedSet> sets;  // of triangles with the same bodies on their sides
  std::vector<Sides> of_set;
};
Outside outside_of(const BodyComplex& scan);

// The result's surface with the bodies on the sides of its triangles: those of the outside come first. What only tells
// bodies apart is taken from the result's sets, the others are by its new numbers.
BodyComplex outside_as_made(const Outside& outside, PipelineResult& result);

// A piece between bodies, for curved sides.
struct MadeSheet {
  std::vector<std::uint32_t> vertices;           // of the complex, by those of the piece
  std::vector<Triangle> triangles;               // of the piece's vertices
  std::vector<bool> on_border;                   // per vertex
  std::shared_ptr<const SurfaceMesh> of_scan;    // to which the next refers
  std::shared_ptr<const SurfaceOnScan> on_scan;  // what it stands for
};

struct InterfaceResult {
  std::size_t sheets = 0, faces_before = 0, faces_after = 0;
  double largest_volume_shift = 0;  // of a vertex, model units
  double largest_deviation = 0;     // before it, an upper bound; only where the size is a deviation
  std::vector<MadeSheet> made;
};

// Adds the pieces between bodies to `made`, which has the outside, and restores the volume of each body as far as its
// free vertices can. `line_edges`: of the outside, which stay. Options as of simplify_sheet; where the size is a
// deviation, pieces that are farther from the scan are made again with shorter edges, a few times. Throws NotMeshable
// where no valid pieces come out, what came out crosses, or a deviation that is required is not reached.
InterfaceResult add_interfaces(const BodyComplex& scan, const SimplifyOptions& options,
                               const std::vector<FeatureEdge>& line_edges, BodyComplex& made, const Progress& progress);

// Fills one body and adds its tetrahedra, as one more set, and its inner nodes to the mesh, whose first nodes are the
// vertices of the complex and whose boundary its triangles.
TetrahedralizeResult fill_body(const BodyComplex& made, std::uint32_t body, const TetrahedralizeOptions& options,
                               const Progress& progress, TetMesh& mesh);

}  // namespace scan2fea
