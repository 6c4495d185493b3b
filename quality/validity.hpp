// What the connectivity of a triangle set says: closed, manifold, oriented, components, genus. Indices only: whether
// faces pass through one another is `find_self_intersections`, whether they have an area is `measure_triangles`.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstddef>
#include <optional>

namespace scan2fea {

// A surface of less volume over area^1.5 is flat. That is 0.094 for a ball and 3.5e-4 for a plate a thousandth as thick
// as wide; rounding in a flat surface of 32-bit floats leaves about 1e-8.
constexpr double least_volume_of_area = 1e-6;

struct SurfaceValidity {
  std::size_t degenerate_faces = 0;    // faces that name a vertex twice; the figures below leave them out
  std::size_t unused_vertices = 0;     // vertices of no face
  std::size_t boundary_edges = 0;      // edges of one face
  std::size_t non_manifold_edges = 0;  // edges of three faces or more
  std::size_t misoriented_edges = 0;   // edges of several faces that run through it more often one way than the other
  std::size_t non_manifold_vertices = 0;  // vertices whose faces, joined across edges, form more than one fan
  std::size_t components = 0;             // sets of faces joined across edges
  std::optional<int> genus;               // sum over the components; only of a closed manifold

  bool closed() const { return boundary_edges == 0; }
  bool oriented() const { return misoriented_edges == 0; }
  // What a half-edge structure holds as it is: edges, vertices and orientation are in order (the meaning of CGAL's
  // is_polygon_soup_a_polygon_mesh). It may have a boundary.
  bool manifold() const {
    return degenerate_faces == 0 && non_manifold_edges == 0 && non_manifold_vertices == 0 && oriented();
  }
  // The faces cancel along every edge, so that their signed volume does not depend on the origin. Weaker than closed
  // and manifold: two cubes that share an edge enclose a volume.
  bool encloses_volume() const { return closed() && oriented(); }
};

// Linear in vertices and faces but for a sort of each vertex's edges. Precondition: indices in range. The empty set has
// zero of everything and genus 0.
SurfaceValidity check_validity(const SurfaceMesh& mesh);

// The same as check_validity(mesh).encloses_volume(), for the price of reading the faces once: edges are not sorted but
// hashed, and those that cancel leave a sum of 0. Others do by a chance of 2^-64.
bool encloses_volume(const SurfaceMesh& mesh);

}  // namespace scan2fea
