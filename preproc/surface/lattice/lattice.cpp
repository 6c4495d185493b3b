#include "preproc/surface/lattice/lattice.hpp"

#include "preproc/surface/kernel/components.hpp"
#include "preproc/surface/kernel/cut_surface.hpp"
#include "preproc/surface/kernel/parallel_blocks.hpp"
#include "preproc/surface/kernel/spatial_order.hpp"
#include "preproc/surface/lattice/anchored_scan.hpp"
#include "preproc/surface/lattice/extract_lattice.hpp"
#include "preproc/surface/lattice/field_graph.hpp"
#include "preproc/surface/lattice/thin_scan.hpp"
#include "preproc/surface/sizing/split_long_edges.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scan2fea {
namespace {

// A little more is asked for than wanted, since collapses of what is too much disturb the lattice less than splits.
// Beside creases the count is known less well, and splits do more harm: a vertex of four small faces may rise to a
// spike.
constexpr double surplus = 1.01;
constexpr double surplus_with_features = 1.02;
// Farther off than this, collapses and splits would spoil the lattice: it is laid anew with the lengths corrected.
constexpr double largest_miscount = 0.03;
constexpr int attempts = 3;
constexpr double tolerance = 0.005;  // of the number of triangles
// Vertices of the scan for one of the result, above which it is thinned to `enough_nodes`. A lattice on so many fewer
// is as good, and the fit that follows sees the whole scan. Not from 16: there the thinned one has a mean edge ratio of
// 1.041 instead of 1.034.
constexpr double many_nodes = 32, enough_nodes = 8;

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

// An improved cut mesh, welded again, with its net.
struct Rewelded {
  SurfaceMesh mesh;
  std::vector<double> edge_length;
  std::vector<std::uint32_t> vertex_of_old;  // per vertex of the mesh before cutting
  FeatureNet net;
};

Rewelded weld(SurfaceMesh improved, const std::vector<double>& edge_length,
              const std::vector<std::uint32_t>& improved_of_cut, const CutSurface& cut, const FeatureNet& net) {
  constexpr std::uint32_t none = no_sample;
  Rewelded result;
  const std::vector<bool> on_line = vertices_on_lines(net, cut.mesh.vertices.size());
  std::vector<std::uint32_t> number(improved.vertices.size(), none), of_welded(cut.mesh.vertices.size(), none);
  const auto take = [&](std::uint32_t v) {
    number[v] = static_cast<std::uint32_t>(result.mesh.vertices.size());
    result.mesh.vertices.push_back(improved.vertices[v]);
    result.edge_length.push_back(edge_length[v]);
  };
  // Copies of one vertex meet again.
  for (std::size_t c = 0; c < improved_of_cut.size(); ++c) {
    const std::uint32_t v = improved_of_cut[c], welded = cut.vertex_of_copy[c];
    if (!on_line[welded]) continue;
    if (of_welded[welded] == none) {
      take(v);
      of_welded[welded] = number[v];
    }
    number[v] = of_welded[welded];
  }
  for (std::uint32_t v = 0; v < number.size(); ++v)
    if (number[v] == none) take(v);
  for (std::size_t c = 0; c < improved_of_cut.size(); ++c)
    if (!on_line[cut.vertex_of_copy[c]]) of_welded[cut.vertex_of_copy[c]] = number[improved_of_cut[c]];
  const std::size_t old_vertices = *std::max_element(cut.vertex_of_copy.begin(), cut.vertex_of_copy.end()) + 1;
  result.vertex_of_old.assign(of_welded.begin(), of_welded.begin() + static_cast<std::ptrdiff_t>(old_vertices));

  const Components before = find_components(cut.mesh), after = find_components(improved);
  std::vector<std::uint32_t> patch_before(before.count), patch(after.count);
  for (std::size_t f = 0; f < cut.mesh.triangles.size(); ++f)
    patch_before[before.of_vertex[cut.mesh.triangles[f][0]]] = net.patch_of_face[f];
  for (std::size_t c = 0; c < improved_of_cut.size(); ++c)
    patch[after.of_vertex[improved_of_cut[c]]] = patch_before[before.of_vertex[c]];
  result.net.lines = net.lines;
  result.net.tolerance = net.tolerance;
  for (FeatureLine& line : result.net.lines)
    for (VertexOnLine& at : line.vertices) at.vertex = of_welded[at.vertex];
  for (Triangle& t : improved.triangles) {
    result.net.patch_of_face.push_back(patch[after.of_vertex[t[0]]]);
    t = {number[t[0]], number[t[1]], number[t[2]]};
  }
  result.mesh.triangles = std::move(improved.triangles);
  return result;
}

// The lattice on a scan that is ready for it. `vertex_of_scan_vertex` is by the scan's numbers at `scan_vertex_at`.
LatticeResult lay_lattice(const RefinedScan& refined, const Anchors& anchors, double wanted,
                          const LatticeOptions& options, const Progress& progress) {
  FieldGraph graph = build_field_graph(refined, anchors);
  progress("orientation", 0.3);
  const OrientationField orientation = compute_orientation_field(graph, options.orientation);
  relax_scale(graph, orientation, options.scale);

  LatticeResult result;
  ExtractedLattice extracted;
  double asked = (anchors.empty() ? surplus : surplus_with_features) * wanted;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    scale_lengths(graph, std::sqrt(lattice_triangles(graph.levels.front()) / asked));
    progress("positions", 0.4);
    const PositionField position = compute_position_field(graph, orientation, options.position);
    progress("extraction", 0.85);
    extracted = extract_lattice(refined, anchors, graph, orientation, position);
    const double excess = static_cast<double>(extracted.mesh.triangles.size()) / wanted - 1;
    // What a contraction keeps beyond the lattice is collapsed later, as far as it can be.
    if (std::abs(excess) <= largest_miscount || extracted.contracted) break;
    asked /= 1 + excess;
  }
  result.contracted = extracted.contracted;
  result.edge_length.resize(extracted.mesh.vertices.size());
  const GraphLevel& finest = graph.levels.front();
  for (std::size_t i = 0; i < finest.size(); ++i)
    result.edge_length[extracted.vertex_of_node[i]] = std::exp(finest.log_length[i]);

  progress("connectivity", 0.95);
  ConnectivityOptions connectivity = options.connectivity;
  connectivity.triangles = static_cast<std::size_t>(std::lround(wanted));
  std::vector<std::uint32_t> vertex_of_extracted;
  if (extracted.net.empty()) {
    result.mesh = std::move(extracted.mesh);
    vertex_of_extracted = improve_connectivity(result.mesh, result.edge_length, connectivity).vertex_of_old;
  } else {
    const CutSurface cut = cut_along(extracted.mesh, edges_of(extracted.net));
    SurfaceMesh improved = cut.mesh;
    std::vector<double> length(improved.vertices.size());
    for (std::size_t c = 0; c < length.size(); ++c) length[c] = result.edge_length[cut.vertex_of_copy[c]];
    connectivity.welded = cut.vertex_of_copy;
    const ConnectivityResult cleaned = improve_connectivity(improved, length, connectivity);
    Rewelded welded = weld(std::move(improved), length, cleaned.vertex_of_old, cut, extracted.net);
    result.mesh = std::move(welded.mesh);
    result.edge_length = std::move(welded.edge_length);
    result.net = std::move(welded.net);
    vertex_of_extracted = std::move(welded.vertex_of_old);
  }
  result.vertex_of_scan_vertex.resize(refined.scan_vertex_at.size());
  for (std::size_t v = 0; v < refined.scan_vertex_at.size(); ++v)
    result.vertex_of_scan_vertex[v] = vertex_of_extracted[extracted.vertex_of_node[refined.scan_vertex_at[v]]];
  if (static_cast<double>(result.mesh.triangles.size()) > (1 + tolerance) * wanted + 1)
    result.failure = "thin parts need " + std::to_string(result.mesh.triangles.size()) + " triangles instead of " +
                     std::to_string(*connectivity.triangles);
  result.regular_share = share_of_valence_six(result.mesh);
  return result;
}

}  // namespace

LatticeResult remesh_by_lattice(const SurfaceMesh& scan, const LatticeOptions& options, const Progress& progress) {
  progress("sizing", 0);
  SurfaceMesh nodes = scan;
  std::vector<std::uint32_t> node_of = order_along_curve(nodes);
  if (2 * static_cast<double>(nodes.vertices.size()) > many_nodes * options.sizing.triangles) {
    const std::vector<std::uint32_t> thinned =
        thin_scan(nodes, static_cast<std::size_t>(enough_nodes * options.sizing.triangles / 2));
    for (std::uint32_t& v : node_of) v = thinned[v];
  }
  // Of vertices that became one, the shortest length counts.
  std::vector<double> factors(options.sizing.factors.empty() ? 0 : nodes.vertices.size(),
                              std::numeric_limits<double>::infinity());
  for (std::size_t v = 0; v < options.sizing.factors.size(); ++v)
    factors[node_of[v]] = std::min(factors[node_of[v]], options.sizing.factors[v]);
  SizingOptions sizing_options = options.sizing;
  sizing_options.factors = factors;
  const SizingField sizing = compute_sizing_field(nodes, sizing_options);
  const double wanted = predicted_triangles(nodes, sizing);
  progress("graph", 0.15);
  RefinedScan refined = refine_scan(std::move(nodes), sizing, options.longest_scan_edge);
  for (std::uint32_t& v : node_of) v = refined.scan_vertex_at[v];
  refined.scan_vertex_at = std::move(node_of);
  return lay_lattice(refined, {}, wanted, options, progress);
}

LatticeResult remesh_by_lattice(const FeatureScan& features, const LatticeOptions& options, const Progress& progress) {
  progress("sizing", 0);
  const AnchoredScan scan = anchor_scan(features, options.sizing, options.longest_scan_edge);
  return lay_lattice(scan.refined, scan.anchors, scan.triangles, options, progress);
}

}  // namespace scan2fea
