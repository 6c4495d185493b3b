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

// Follows merges to the vertex that is left; makes all of them point there.
void resolve(std::vector<std::uint32_t>& into) {
  for (std::uint32_t i = 0; i < into.size(); ++i) {
    std::uint32_t end = i;
    while (into[end] != end) end = into[end];
    into[i] = end;
  }
}

}  // namespace

ExtractedLattice contract_clusters(const SurfaceMesh& scan, const Anchors& anchors, LatticeClusters& clusters) {
  std::vector<std::uint32_t> welded = anchors.welded;
  if (welded.empty()) {
    welded.resize(scan.vertices.size());
    std::iota(welded.begin(), welded.end(), 0U);
  }
  HalfedgeMesh mesh(anchors.empty() ? scan : welded_scan(scan, welded));
  const std::size_t vertices = mesh.vertex_slots();
  FeatureChains chains(anchors, vertices);
  std::vector<std::uint32_t> cluster(vertices);
  for (std::uint32_t i = 0; i < welded.size(); ++i) cluster[welded[i]] = clusters.find(i);

  std::vector<std::uint32_t> into(vertices);
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
  resolve(into);

  // A cluster that became one vertex lies at its lattice point, parts of others where their nodes were, and what is on
  // a feature stays on it.
  std::vector<std::uint32_t> parts(clusters.size(), 0);
  std::vector<Vec3> sums(vertices, Vec3::Zero());
  std::vector<double> counts(vertices, 0);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    sums[into[v]] += mesh.points[v];
    ++counts[into[v]];
    if (into[v] == v) ++parts[cluster[v]];
  }
  ExtractedLattice result;
  result.contracted = true;
  std::vector<std::uint32_t> number(vertices, no_sample);
  std::uint32_t alive = 0;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    if (!mesh.is_alive(v)) continue;
    number[v] = alive++;
    if (chains.is_on_line(v)) continue;
    mesh.points[v] = parts[cluster[v]] == 1 ? clusters.point(cluster[v]) : Vec3(sums[v] / counts[v]);
  }
  result.vertex_of_node.resize(welded.size());
  for (std::size_t i = 0; i < welded.size(); ++i) result.vertex_of_node[i] = number[into[welded[i]]];
  if (!anchors.empty()) {
    result.net = anchors.net;
    for (std::size_t l = 0; l < result.net.lines.size(); ++l) {
      result.net.lines[l].vertices.clear();
      for (std::size_t i = 0; i < anchors.vertices_of_line[l].size(); ++i) {
        const std::uint32_t v = anchors.vertices_of_line[l][i];
        if (into[v] == v) result.net.lines[l].vertices.push_back({number[v], static_cast<double>(i)});
      }
    }
    for (std::uint32_t f = 0; f < mesh.face_slots(); ++f)
      if (mesh.is_face_alive(f)) result.net.patch_of_face.push_back(anchors.patch_of_node[scan.triangles[f][0]]);
  }
  result.mesh = mesh.to_surface();
  return result;
}

}  // namespace scan2fea
