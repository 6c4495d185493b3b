#include "preproc/layers/layer_defects.hpp"

#include "preproc/mesh/numbers.hpp"
#include "quality/self_intersections.hpp"
#include "quality/tetrahedron_measures.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <utility>

namespace scan2fea {
namespace {

// All layers, and the triangle that each element lies behind.
TetMesh mesh_of_layers(const SurfaceMesh& outer, const LayeredTriangles& layered, const LayerColumns& columns,
                       std::vector<std::uint32_t>& of_triangle) {
  LayerElements elements = layer_elements(outer, layered, columns);
  of_triangle = std::move(elements.of_triangle);
  TetMesh mesh;
  mesh.tetrahedra = std::move(elements.tetrahedra);
  mesh.nodes = outer.vertices;
  mesh.nodes.insert(mesh.nodes.end(), columns.nodes.begin(), columns.nodes.end());
  return mesh;
}

double shortest_edge(const TetMesh& mesh, const Tetrahedron& t) {
  double shortest = infinity;
  for (const auto& [i, j] : tetrahedron_edges)
    shortest = std::min(
        shortest, (mesh.nodes[t[static_cast<std::size_t>(i)]] - mesh.nodes[t[static_cast<std::size_t>(j)]]).norm());
  return shortest;
}

// Elements of an upright wedge have a third of its area times its height.
void find_turned(const SurfaceMesh& surface, const TetMesh& layers, const std::vector<std::uint32_t>& of_triangle,
                 std::vector<bool>& bad) {
  constexpr double least = 0.1 / 3;
  for (std::size_t e = 0; e < layers.tetrahedra.size(); ++e) {
    const double area = area_vector(surface, surface.triangles[of_triangle[e]]).norm() / 2;
    if (volume_of(layers, e) < least * area * shortest_edge(layers, layers.tetrahedra[e])) bad[of_triangle[e]] = true;
  }
}

void find_squeezed(const SurfaceMesh& surface, const SurfaceMesh& inner, std::vector<bool>& bad) {
  constexpr double least = 0.25, most_turn_deg = 45;
  for (std::size_t f = 0; f < bad.size(); ++f) {
    const Triangle& t = surface.triangles[f];
    const auto smallest = [&](const SurfaceMesh& of) {
      return smallest_angle_deg(of.vertices[t[0]], of.vertices[t[1]], of.vertices[t[2]]);
    };
    const double turn_deg = angle_between(area_vector(surface, t), area_vector(inner, t)) * degrees;
    if (turn_deg > most_turn_deg || smallest(inner) < least * smallest(surface)) bad[f] = true;
  }
}

}  // namespace

std::vector<bool> find_high_columns(const SurfaceMesh& surface, const SurfaceMesh& outer, const SurfaceMesh& inner,
                                    const LayeredTriangles& layered, const LayerColumns& columns) {
  std::vector<bool> bad(surface.triangles.size(), false);
  std::vector<std::uint32_t> of_triangle;
  const TetMesh layers = mesh_of_layers(outer, layered, columns, of_triangle);
  find_turned(surface, layers, of_triangle, bad);
  find_squeezed(surface, inner, bad);
  if (std::ranges::find(bad, true) == bad.end())
    for (const FacePair& pair : find_self_intersections(inner)) bad[pair.face] = bad[pair.other] = true;
  return bad;
}

std::vector<std::uint32_t> find_flat_layers(const SurfaceMesh& outer, const LayeredTriangles& layered,
                                            const LayerColumns& columns, double least_deg) {
  std::vector<std::uint32_t> of_triangle, found;
  const TetMesh layers = mesh_of_layers(outer, layered, columns, of_triangle);
  for (std::size_t e = 0; e < layers.tetrahedra.size(); ++e) {
    if (measure_tetrahedron(layers, e).min_dihedral_deg >= least_deg) continue;
    const Triangle& t = outer.triangles[of_triangle[e]];
    found.insert(found.end(), t.begin(), t.end());
  }
  return found;
}

}  // namespace scan2fea
