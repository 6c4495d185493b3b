#include "preproc/second_order.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/curved/fit_curves.hpp"
#include "preproc/surface/curved/keep_curved_volume.hpp"
#include "preproc/volume/two_sided_elements.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace scan2fea {
namespace {

// None where none came out, for want of time too.
std::optional<TetrahedralizeResult> filled_anew(const SurfaceMesh& surface,
                                                const TetrahedralizeOptions& tetrahedralization,
                                                const Progress& progress) {
  try {
    return tetrahedralize(surface, tetrahedralization, progress);
  } catch (const MeshingFailed&) {
    return {};
  } catch (const NotMeshable&) {
    return {};
  }
}

// Nodes that are eased change the volume a little, which the other nodes of edges take up: by so little that no element
// suffers. (Corners would count for nothing: their shape functions' integrals are zero.)
CurveResult curve(FittedCurves& fitted, TetMesh& mesh, const Progress& progress) {
  add_mid_edge_nodes(mesh);
  EdgePlaces to{fitted.surface.edges, fitted.surface.mid};
  CurveResult result = curve_mid_edge_nodes(mesh, to, progress);
  if (result.eased == 0) return result;
  const std::size_t corners = fitted.surface.corners.vertices.size();
  std::fill_n(fitted.directions.begin(), corners, Vec3::Zero());
  for (std::size_t e = 0; e < to.places.size(); ++e)
    if (fitted.surface.mid[e] != to.places[e]) fitted.directions[corners + e].setZero();
  fitted.surface.mid = std::move(to.places);
  keep_curved_volume(fitted.surface, fitted.volumes, fitted.directions);
  to.places = fitted.surface.mid;
  place_mid_edge_nodes(mesh, to);
  result.volume = total_volume(mesh);
  return result;
}

}  // namespace

SecondOrderResult make_second_order(const Simplification& search, const TetrahedralizeOptions& tetrahedralization,
                                    FilledSurface& made, const Progress& progress) {
  SecondOrderResult result;
  FittedCurves fitted = search.curved(made.simplified, made.surface, false, progress);
  std::optional<TetrahedralizeResult> filled = filled_anew(fitted.surface.corners, tetrahedralization, progress);
  if (!filled) {
    result.corners_kept = true;
    fitted = search.curved(made.simplified, made.surface, true, progress);
    filled = made.filled;
  }
  result.straight_triangles = fitted.straight;
  result.parted_elements =
      part_two_sided_elements(filled->mesh, fitted.surface.corners.vertices.size(), made.simplified.line_edges);
  result.curved = curve(fitted, filled->mesh, progress);
  made.filled = std::move(*filled);
  made.surface = std::move(fitted.surface.corners);
  return result;
}

}  // namespace scan2fea
