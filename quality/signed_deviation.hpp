// How far each triangle, or node, of a surface lies from a reference, and on which side.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/mesh/tet_mesh.hpp"
#include "quality/triangle_tree.hpp"

#include <vector>

namespace scan2fea {

// Model units. Of a triangle the mean, by the rule of seven points (corners, middles of edges, its own middle) that is
// exact for polynomials of third degree: where chords lie inside of a round and their ends outside, it is about 0, as
// an engineer expects of a mesh that lies in its scan; how far single points lie is what measure_deviation says.
// Positive: the mesh lies outside of the reference, by the normals of the mesh, since those of a scan may be anything;
// where it encloses a volume, by which side is outside, since those of somebody else's mesh may be anything, too.
// O(n log n), parallel; the same for any number of threads.

// Per triangle of the mesh. Precondition: it has an area.
std::vector<double> signed_deviations(const SurfaceMesh& mesh, const TriangleTree& reference);

// Per outer boundary face, which of second order is curved.
std::vector<double> signed_deviations(const TetMesh& mesh, const TriangleTree& reference);

// Per node of the mesh its own distance, by the normals of the whole faces around it, since a curved face's at a single
// node may be anything; NaN for nodes that are not on the outer boundary. Beside sharp edges, where the nearest point
// of the reference lies sideways, the sign may be the other one.
std::vector<double> signed_deviations_of_nodes(const SurfaceMesh& mesh, const TriangleTree& reference);
std::vector<double> signed_deviations_of_nodes(const TetMesh& mesh, const TriangleTree& reference);

// Per triangle of the reference the mean of its corners' distances to the mesh, with the same meaning of the sign.
// `tree` is the mesh's.
std::vector<double> signed_deviations_of_reference(const SurfaceMesh& reference, const SurfaceMesh& mesh,
                                                   const TriangleTree& tree);

// Per triangle of the mesh the mean distance of the measured points for which it is the nearest, with the same meaning
// of the sign; NaN where there are none, which nobody has measured then. Or per outer boundary face.
std::vector<double> signed_deviations_from_points(const std::vector<Vec3>& points, const SurfaceMesh& mesh);
std::vector<double> signed_deviations_from_points(const std::vector<Vec3>& points, const TetMesh& mesh);

}  // namespace scan2fea
