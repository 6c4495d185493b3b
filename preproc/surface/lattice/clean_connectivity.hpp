// Cleans the connectivity of a nearly regular triangle mesh: vertices of valence 6, the wanted number of triangles.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/vertex_constraint.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace scan2fea {

struct ConnectivityOptions {
  // Of flips and collapses that bring valences nearer to their ideal, 0 or more.
  int rounds = 2;
  // Then edges are collapsed or split, those first that suit the valences and the wanted edge lengths best, until the
  // mesh has this many triangles, or one less.
  std::optional<std::size_t> triangles;
  // Per vertex, the vertex of the surface before it was cut; empty where it was not.
  std::span<const std::uint32_t> welded = {};
};

struct ConnectivityResult {
  std::size_t flips = 0;
  std::size_t collapses = 0;
  std::size_t splits = 0;
  // Per vertex of the mesh before, the vertex that it is or was merged into; border vertices are merged into no other.
  std::vector<std::uint32_t> vertex_of_old;
};

// `edge_length` holds the wanted edge length per vertex and follows the vertices. A border vertex ideally has one
// triangle for each 60° of the angle between its border edges. Changes neither topology nor, beyond the placement of
// merged and new vertices at edge midpoints, the geometry; no step that turns a triangle by more than about 60° or
// makes a sliver is taken. Borders stay, vertex by vertex. Where the mesh is a surface cut along features
// (cut_surface.hpp), no edge is made that would be there twice once it is welded again.
// Precondition: an oriented manifold. Throws NotMeshable where it is not. Deterministic, serial; O(n log n), about 1 ms
// per 1,000 triangles.
ConnectivityResult improve_connectivity(SurfaceMesh& mesh, std::vector<double>& edge_length,
                                        const ConnectivityOptions& options = {});

}  // namespace scan2fea
