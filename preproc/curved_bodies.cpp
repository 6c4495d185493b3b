#include "preproc/curved_bodies.hpp"

#include "preproc/surface/curved/keep_curved_volume.hpp"
#include "preproc/surface/simplification/surface_on_scan.hpp"

#include <algorithm>

namespace scan2fea {
namespace {

std::size_t edge_index(const CurvedSurface& surface, const FeatureEdge& edge) {
  return static_cast<std::size_t>(std::ranges::lower_bound(surface.edges, edge) - surface.edges.begin());
}

// Nodes of a surface whose vertices are these of another one, as nodes of that one.
std::vector<std::size_t> nodes_in(const CurvedSurface& all, const CurvedSurface& own,
                                  const std::vector<std::uint32_t>& of_all) {
  std::vector<std::size_t> nodes(of_all.begin(), of_all.end());
  for (const auto& [a, b] : own.edges)
    nodes.push_back(all.corners.vertices.size() + edge_index(all, feature_edge(of_all[a], of_all[b])));
  return nodes;
}

// Bends are those that were fitted; corners may have been moved since, for the volume.
void take_outside(const FittedCurves& outside, const std::vector<Vec3>& before, CurvedBodies& bodies,
                  std::vector<bool>& is_given) {
  CurvedSurface& all = bodies.surface;
  const CurvedSurface& own = outside.surface;
  std::vector<std::uint32_t> same(before.size());
  for (std::uint32_t v = 0; v < same.size(); ++v) {
    same[v] = v;
    all.corners.vertices[v] += own.corners.vertices[v] - before[v];
    is_given[v] = true;
  }
  const std::vector<std::size_t> nodes = nodes_in(all, own, same);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    bodies.directions[nodes[i]] = outside.directions[i];
    is_given[nodes[i]] = true;
  }
  for (std::size_t e = 0; e < own.edges.size(); ++e)
    all.node(nodes[same.size() + e]) = all.middle(edge_index(all, own.edges[e])) + own.mid[e] - own.middle(e);
}

void fit_sheet(const MadeSheet& sheet, CurvedBodies& bodies, std::vector<bool>& is_given, const Progress& progress) {
  CurvedSurface& all = bodies.surface;
  SurfaceMesh mesh{.vertices = {}, .triangles = sheet.triangles};
  for (const std::uint32_t v : sheet.vertices) mesh.vertices.push_back(all.corners.vertices[v]);
  CurvedSurface own(std::move(mesh));
  const std::vector<std::size_t> nodes = nodes_in(all, own, sheet.vertices);
  std::vector<bool> held(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    held[i] = is_given[nodes[i]] || (i < sheet.vertices.size() && sheet.on_border[i]);
    if (is_given[nodes[i]]) own.node(i) = all.node(nodes[i]);
  }
  const std::vector<Vec3> directions =
      fit_piece(own, held, sheet.on_scan->net, sheet.on_scan->scan->reference(), progress);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (held[i]) continue;
    all.node(nodes[i]) = own.node(i);
    bodies.directions[nodes[i]] = directions[i];
    is_given[nodes[i]] = true;
  }
}

}  // namespace

bool keep_volumes_of_bodies(const BodyComplex& made, const std::vector<Vec3>& directions, CurvedSurface& surface) {
  std::uint32_t bodies = 0;
  for (const Sides& sides : made.sides) {
    bodies = std::max(bodies, sides.behind + 1);
    if (sides.front != no_body) bodies = std::max(bodies, sides.front + 1);
  }
  std::vector<bool> is_settled(surface.nodes(), false);
  bool all_kept = true;
  // The last body first, as of the straight surfaces.
  for (std::uint32_t b = bodies; b-- > 0;) {
    std::vector<bool> is_between(surface.nodes(), false);
    for (std::size_t f = 0; f < made.sides.size(); ++f)
      if (made.sides[f].front == b || (made.sides[f].behind == b && made.sides[f].front != no_body))
        for (const std::size_t i : surface.nodes_of(f)) is_between[i] = true;
    const OwnVertices straight = surface_of_body(made, b);
    const std::vector<double> volumes = volumes_of_components(straight.mesh);
    CurvedSurface own(own_vertices(surface.corners.vertices, triangles_of_body(made, b)).mesh);
    const std::vector<std::size_t> nodes = nodes_in(surface, own, straight.of_all);
    for (std::size_t i = 0; i < nodes.size(); ++i) own.node(i) = surface.node(nodes[i]);
    bool is_kept = false;
    for (const bool between : {true, false}) {
      std::vector<Vec3> free(nodes.size(), Vec3::Zero());
      for (std::size_t i = 0; i < nodes.size(); ++i)
        if (is_between[nodes[i]] == between && !is_settled[nodes[i]]) free[i] = directions[nodes[i]];
      is_kept = keep_curved_volume(own, volumes, free);
    }
    all_kept = all_kept && is_kept;
    for (std::size_t i = 0; i < nodes.size(); ++i) surface.node(nodes[i]) = own.node(i);
    for (std::size_t i = 0; i < is_between.size(); ++i)
      if (is_between[i]) is_settled[i] = true;
  }
  return all_kept;
}

CurvedBodies fit_bodies(const BodyComplex& made, const FittedCurves& outside, const std::vector<Vec3>& outside_before,
                        std::span<const MadeSheet> sheets, const Progress& progress) {
  const CurvedSurface straight(made.mesh);
  CurvedBodies bodies{.surface = straight, .directions = std::vector<Vec3>(straight.nodes(), Vec3::Zero())};
  std::vector<bool> is_given(straight.nodes(), false);
  take_outside(outside, outside_before, bodies, is_given);
  for (const MadeSheet& sheet : sheets) fit_sheet(sheet, bodies, is_given, progress);
  const auto keep_volumes = [&](const std::vector<Vec3>& directions, CurvedSurface& shifted) {
    return keep_volumes_of_bodies(made, directions, shifted);
  };
  bodies.straight = settle(straight, keep_volumes, nullptr, bodies.surface, bodies.directions);
  return bodies;
}

}  // namespace scan2fea
