#include "preproc/second_order.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/curved/curved_deviation.hpp"
#include "preproc/surface/curved/fit_curves.hpp"
#include "preproc/surface/curved/keep_curved_volume.hpp"
#include "preproc/surface/simplification/surface_on_scan.hpp"
#include "preproc/volume/two_sided_elements.hpp"

#include <algorithm>
#include <map>
#include <numeric>
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

// None where none was reached.
std::vector<std::uint32_t> lost_deviation(const SimplifyResult& simplified, const CurvedSurface& surface) {
  if (!simplified.keeps_deviation()) return {};
  constexpr double as_told = 1.01;  // faces_beyond is right to a hundredth
  const KeptDeviation kept{simplified.on_scan->scan->deviation_reference(), as_told * simplified.aimed_deviation};
  std::vector<std::uint32_t> all(surface.corners.triangles.size());
  std::iota(all.begin(), all.end(), 0U);
  return faces_beyond(surface, kept, all);
}

}  // namespace

// (Corners would count for nothing: their shape functions' integrals are zero.)
void curve_as_fitted(CurvedSurface& surface, std::vector<Vec3>& directions, const VolumeKeeper& keep_volume,
                     TetMesh& mesh, SecondOrderResult& result, const Progress& progress) {
  add_mid_edge_nodes(mesh);
  EdgePlaces to{surface.edges, surface.mid};
  result.curved = curve_mid_edge_nodes(mesh, to, progress);
  if (result.curved.eased == 0) return;
  const std::size_t corners = surface.corners.vertices.size();
  std::fill_n(directions.begin(), corners, Vec3::Zero());
  for (std::size_t e = 0; e < to.places.size(); ++e)
    if (surface.mid[e] != to.places[e]) directions[corners + e].setZero();
  surface.mid = std::move(to.places);
  result.keeps_volume = keep_volume(directions, surface);
  to.places = surface.mid;
  place_mid_edge_nodes(mesh, to);
  result.curved.volume = total_volume(mesh);
}

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
  const auto keep_volume = [&](const std::vector<Vec3>& directions, CurvedSurface& surface) {
    return keep_curved_volume(surface, fitted.volumes, directions);
  };
  curve_as_fitted(fitted.surface, fitted.directions, keep_volume, filled->mesh, result, progress);
  if (result.curved.eased > 0) result.beyond = lost_deviation(made.simplified, fitted.surface);
  made.filled = std::move(*filled);
  made.surface = std::move(fitted.surface.corners);
  return result;
}

SecondOrderResult curve_on_scan(const SurfaceMesh& scan, FilledSurface& made, const Progress& progress) {
  SecondOrderResult result;
  TetMesh& mesh = made.filled.mesh;
  add_mid_edge_nodes(mesh);
  EdgePlaces to = nearest_on_scan(mesh, TriangleTree(scan));
  result.curved = curve_mid_edge_nodes(mesh, to, progress);
  if (!made.simplified.is_of_curved) return result;
  CurvedSurface surface(made.surface);
  for (std::size_t i = 0; i < to.edges.size(); ++i) surface.mid[surface.edge(to.edges[i])] = to.places[i];
  result.beyond = lost_deviation(made.simplified, surface);
  return result;
}

namespace {

// Where the node of an edge is to be, and the edge of the fitted surface that it is parallel to; that is none where it
// is on the scan by itself.
struct PlacedEdge {
  Vec3 place;
  std::optional<FeatureEdge> parent;
};
using PlacedEdges = std::map<FeatureEdge, PlacedEdge>;

PlacedEdges places_of(const FittedCurves& fitted, const std::vector<ParallelEdge>& parallel, const SurfaceMesh& scan,
                      const FilledSurface& made) {
  const TetMesh& mesh = made.filled.mesh;
  const CurvedSurface& surface = fitted.surface;
  PlacedEdges placed;
  for (const auto& [edge, parent] : parallel) {
    const std::size_t e = surface.edge(parent);
    const Vec3 middle = (mesh.nodes[edge[0]] + mesh.nodes[edge[1]]) / 2;
    placed.try_emplace(edge, middle + surface.mid[e] - surface.middle(e), parent);
  }
  const auto is_as_fitted = [&](std::uint32_t v) {
    return v < surface.corners.vertices.size() && mesh.nodes[v] == surface.corners.vertices[v];
  };
  const EdgePlaces on_scan = nearest_on_scan(mesh, TriangleTree(scan));
  for (std::size_t i = 0; i < on_scan.edges.size(); ++i) {
    const FeatureEdge& edge = on_scan.edges[i];
    const bool is_on_line = std::ranges::binary_search(made.simplified.line_edges, edge);
    if (is_on_line || (is_as_fitted(edge[0]) && is_as_fitted(edge[1]))) continue;
    placed.insert_or_assign(edge, PlacedEdge{on_scan.places[i], std::nullopt});
  }
  return placed;
}

// What easing has taken of the volume, the other nodes of edges take up, along the directions that their edge of the
// fitted surface has.
CurvedSurface with_volume(const FittedCurves& fitted, const PlacedEdges& wanted, const EdgePlaces& placed,
                          FilledSurface& made, SecondOrderResult& result) {
  CurvedSurface surface(made.surface);
  std::vector<Vec3> directions(surface.nodes(), Vec3::Zero());
  const std::size_t corners = surface.corners.vertices.size(), fitted_corners = fitted.surface.corners.vertices.size();
  for (std::size_t i = 0; i < placed.edges.size(); ++i) {
    const auto at = std::ranges::lower_bound(surface.edges, placed.edges[i]);
    if (at == surface.edges.end() || *at != placed.edges[i]) continue;
    const auto e = static_cast<std::size_t>(at - surface.edges.begin());
    surface.mid[e] = placed.places[i];
    const PlacedEdge& as_wanted = wanted.at(placed.edges[i]);
    if (as_wanted.parent && placed.places[i] == as_wanted.place)
      directions[corners + e] = fitted.directions[fitted_corners + fitted.surface.edge(*as_wanted.parent)];
  }
  result.keeps_volume = keep_curved_volume(surface, fitted.volumes, std::move(directions));
  place_mid_edge_nodes(made.filled.mesh, {surface.edges, surface.mid});
  return surface;
}

}  // namespace

SecondOrderResult curve_layers(const FittedCurves& fitted, const std::vector<ParallelEdge>& parallel,
                               const SurfaceMesh& scan, FilledSurface& made, const Progress& progress) {
  TetMesh& mesh = made.filled.mesh;
  add_mid_edge_nodes(mesh);
  const PlacedEdges wanted = places_of(fitted, parallel, scan, made);
  EdgePlaces to;
  for (const auto& [edge, placed] : wanted) {
    to.edges.push_back(edge);
    to.places.push_back(placed.place);
  }
  SecondOrderResult result;
  result.straight_triangles = fitted.straight;
  result.curved = curve_mid_edge_nodes(mesh, to, progress, made.flat_tetrahedra);
  result.beyond = lost_deviation(made.simplified, with_volume(fitted, wanted, to, made, result));
  result.curved.volume = total_volume(mesh);
  return result;
}

}  // namespace scan2fea
