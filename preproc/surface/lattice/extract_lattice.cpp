#include "preproc/surface/lattice/extract_lattice.hpp"

#include "preproc/surface/kernel/components.hpp"
#include "preproc/surface/lattice/contract_clusters.hpp"
#include "preproc/surface/lattice/lattice_clusters.hpp"

#include <algorithm>
#include <limits>
#include <span>

namespace scan2fea {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr int rounds_of_mending = 10;

struct LabelledFaces {
  std::vector<Triangle> faces;           // of roots
  std::vector<std::uint32_t> triangles;  // of the scan, that they come from
};

LabelledFaces faces_between(const SurfaceMesh& mesh, LatticeClusters& clusters) {
  LabelledFaces result;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    const Triangle f{clusters.find(t[0]), clusters.find(t[1]), clusters.find(t[2])};
    if (f[0] == f[1] || f[1] == f[2] || f[2] == f[0]) continue;
    result.faces.push_back(f);
    result.triangles.push_back(i);
  }
  return result;
}

// The faces at a vertex: whether one can turn around it from face to face and meet them all, from border to border
// where it lies on one.
bool is_umbrella(const std::vector<Triangle>& faces, std::span<const std::uint32_t> corners, bool on_border) {
  if (corners.size() < (on_border ? 1U : 3U)) return false;
  const auto ahead = [&](std::uint32_t c) { return faces[c / 3][(c + 1) % 3]; };
  const auto behind = [&](std::uint32_t c) { return faces[c / 3][(c + 2) % 3]; };
  std::uint32_t start = corners.front();
  if (on_border) {
    const auto begins = [&](std::uint32_t c) {
      return std::none_of(corners.begin(), corners.end(), [&](std::uint32_t d) { return behind(d) == ahead(c); });
    };
    const auto at = std::find_if(corners.begin(), corners.end(), begins);
    if (at == corners.end()) return false;
    start = *at;
  }
  std::size_t met = 0;
  for (std::uint32_t c = start; met < corners.size();) {
    ++met;
    std::uint32_t following = none;
    int ways = 0;
    for (const std::uint32_t d : corners)
      if (ahead(d) == behind(c)) {
        following = d;
        ++ways;
      }
    if (ways == 0 && on_border) return met == corners.size();
    if (ways != 1) return false;
    if (following == start) return met == corners.size() && !on_border;
    c = following;
  }
  return false;
}

// Sets at places where the faces do not make a manifold: of each such place the smallest that may be dissolved.
// Nothing where there is such a place and no set may be.
struct Offenders {
  std::vector<std::uint32_t> sets;
  bool hopeless = false;
};

Offenders find_offenders(const std::vector<Triangle>& faces, LatticeClusters& clusters,
                         const std::vector<bool>& on_border) {
  // Faces by the set at one of their corners.
  const std::size_t nodes = on_border.size();
  std::vector<std::uint32_t> first(nodes + 1, 0);
  for (const Triangle& f : faces)
    for (const std::uint32_t v : f) ++first[v + 1];
  for (std::size_t v = 0; v < nodes; ++v) first[v + 1] += first[v];
  std::vector<std::uint32_t> corners(3 * faces.size());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t c = 0; c < corners.size(); ++c) corners[next[faces[c / 3][c % 3]]++] = c;

  Offenders found;
  const auto smaller = [&](std::uint32_t a, std::uint32_t b) {
    if (b == none) return true;
    return clusters.cells(a) < clusters.cells(b) || (clusters.cells(a) == clusters.cells(b) && a < b);
  };
  for (std::uint32_t v = 0; v < nodes; ++v) {
    if (clusters.find(v) != v) continue;
    const std::span<const std::uint32_t> star{corners.data() + first[v], first[v + 1] - first[v]};
    if (is_umbrella(faces, star, on_border[v])) continue;
    std::uint32_t smallest = clusters.is_anchored(v) ? none : v;
    for (const std::uint32_t c : star)
      for (const std::uint32_t w : faces[c / 3])
        if (!clusters.is_anchored(w) && smaller(w, smallest)) smallest = w;
    if (smallest == none)
      found.hopeless = true;
    else
      found.sets.push_back(smallest);
  }
  std::sort(found.sets.begin(), found.sets.end());
  found.sets.erase(std::unique(found.sets.begin(), found.sets.end()), found.sets.end());
  return found;
}

// Whether the result is manifold is known by then: then these numbers say the rest.
bool has_topology_of(const SurfaceMesh& scan, const Anchors& anchors, const ExtractedLattice& result) {
  const SurfaceMesh welded = anchors.empty() ? SurfaceMesh{} : welded_scan(scan, anchors.welded);
  const SurfaceMesh& whole = anchors.empty() ? scan : welded;
  const auto border_of = [&](const SurfaceMesh& mesh) {
    return anchors.empty() ? std::vector<FeatureEdge>{} : boundary_edges(mesh);
  };
  const Components before = find_components(whole), after = find_components(result.mesh);
  if (after.count != before.count) return false;
  const std::vector<long> euler_before = euler_characteristics(whole, before, border_of(whole));
  const std::vector<long> euler_after = euler_characteristics(result.mesh, after, border_of(result.mesh));
  for (std::size_t i = 0; i < scan.vertices.size(); ++i) {
    const std::size_t v = anchors.empty() ? i : anchors.welded[i];
    if (euler_before[before.of_vertex[v]] != euler_after[after.of_vertex[result.vertex_of_node[i]]]) return false;
  }
  return true;
}

bool has_edges(const SurfaceMesh& mesh, const std::vector<FeatureEdge>& edges) {
  std::vector<FeatureEdge> all;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) all.push_back(feature_edge(t[k], t[(k + 1) % 3]));
  std::sort(all.begin(), all.end());
  return std::adjacent_find(edges.begin(), edges.end()) == edges.end() &&
         std::includes(all.begin(), all.end(), edges.begin(), edges.end());
}

// Dissolves what offends until nothing does; false where that does not end.
bool merge_into_manifold(const SurfaceMesh& scan, const Anchors& anchors, LatticeClusters& clusters,
                         ExtractedLattice& result) {
  const std::size_t nodes = scan.vertices.size();
  LabelledFaces labelled;
  bool manifold = false;
  for (int round = 0; round < rounds_of_mending && !manifold; ++round) {
    labelled = faces_between(scan, clusters);
    std::vector<bool> on_border(nodes, false);
    for (std::uint32_t i = 0; i < anchors.sample_of_node.size(); ++i) {
      const std::uint32_t sample = anchors.sample_of_node[i];
      if (sample != no_sample && anchors.samples[sample].on_border) on_border[clusters.find(i)] = true;
    }
    const Offenders bad = find_offenders(labelled.faces, clusters, on_border);
    if (bad.hopeless) return false;
    for (const std::uint32_t root : bad.sets)
      if (clusters.find(root) == root) clusters.dissolve(root);
    manifold = bad.sets.empty();
  }
  if (!manifold) return false;
  result.vertex_of_node.resize(nodes);
  std::vector<std::uint32_t> number(nodes, none);
  for (std::uint32_t i = 0; i < number.size(); ++i) {
    const std::uint32_t root = clusters.find(i);
    if (number[root] == none) {
      number[root] = static_cast<std::uint32_t>(result.mesh.vertices.size());
      result.mesh.vertices.push_back(clusters.point(root));
    }
    result.vertex_of_node[i] = number[root];
  }
  result.mesh.triangles = std::move(labelled.faces);
  for (Triangle& f : result.mesh.triangles) f = {number[f[0]], number[f[1]], number[f[2]]};
  if (!anchors.empty()) {
    std::vector<std::uint32_t> vertex_of_sample(anchors.samples.size(), none);
    for (std::size_t i = 0; i < nodes; ++i)
      if (anchors.sample_of_node[i] != no_sample)
        vertex_of_sample[anchors.sample_of_node[i]] = result.vertex_of_node[i];
    result.net = anchors.net;
    for (FeatureLine& line : result.net.lines)
      for (VertexOnLine& at : line.vertices) at.vertex = vertex_of_sample[at.vertex];
    for (const std::uint32_t t : labelled.triangles)
      result.net.patch_of_face.push_back(anchors.patch_of_node[scan.triangles[t][0]]);
    if (!has_edges(result.mesh, edges_of(result.net))) return false;
  }
  return has_topology_of(scan, anchors, result);
}

}  // namespace

ExtractedLattice extract_lattice(const RefinedScan& scan, const Anchors& anchors, const FieldGraph& graph,
                                 const OrientationField& orientation, const PositionField& position) {
  ExtractedLattice result;
  LatticeClusters clusters(graph, orientation, position);
  if (merge_into_manifold(scan.mesh, anchors, clusters, result)) return result;
  LatticeClusters undissolved(graph, orientation, position);  // without what the attempt has dissolved
  return contract_clusters(scan.mesh, anchors, undissolved);
}

}  // namespace scan2fea
