#include "preproc/surface/fit/feature_fit.hpp"

#include "preproc/surface/kernel/adjacency.hpp"

#include <algorithm>
#include <cstddef>

namespace scan2fea {

CutMesh::CutMesh(const SurfaceMesh& mesh, const FeatureNet& net)
    : cut_(cut_along(mesh, edges_of(net))),
      on_line_(vertices_on_lines(net, mesh.vertices.size())),
      copies_(mesh.vertices.size()),
      patch_(cut_.mesh.vertices.size()) {
  for (std::uint32_t c = 0; c < cut_.vertex_of_copy.size(); ++c) copies_[cut_.vertex_of_copy[c]].push_back(c);
  for (std::size_t f = 0; f < cut_.mesh.triangles.size(); ++f)
    for (const std::uint32_t c : cut_.mesh.triangles[f]) patch_[c] = net.patch_of_face[f];
}

ShapeFitOptions CutMesh::options_for(const ShapeFitOptions& options, const ReferenceSurface& scan) const {
  ShapeFitOptions cut = options;
  cut.constraints.assign(cut_.mesh.vertices.size(), VertexConstraint::free);
  for (std::size_t c = 0; c < cut.constraints.size(); ++c) {
    const std::uint32_t v = cut_.vertex_of_copy[c];
    if (on_line_[v] || (!options.constraints.empty() && options.constraints[v] == VertexConstraint::fixed))
      cut.constraints[c] = VertexConstraint::fixed;
  }
  if (cut.nearest_vertex_of_scan_vertex) choose_copies(*cut.nearest_vertex_of_scan_vertex, scan);
  return cut;
}

void CutMesh::choose_copies(std::vector<std::uint32_t>& nearest, const ReferenceSurface& scan) const {
  // A slit has both of its sides on one patch: there the normals tell.
  const std::vector<Vec3> normals = vertex_normals(cut_.mesh);
  const auto likeness = [&](std::size_t s, std::uint32_t copy) {
    return (patch_[copy] == scan.patch_of_vertex[s] ? 2 : 0) + normals[copy].dot(scan.vertex_normals[s]);
  };
  for (std::size_t s = 0; s < nearest.size(); ++s) {
    const std::vector<std::uint32_t>& copies = copies_[nearest[s]];
    nearest[s] = *std::max_element(copies.begin(), copies.end(),
                                   [&](std::uint32_t a, std::uint32_t b) { return likeness(s, a) < likeness(s, b); });
  }
}

void slide_all(Fitter& fitter, CutMesh& cut, FeatureNet& net, const VertexConstraints& constraints) {
  // The part of the way to a neighbour that a vertex slides at most: two that slide towards one another keep half of
  // it.
  constexpr double farthest_slide = 0.25;
  for (FeatureLine& line : net.lines) {
    const std::size_t n = line.vertices.size();
    for (std::size_t i = line.closed ? 0 : 1; i + (line.closed ? 0 : 1) < n; ++i) {
      VertexOnLine& at = line.vertices[i];
      if (!constraints.empty() && constraints[at.vertex] == VertexConstraint::fixed) continue;
      const auto distance_to = [&](const VertexOnLine& other) {
        return farthest_slide * (cut.mesh().vertices[other.vertex] - cut.mesh().vertices[at.vertex]).norm();
      };
      const VertexOnLine &before = line.vertices[(i + n - 1) % n], &behind = line.vertices[(i + 1) % n];
      const auto deviation = [&] {
        return std::max(chord_deviation(line, before.place, at.place), chord_deviation(line, at.place, behind.place));
      };
      const double place = at.place, allowed = std::max(net.tolerance, deviation());
      fitter.slide(line, at.place, cut.copies(at.vertex), distance_to(before), distance_to(behind));
      if (deviation() <= allowed) continue;
      at.place = place;
      fitter.put(cut.copies(at.vertex), line.point_at(place));
    }
  }
}

}  // namespace scan2fea
