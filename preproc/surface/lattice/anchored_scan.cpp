#include "preproc/surface/lattice/anchored_scan.hpp"

#include "preproc/surface/features/curve_sampling.hpp"
#include "preproc/surface/features/feature_curves.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/components.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace scan2fea {
namespace {

// Edges of features are halved until they are shorter than this times the wanted edge length: each sample then has
// vertices of its own beside it.
constexpr double longest_feature_edge = 0.56;
// How far chords may be from a curve grows with the fourth power of the mean edge, from the given tolerance on edges of
// a hundredth of the diagonal, up to a part of the edge: on coarse meshes, samples as dense as a fixed tolerance asks
// for would force lengths on the surface that change faster than a lattice can follow.
constexpr double tolerance_growth = 9200;
constexpr double largest_tolerance_of_edge = 0.05;
// The growth of edge lengths from the curves into the surface. It is above the surface's own, 0.12, so that
// closely sampled curves make less of it fine.
constexpr double gradation_from_curves = 0.25;
// Rounds of sampling the curves and of telling the surface what came of it.
constexpr int rounds_of_spacing = 2;
// Where the number of triangles is free, the surface beside curves takes no shorter lengths than this part of the
// wanted ones: two corners at nearly the same place would make all of it fine.
constexpr double least_spacing = 0.1;
// A sample so near to a vertex of its curve, in parts of the segment, takes the vertex.
constexpr double snap = 1e-3;

// The scan before it is cut, growing finer.
struct Welded {
  SurfaceMesh mesh;
  std::vector<double> edge_length;
  std::vector<FeatureEdge> features;  // sharp and border edges
  bool closed;

  std::vector<FeatureEdge> border() const { return closed ? std::vector<FeatureEdge>{} : boundary_edges(mesh); }
  std::vector<FeatureEdge> sharp(const std::vector<FeatureEdge>& sorted_border) const {
    std::vector<FeatureEdge> sorted = features, inner;
    std::sort(sorted.begin(), sorted.end());
    std::set_difference(sorted.begin(), sorted.end(), sorted_border.begin(), sorted_border.end(),
                        std::back_inserter(inner));
    return inner;
  }
};

using SampledPlaces = std::vector<std::vector<double>>;  // per curve

// Arc length from the start of a curve to each of its vertices; closed: and back to the first.
std::vector<double> arc_lengths(const SurfaceMesh& mesh, const FeatureCurve& curve) {
  const std::size_t n = curve.vertices.size();
  std::vector<double> arc{0};
  for (std::size_t i = 1; i < n + (curve.closed ? 1 : 0); ++i)
    arc.push_back(arc.back() + (mesh.vertices[curve.vertices[i % n]] - mesh.vertices[curve.vertices[i - 1]]).norm());
  return arc;
}

double arc_at(const std::vector<double>& arc, double place) {
  const auto i = std::min(static_cast<std::size_t>(place), arc.size() - 2);
  const double t = place - static_cast<double>(i);
  return (1 - t) * arc[i] + t * arc[i + 1];
}

// The distance between the samples around each vertex of the curve, interpolated along it.
std::vector<double> spacing_along(const std::vector<double>& arc, const FeatureCurve& curve,
                                  const std::vector<double>& places) {
  std::vector<double> at;  // arc lengths of samples; closed: with one more before and behind
  for (const double place : places) at.push_back(arc_at(arc, place));
  if (curve.closed) {
    at.insert(at.begin(), at.back() - arc.back());
    at.push_back(at[1] + arc.back());
  }
  std::vector<double> of_sample(at.size());
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double before = i > 0 ? at[i] - at[i - 1] : at[1] - at[0];
    const double behind = i + 1 < at.size() ? at[i + 1] - at[i] : before;
    of_sample[i] = 0.5 * (before + behind);
  }
  std::vector<double> spacing(curve.vertices.size());
  for (std::size_t v = 0, i = 0; v < spacing.size(); ++v) {
    while (i + 2 < at.size() && at[i + 1] < arc[v]) ++i;
    const double t = std::clamp((arc[v] - at[i]) / (at[i + 1] - at[i]), 0.0, 1.0);
    spacing[v] = (1 - t) * of_sample[i] + t * of_sample[i + 1];
  }
  return spacing;
}

// What the samples are apart becomes the wanted length along the curves; at corners, the shortest.
void take_spacing(Welded& scan, const FeatureCurves& curves, const SampledPlaces& places, double least) {
  std::vector<double> spacing(scan.mesh.vertices.size(), 0);
  for (std::size_t c = 0; c < curves.curves.size(); ++c) {
    const FeatureCurve& curve = curves.curves[c];
    const std::vector<double> along = spacing_along(arc_lengths(scan.mesh, curve), curve, places[c]);
    for (std::size_t i = 0; i < along.size(); ++i) {
      const double asked = std::max(along[i], least * scan.edge_length[curve.vertices[i]]);
      double& s = spacing[curve.vertices[i]];
      s = s > 0 ? std::min(s, asked) : asked;
    }
  }
  for (std::size_t v = 0; v < spacing.size(); ++v)
    if (spacing[v] > 0) scan.edge_length[v] = spacing[v];
  limit_gradation(scan.mesh, gradation_from_curves, scan.edge_length);
}

void scale_to(Welded& scan, double triangles) {
  const double factor = std::sqrt(predicted_triangles(scan.mesh, {scan.edge_length}) / triangles);
  for (double& h : scan.edge_length) h *= factor;
}

// Of borders that another surface has already, its vertices there and no others.
void take_held(const FeatureCurves& curves, const std::vector<bool>& held, SampledPlaces& places) {
  for (std::size_t c = 0; c < places.size(); ++c) {
    if (!curves.curves[c].border) continue;
    places[c].clear();
    const std::vector<std::uint32_t>& vertices = curves.curves[c].vertices;
    for (std::size_t i = 0; i < vertices.size(); ++i)
      if (vertices[i] < held.size() && held[vertices[i]]) places[c].push_back(static_cast<double>(i));
  }
}

// Makes every sample a vertex of its curve; `places` are then whole numbers.
void insert_samples(Welded& scan, FeatureCurves& curves, SampledPlaces& places) {
  for (std::size_t c = 0; c < places.size(); ++c) {
    const double last = static_cast<double>(curves.curves[c].vertices.size()) - (curves.curves[c].closed ? 0 : 1);
    for (double& place : places[c]) {
      const double nearest = std::round(place);
      if (std::abs(place - nearest) < snap) place = nearest < last || !curves.curves[c].closed ? nearest : 0;
    }
    std::sort(places[c].begin(), places[c].end());
  }
  // One vertex per segment and round: the first sample on it.
  for (bool again = true; again;) {
    again = false;
    std::vector<EdgeSplit> splits;
    auto next_vertex = static_cast<std::uint32_t>(scan.mesh.vertices.size());
    for (std::size_t c = 0; c < places.size(); ++c) {
      std::vector<std::uint32_t>& old = curves.curves[c].vertices;
      std::vector<std::uint32_t> vertices;
      std::vector<double> moved;
      std::size_t k = 0;
      for (std::size_t i = 0; i < old.size(); ++i) {
        vertices.push_back(old[i]);
        double begin = static_cast<double>(i);
        const double end = begin + 1;
        for (bool split = false; k < places[c].size() && places[c][k] < end; ++k) {
          const double t = (places[c][k] - begin) / (end - begin);
          if (t <= 0 || split) {
            moved.push_back(static_cast<double>(vertices.size() - 1) + (split ? t : 0));
            again = again || (split && t > 0);
            continue;
          }
          const std::uint32_t a = old[i], b = old[(i + 1) % old.size()];
          splits.push_back({feature_edge(a, b), a < b ? t : 1 - t});
          vertices.push_back(next_vertex++);
          moved.push_back(static_cast<double>(vertices.size() - 1));
          begin = places[c][k];
          split = true;
        }
      }
      places[c] = std::move(moved);
      old = std::move(vertices);
    }
    split_edges(scan.mesh, scan.edge_length, scan.features, splits);
  }
}

// Numbers the samples, each vertex once, and draws the net of them.
void number_samples(const Welded& scan, const FeatureCurves& curves, const SampledPlaces& places, Anchors& anchors,
                    std::vector<std::uint32_t>& sample_of_vertex) {
  std::vector<std::uint32_t> number(scan.mesh.vertices.size(), no_sample);
  sample_of_vertex.assign(scan.mesh.vertices.size(), no_sample);
  for (std::size_t c = 0; c < curves.curves.size(); ++c) {
    const FeatureCurve& curve = curves.curves[c];
    FeatureLine line{.points = {}, .vertices = {}, .closed = curve.closed, .border = curve.border};
    for (const std::uint32_t v : curve.vertices) line.points.push_back(scan.mesh.vertices[v]);
    if (curve.closed) line.points.push_back(line.points.front());
    const std::vector<double> arc = arc_lengths(scan.mesh, curve);
    std::vector<double> at;
    for (const double place : places[c]) {
      const std::uint32_t v = curve.vertices[static_cast<std::size_t>(place)];
      if (number[v] == no_sample) {
        number[v] = static_cast<std::uint32_t>(anchors.samples.size());
        anchors.samples.push_back({scan.mesh.vertices[v], false});
      }
      if (curve.border) anchors.samples[number[v]].on_border = true;
      line.vertices.push_back({number[v], place});
      at.push_back(arc[static_cast<std::size_t>(place)]);
    }
    // Every vertex of the curve goes to the sample that is nearest along it.
    const std::size_t n = at.size();
    for (std::size_t i = 0; i < curve.vertices.size(); ++i) {
      const auto behind = static_cast<std::size_t>(std::upper_bound(at.begin(), at.end(), arc[i]) - at.begin());
      const double before_distance = behind > 0 ? arc[i] - at[behind - 1] : arc[i] - (at[n - 1] - arc.back());
      const double behind_distance = behind < n ? at[behind] - arc[i] : at[0] + arc.back() - arc[i];
      const std::size_t nearest = before_distance <= behind_distance ? (behind + n - 1) % n : behind % n;
      sample_of_vertex[curve.vertices[i]] = line.vertices[nearest].vertex;
    }
    anchors.net.lines.push_back(std::move(line));
    anchors.vertices_of_line.push_back(curve.vertices);
  }
  // A corner belongs to several curves, and has one number.
  for (std::size_t v = 0; v < number.size(); ++v)
    if (number[v] != no_sample) sample_of_vertex[v] = number[v];
}

// Per node the patch of the scan: triangle f of the refined scan is a part of triangle f of the scan.
std::vector<std::uint32_t> patches_of_nodes(const FeatureScan& scan, const SurfaceMesh& refined) {
  const Components parts = find_components(refined);
  std::vector<std::uint32_t> patch_of_part(parts.count, 0);
  for (std::size_t f = 0; f < scan.cut.mesh.triangles.size(); ++f)
    patch_of_part[parts.of_vertex[refined.triangles[f][0]]] = scan.patches.of_vertex[scan.cut.mesh.triangles[f][0]];
  std::vector<std::uint32_t> patch(parts.of_vertex.size());
  for (std::size_t v = 0; v < patch.size(); ++v) patch[v] = patch_of_part[parts.of_vertex[v]];
  return patch;
}

// The node of each vertex of the cut scan: of the copies on its patch, the one whose side looks most like it.
std::vector<std::uint32_t> nodes_of_scan_vertices(const FeatureScan& scan, const CutSurface& refined,
                                                  const std::vector<std::uint32_t>& patch_of_node) {
  std::vector<std::vector<std::uint32_t>> further(scan.scan.vertices.size());
  for (std::size_t c = refined.vertex_of_copy.size(); c-- > 0 && refined.vertex_of_copy[c] != c;)
    if (refined.vertex_of_copy[c] < further.size())
      further[refined.vertex_of_copy[c]].push_back(static_cast<std::uint32_t>(c));
  const std::vector<Vec3> scan_normals = vertex_normals(scan.cut.mesh), normals = vertex_normals(refined.mesh);
  std::vector<std::uint32_t> node(scan.cut.mesh.vertices.size());
  for (std::uint32_t v = 0; v < node.size(); ++v) {
    const auto likeness = [&](std::uint32_t copy) {
      return (patch_of_node[copy] == scan.patches.of_vertex[v] ? 2 : 0) + scan_normals[v].dot(normals[copy]);
    };
    node[v] = scan.cut.vertex_of_copy[v];
    for (const std::uint32_t copy : further[scan.cut.vertex_of_copy[v]])
      if (likeness(copy) > likeness(node[v])) node[v] = copy;
  }
  return node;
}

std::vector<NodeTangent> tangents_along(const CutSurface& cut, std::vector<FeatureEdge> features) {
  std::sort(features.begin(), features.end());
  std::vector<bool> on_feature(cut.mesh.vertices.size(), false);
  for (const auto& [a, b] : features) on_feature[a] = on_feature[b] = true;
  std::vector<NodeTangent> tangents;
  for (const Triangle& t : cut.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      const std::uint32_t wa = cut.vertex_of_copy[a], wb = cut.vertex_of_copy[b];
      if (!on_feature[wa] || !on_feature[wb]) continue;
      if (!std::binary_search(features.begin(), features.end(), feature_edge(wa, wb))) continue;
      const Vec3 along = cut.mesh.vertices[b] - cut.mesh.vertices[a];
      tangents.push_back({a, along});
      tangents.push_back({b, along});
    }
  return tangents;
}

template <class Value>
void permute(std::vector<Value>& values, const std::vector<std::uint32_t>& place) {
  std::vector<Value> moved(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) moved[place[i]] = values[i];
  values = std::move(moved);
}

}  // namespace

AnchoredScan anchor_scan(const FeatureScan& scan, const SizingOptions& options, double longest_scan_edge) {
  Welded welded{.mesh = scan.scan,
                .edge_length = compute_sizing_field(scan.scan, options, &scan.cut).edge_length,
                .features = scan.sharp,
                .closed = scan.border.empty()};
  welded.features.insert(welded.features.end(), scan.border.begin(), scan.border.end());
  double wanted = predicted_triangles(welded.mesh, {welded.edge_length});
  const auto refine = [&] {
    halve_long_edges(welded.mesh, welded.edge_length, welded.features, longest_scan_edge, longest_feature_edge);
  };
  refine();
  const double mean_edge = equilateral_edge(surface_area(scan.scan), wanted);
  const double diagonal = body_sizes(scan.scan).largest;
  const double tolerance = std::min(
      scan.tolerance.largest,
      std::max(scan.tolerance.least,
               mean_edge * std::min(largest_tolerance_of_edge, tolerance_growth * std::pow(mean_edge / diagonal, 3))));
  const double least = options.keeps_count ? 0 : least_spacing;
  FeatureCurves curves;
  SampledPlaces places;
  const auto sample = [&] {
    const std::vector<FeatureEdge> border = welded.border();
    // Of a held border all corners are known, and are vertices that are held.
    const CornerOptions corners =
        scan.held_border.empty() ? CornerOptions{} : CornerOptions{.turn_deg = 180, .jagged_turn_deg = 180};
    curves = trace_feature_curves(welded.mesh.vertices, welded.sharp(border), border, welded.edge_length, corners);
    places = sample_curves(welded.mesh, curves, welded.edge_length, {.tolerance = tolerance});
    if (!scan.held_border.empty()) take_held(curves, scan.held_border, places);
  };
  for (int round = 0; round < rounds_of_spacing; ++round) {
    sample();
    take_spacing(welded, curves, places, least);
    if (options.keeps_count) scale_to(welded, wanted);
    refine();
  }
  sample();
  take_spacing(welded, curves, places, least);
  if (!options.keeps_count) wanted = predicted_triangles(welded.mesh, {welded.edge_length});
  insert_samples(welded, curves, places);

  AnchoredScan result;
  result.triangles = wanted;
  result.anchors.net.tolerance = tolerance;
  std::vector<std::uint32_t> sample_of_vertex;
  number_samples(welded, curves, places, result.anchors, sample_of_vertex);
  CutSurface cut = cut_along(welded.mesh, welded.sharp(welded.border()));
  result.anchors.patch_of_node = patches_of_nodes(scan, cut.mesh);
  result.refined.scan_vertex_at = nodes_of_scan_vertices(scan, cut, result.anchors.patch_of_node);
  result.anchors.tangents = tangents_along(cut, welded.features);
  result.refined.edge_length.resize(cut.mesh.vertices.size());
  result.anchors.sample_of_node.resize(cut.mesh.vertices.size());
  for (std::size_t c = 0; c < cut.mesh.vertices.size(); ++c) {
    result.refined.edge_length[c] = welded.edge_length[cut.vertex_of_copy[c]];
    result.anchors.sample_of_node[c] = sample_of_vertex[cut.vertex_of_copy[c]];
  }
  result.anchors.welded = std::move(cut.vertex_of_copy);
  result.refined.mesh = std::move(cut.mesh);

  const std::vector<std::uint32_t> place = order_along_curve(result.refined.mesh, result.refined.edge_length);
  permute(result.anchors.patch_of_node, place);
  permute(result.anchors.sample_of_node, place);
  permute(result.anchors.welded, place);
  for (NodeTangent& t : result.anchors.tangents) t.node = place[t.node];
  for (std::uint32_t& node : result.refined.scan_vertex_at) node = place[node];
  return result;
}

}  // namespace scan2fea
