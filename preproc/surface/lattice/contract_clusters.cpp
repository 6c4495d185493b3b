#include "preproc/surface/lattice/contract_clusters.hpp"

#include "preproc/surface/kernel/halfedge_mesh.hpp"
#include "preproc/surface/lattice/lattice_clusters.hpp"

#include <algorithm>
#include <numeric>

namespace scan2fea {
namespace {

// Who is next to whom along the features.
class FeatureChains {
 public:
  FeatureChains(const Anchors& anchors, std::size_t vertices) : neighbours_(vertices), is_sample_(vertices, false) {
    for (std::size_t l = 0; l < anchors.net.lines.size(); ++l) {
      const FeatureLine& line = anchors.net.lines[l];
      const std::vector<std::uint32_t>& points = anchors.vertices_of_line[l];
      for (std::size_t i = 0; i + (line.closed ? 0 : 1) < points.size(); ++i) {
        const std::uint32_t a = points[i], b = points[(i + 1) % points.size()];
        neighbours_[a].push_back(b);
        neighbours_[b].push_back(a);
      }
      for (const VertexOnLine& at : line.vertices) is_sample_[points[static_cast<std::size_t>(at.place)]] = true;
    }
  }

  bool is_sample(std::uint32_t v) const { return is_sample_[v]; }
  bool is_on_line(std::uint32_t v) const { return !neighbours_[v].empty(); }

  bool may_contract(std::uint32_t kept, std::uint32_t removed) const {
    const std::vector<std::uint32_t>& along = neighbours_[removed];
    if (along.empty()) return true;
    return !is_sample_[removed] && std::find(along.begin(), along.end(), kept) != along.end();
  }

  void contract(std::uint32_t kept, std::uint32_t removed) {
    if (neighbours_[removed].empty()) return;
    // Not a sample, so no corner: it has two neighbours.
    const std::uint32_t other = neighbours_[removed][neighbours_[removed][0] == kept ? 1 : 0];
    std::replace(neighbours_[kept].begin(), neighbours_[kept].end(), removed, other);
    std::replace(neighbours_[other].begin(), neighbours_[other].end(), removed, kept);
    neighbours_[removed].clear();
  }

 private:
  std::vector<std::vector<std::uint32_t>> neighbours_;
  std::vector<bool> is_sample_;
};

// Contracts edges inside of the clusters while there are any that may be. Per vertex, the one that is left of it.
std::vector<std::uint32_t> contract_edges(HalfedgeMesh& mesh, FeatureChains& chains,
                                          const std::vector<std::uint32_t>& cluster) {
  std::vector<std::uint32_t> into(mesh.vertex_slots());
  std::iota(into.begin(), into.end(), 0U);
  for (bool changed = true; changed;) {
    changed = false;
    for (HalfedgeMesh::Index h = 0; h < 3 * mesh.face_slots(); ++h) {
      if (!mesh.is_face_alive(HalfedgeMesh::face(h))) continue;
      const std::uint32_t kept = mesh.origin(h), removed = mesh.target(h);
      if (cluster[kept] != cluster[removed] || !chains.may_contract(kept, removed) || !mesh.can_collapse(h)) continue;
      mesh.collapse(h);
      chains.contract(kept, removed);
      into[removed] = kept;
      changed = true;
    }
  }
  for (std::uint32_t v = 0; v < into.size(); ++v) {
    std::uint32_t end = v;
    while (into[end] != end) end = into[end];
    into[v] = end;
  }
  return into;
}

// A cluster that became one vertex lies at its lattice point, parts of others where their nodes were, and what is on a
// feature stays on it.
void place_vertices(HalfedgeMesh& mesh, const FeatureChains& chains, const std::vector<std::uint32_t>& cluster,
                    const std::vector<std::uint32_t>& into, const LatticeClusters& clusters) {
  const std::size_t vertices = mesh.vertex_slots();
  std::vector<std::uint32_t> parts(clusters.size(), 0);
  std::vector<Vec3> sums(vertices, Vec3::Zero());
  std::vector<double> counts(vertices, 0);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    sums[into[v]] += mesh.points[v];
    ++counts[into[v]];
    if (into[v] == v) ++parts[cluster[v]];
  }
  for (std::uint32_t v = 0; v < vertices; ++v) {
    if (!mesh.is_alive(v) || chains.is_on_line(v)) continue;
    mesh.points[v] = parts[cluster[v]] == 1 ? clusters.point(cluster[v]) : Vec3(sums[v] / counts[v]);
  }
}

// Per vertex its number among those that are left.
std::vector<std::uint32_t> number_vertices(const HalfedgeMesh& mesh) {
  std::vector<std::uint32_t> number(mesh.vertex_slots(), no_sample);
  std::uint32_t alive = 0;
  for (std::uint32_t v = 0; v < number.size(); ++v)
    if (mesh.is_alive(v)) number[v] = alive++;
  return number;
}

// The anchors' net with the vertices that are left on its lines. `scan` has the faces of `mesh` as they were.
FeatureNet net_of_contracted(const Anchors& anchors, const SurfaceMesh& scan, const HalfedgeMesh& mesh,
                             const std::vector<std::uint32_t>& into, const std::vector<std::uint32_t>& number) {
  FeatureNet net = anchors.net;
  for (std::size_t l = 0; l < net.lines.size(); ++l) {
    net.lines[l].vertices.clear();
    for (std::size_t i = 0; i < anchors.vertices_of_line[l].size(); ++i) {
      const std::uint32_t v = anchors.vertices_of_line[l][i];
      if (into[v] == v) net.lines[l].vertices.push_back({number[v], static_cast<double>(i)});
    }
  }
  for (std::uint32_t f = 0; f < mesh.face_slots(); ++f)
    if (mesh.is_face_alive(f)) net.patch_of_face.push_back(anchors.patch_of_node[scan.triangles[f][0]]);
  return net;
}

}  // namespace

ExtractedLattice contract_clusters(const SurfaceMesh& scan, const Anchors& anchors, LatticeClusters& clusters) {
  std::vector<std::uint32_t> welded = anchors.welded;
  if (welded.empty()) {
    welded.resize(scan.vertices.size());
    std::iota(welded.begin(), welded.end(), 0U);
  }
  HalfedgeMesh mesh(anchors.empty() ? scan : welded_scan(scan, welded));
  FeatureChains chains(anchors, mesh.vertex_slots());
  std::vector<std::uint32_t> cluster(mesh.vertex_slots());
  for (std::uint32_t i = 0; i < welded.size(); ++i) cluster[welded[i]] = clusters.find(i);

  const std::vector<std::uint32_t> into = contract_edges(mesh, chains, cluster);
  place_vertices(mesh, chains, cluster, into, clusters);

  const std::vector<std::uint32_t> number = number_vertices(mesh);
  ExtractedLattice result;
  result.contracted = true;
  result.vertex_of_node.resize(welded.size());
  for (std::size_t i = 0; i < welded.size(); ++i) result.vertex_of_node[i] = number[into[welded[i]]];
  if (!anchors.empty()) result.net = net_of_contracted(anchors, scan, mesh, into, number);
  result.mesh = mesh.to_surface();
  return result;
}

}  // namespace scan2fea
