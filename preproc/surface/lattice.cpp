#include "preproc/surface/lattice.hpp"

#include "preproc/surface/components.hpp"
#include "preproc/surface/extract_lattice.hpp"
#include "preproc/surface/field_graph.hpp"
#include "preproc/surface/parallel_blocks.hpp"
#include "preproc/surface/refined_scan.hpp"
#include "preproc/surface/spatial_order.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

constexpr double equilateral_area = 0.43301270189221932;  // sqrt(3)/4, of edge length 1
// A little more than wanted, since collapses of what is too much disturb the lattice less than splits.
constexpr double surplus = 1.01;
// Farther off than this, collapses and splits would spoil the lattice: it is laid anew with the lengths corrected.
constexpr double largest_miscount = 0.03;
constexpr int attempts = 3;
constexpr double tolerance = 0.005;  // of the number of triangles

double lattice_triangles(const GraphLevel& level) {
  return sum_over_blocks(level.size(), [&](std::size_t first, std::size_t last) {
    double sum = 0;
    for (std::size_t i = first; i < last; ++i) sum += level.areas[i] * std::exp(-2 * level.log_length[i]);
    return sum / equilateral_area;
  });
}

void scale_lengths(FieldGraph& graph, double factor) {
  for (GraphLevel& level : graph.levels)
    for (double& phi : level.log_length) phi += std::log(factor);
}

double share_of_valence_six(const SurfaceMesh& mesh) {
  std::vector<int> valence(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) ++valence[v];
  return static_cast<double>(std::count(valence.begin(), valence.end(), 6)) / static_cast<double>(valence.size());
}

}  // namespace

LatticeResult remesh_by_lattice(const SurfaceMesh& scan, const LatticeOptions& options, const Progress& progress) {
  progress("sizing", 0);
  SurfaceMesh ordered = scan;
  const std::vector<std::uint32_t> place = order_along_curve(ordered);
  SizingOptions sizing_options = options.sizing;
  std::vector<double> factors(options.sizing.factors.size());
  for (std::size_t v = 0; v < factors.size(); ++v) factors[place[v]] = options.sizing.factors[v];
  sizing_options.factors = factors;
  const SizingField sizing = compute_sizing_field(ordered, sizing_options);
  const double wanted = predicted_triangles(ordered, sizing);
  progress("graph", 0.15);
  const RefinedScan refined = refine_scan(std::move(ordered), sizing, options.longest_scan_edge);
  FieldGraph graph = build_field_graph(refined);
  progress("orientation", 0.3);
  const OrientationField orientation = compute_orientation_field(graph, options.orientation);
  relax_scale(graph, orientation, options.scale);

  LatticeResult result;
  ExtractedLattice extracted;
  double asked = surplus * wanted;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    scale_lengths(graph, std::sqrt(lattice_triangles(graph.levels.front()) / asked));
    progress("positions", 0.4);
    const PositionField position = compute_position_field(graph, orientation, options.position);
    progress("extraction", 0.85);
    extracted = extract_lattice(refined, graph.levels.front(), orientation, position);
    const double excess = static_cast<double>(extracted.mesh.triangles.size()) / wanted - 1;
    // What a contraction keeps beyond the lattice is collapsed later, as far as it can be.
    if (std::abs(excess) <= largest_miscount || extracted.contracted) break;
    asked /= 1 + excess;
  }
  result.mesh = std::move(extracted.mesh);
  result.edge_length.resize(result.mesh.vertices.size());
  const GraphLevel& finest = graph.levels.front();
  for (std::size_t i = 0; i < finest.size(); ++i)
    result.edge_length[extracted.vertex_of_node[i]] = std::exp(finest.log_length[i]);
  progress("connectivity", 0.95);
  ConnectivityOptions connectivity = options.connectivity;
  connectivity.triangles = static_cast<std::size_t>(std::lround(wanted));
  const ConnectivityResult cleaned = improve_connectivity(result.mesh, result.edge_length, connectivity);
  result.vertex_of_scan_vertex.resize(scan.vertices.size());
  for (std::size_t v = 0; v < scan.vertices.size(); ++v)
    result.vertex_of_scan_vertex[v] = cleaned.vertex_of_old[extracted.vertex_of_node[refined.scan_vertex_at[place[v]]]];
  result.contracted = extracted.contracted;
  if (static_cast<double>(result.mesh.triangles.size()) > (1 + tolerance) * wanted + 1)
    result.failure = "thin parts need " + std::to_string(result.mesh.triangles.size()) + " triangles instead of " +
                     std::to_string(*connectivity.triangles);
  result.regular_share = share_of_valence_six(result.mesh);
  return result;
}

}  // namespace scan2fea
