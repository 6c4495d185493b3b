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

namespace {

// What easing has taken of the volume, the other nodes of edges take up, along the directions that their edge of the
// fitted surface has.
void keep_volume(const FittedCurves& fitted, const std::vector<FeatureEdge>& of_surface, const EdgePlaces& wanted,
                 const EdgePlaces& placed, FilledSurface& made) {
  CurvedSurface surface(made.surface);
  std::vector<Vec3> directions(surface.nodes(), Vec3::Zero());
  const std::size_t corners = surface.corners.vertices.size(), fitted_corners = fitted.surface.corners.vertices.size();
  for (std::size_t i = 0; i < placed.edges.size(); ++i) {
    const auto at = std::ranges::lower_bound(surface.edges, placed.edges[i]);
    if (at == surface.edges.end() || *at != placed.edges[i]) continue;
    const auto e = static_cast<std::size_t>(at - surface.edges.begin());
    surface.mid[e] = placed.places[i];
    if (placed.places[i] != wanted.places[i]) continue;
    directions[corners + e] = fitted.directions[fitted_corners + fitted.surface.edge(of_surface[i])];
  }
  keep_curved_volume(surface, fitted.volumes, std::move(directions));
  place_mid_edge_nodes(made.filled.mesh, {surface.edges, surface.mid});
}

}  // namespace

SecondOrderResult curve_layers(const FittedCurves& fitted, const std::vector<ParallelEdge>& parallel,
                               FilledSurface& made, const Progress& progress) {
  TetMesh& mesh = made.filled.mesh;
  EdgePlaces to;
  std::vector<FeatureEdge> of_surface;  // of each place
  for (const auto& [edge, parent] : parallel) {
    if (!to.edges.empty() && to.edges.back() == edge) continue;
    const std::size_t e = fitted.surface.edge(parent);
    of_surface.push_back(parent);
    to.edges.push_back(edge);
    to.places.emplace_back((mesh.nodes[edge[0]] + mesh.nodes[edge[1]]) / 2 + fitted.surface.mid[e] -
                           fitted.surface.middle(e));
  }
  add_mid_edge_nodes(mesh);
  SecondOrderResult result;
  result.straight_triangles = fitted.straight;
  const EdgePlaces wanted = to;
  result.curved = curve_mid_edge_nodes(mesh, to, progress, made.flat_tetrahedra);
  keep_volume(fitted, of_surface, wanted, to, made);
  result.curved.volume = total_volume(mesh);
  return result;
}

}  // namespace scan2fea
