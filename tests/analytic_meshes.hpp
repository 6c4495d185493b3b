// Surfaces whose volume, area and topology are known, for tests.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <array>
#include <functional>

namespace scan2fea::analytic {

// Axis-aligned box from the origin, each side split into squares of about `edge_length`, each square into two
// triangles.
SurfaceMesh box(const Vec3& size, double edge_length);

// A cube of 6 edges on the end of a fin 24 edges long, 8 wide and 0.625 thin: thick and thin in one part.
SurfaceMesh block_with_fin(double edge_length);

// A plate of near-equilateral triangles, thinner than its edges are long: rows of triangles over the faces, shifted by
// half a triangle from row to row and from one face to the other, one row along the sides. Vertices exactly on the
// edges; about 40 degrees at the least.
SurfaceMesh plate(const Vec3& size, double edge_length);

// Icosahedron subdivided `levels` times, vertices on the sphere: 20 * 4^levels triangles.
SurfaceMesh sphere(double radius, int levels);

// A torus about z with `around` x `across` quads, split into triangles.
SurfaceMesh torus(double major_radius, double minor_radius, int around, int across);

// A prism over a regular polygon of `around` corners about z, closed by fans: a cylinder where `around` is large. Its
// height is split into `along` rings.
SurfaceMesh cylinder(double radius, double height, int around, int along);

// A pipe about z with plane ends, from z = 0 on, of `around` quads around, and squares of about the same size.
SurfaceMesh pipe(double inner, double outer, double length, int around);

// What two equal balls share: caps that meet in a circular rim of radius 1, at an interior angle of `rim_angle_deg`;
// each cap of `rings` rings of `around` vertices.
SurfaceMesh lens(double rim_angle_deg, int around, int rings);

// An open rectangle in the plane z = 0, from the origin, split like a side of the box.
SurfaceMesh sheet(double width, double depth, double edge_length);

// A slab of `genus` square holes in a row, 1 thick, each square of side 1 and split into (1/edge_length)^2.
SurfaceMesh slab_with_holes(int genus, double edge_length);

// The faces between the voxels that are in and those that are not, each split into two triangles; `size`: of a voxel,
// the first from the origin on, `counts` along each axis.
SurfaceMesh voxels(const std::array<int, 3>& counts, const Vec3& size,
                   const std::function<bool(const Vec3& centre)>& is_in);

// A ball of so many voxels across, each 1 wide, in the middle of them.
SurfaceMesh voxel_ball(int across);

// Both surfaces in one mesh, vertices of `b` after those of `a`.
SurfaceMesh join(const SurfaceMesh& a, const SurfaceMesh& b);

// The same surface elsewhere.
SurfaceMesh moved(SurfaceMesh mesh, const Vec3& by);

// The same surface, inside out.
SurfaceMesh reversed(SurfaceMesh mesh);

// The same surface turned and moved, its vertices and triangles in another order, triangles beginning at another
// corner; this share of them turned round.
SurfaceMesh elsewhere(const SurfaceMesh& mesh, unsigned seed, double turned_triangles = 0);

// Vertices moved by Gaussian noise of standard deviation `sigma`; reproducible by seed.
SurfaceMesh noisy(SurfaceMesh mesh, double sigma, unsigned seed);

}  // namespace scan2fea::analytic
