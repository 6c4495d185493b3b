// A six-fold direction at each node: where the edges of an equilateral lattice are to run.
// Source: Knöppel et al., "Globally Optimal Direction Fields" (2013), for directions as powers of complex numbers;
// Jakob et al. (2015) for smoothing them over a hierarchy.
#pragma once

#include "preproc/surface/kernel/tangent_frame.hpp"
#include "preproc/surface/lattice/field_graph.hpp"

#include <vector>

namespace scan2fea {

struct OrientationOptions {
  int sweeps = 6;  // of Gauss-Seidel on each level, 1 or more
};

// Per node of the finest level, a unit complex number e^{i theta} in the TangentFrame of the node's normal; theta is
// one of six directions that are equivalent.
struct OrientationField {
  std::vector<Complex> directions;
};

// Makes e^{6 i theta} as smooth as it can be along the edges of the graph, coarse to fine. "Smooth" means: carried over
// by the smallest rotation between the two normals and by the turn that goes with a change of the edge length. A
// lattice whose edge length h varies is a conformal map, whose rotation and ln h are harmonic conjugates:
// grad theta = J grad ln h, J the quarter turn. Without that turn the lattice gets more irregular vertices.
// Along features the field follows them (GraphLevel::guide). Deterministic for any number of threads. Linear.
OrientationField compute_orientation_field(const FieldGraph& graph, const OrientationOptions& options = {});

// The gradient of ln h per node, in the node's TangentFrame, by least squares over its edges.
std::vector<Complex> log_length_gradient(const GraphLevel& level);

}  // namespace scan2fea
