// Local repair of folded and badly shaped triangles, and of sheets that cross.
#pragma once

#include "preproc/surface/fit/reference_surface.hpp"
#include "preproc/surface/kernel/vertex_constraint.hpp"
#include "preproc/surface/mending/defects.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

// 1 / eta, negative where the face opposes `normal`: 1 for an equilateral face, 0 for one without area.
double signed_quality(const SurfaceMesh& mesh, const Triangle& t, const Vec3& normal);

// Moves the vertices of `movable`, one after the other, to the candidate that most raises the worst signed quality of
// their star, as long as that helps (at most `sweeps` times over all). Candidates lie towards the centroid of the
// neighbours, both there and lowered onto the scan. `near`: see scan_vertices_of_faces.
void smooth_worst(SurfaceMesh& mesh, const ReferenceSurface& scan, const std::vector<std::uint32_t>& near,
                  const std::vector<bool>& movable, int sweeps);

// Flips edges between vertices of `around`, but for `kept` ones (sorted), where that raises the worse signed quality of
// the two faces, best first come; returns the number of flips. Faces keep their indices.
std::size_t flip_worst(SurfaceMesh& mesh, const ReferenceSurface& scan, const std::vector<std::uint32_t>& near,
                       const std::vector<bool>& around, const std::vector<FeatureEdge>& kept = {});

// Flips the longest edge of faces next to no area, as there are where a line of the part runs straight on over two of a
// face's sides, but for `kept` ones (sorted), where both faces then have area and the side of the one that had; returns
// the number of flips. The surface moves by no more than the caps' heights, a hundredth of an edge.
std::size_t flip_caps(SurfaceMesh& mesh, const std::vector<FeatureEdge>& kept);

// Pushes the faces of pairs that share no vertex apart, along the difference of their normals, to the sides on which
// the scan has them, until they clear or have moved by half a mean edge. Returns whether they all cleared.
bool push_apart(SurfaceMesh& mesh, const ReferenceSurface& scan, const std::vector<std::uint32_t>& near,
                const std::vector<FacePair>& crossings, const VertexConstraints& constraints);

}  // namespace scan2fea
