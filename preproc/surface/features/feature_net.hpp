// The feature curves of a scan, and the vertices of a surface that lie on them.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/vertex_constraint.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace scan2fea {

struct VertexOnLine {
  std::uint32_t vertex;  // of the surface
  double place;          // i + t: t of the way from the line's i-th point to the next
};

// A crease or a border between two corners, or a loop.
struct FeatureLine {
  std::vector<Vec3> points;            // of the scan; closed: the first is repeated at the end
  std::vector<VertexOnLine> vertices;  // of the surface, by place; closed: the first is not repeated
  bool closed = false;
  bool border = false;

  // Precondition: 0 <= place <= points.size() - 1.
  Vec3 point_at(double place) const {
    const auto i = std::min(static_cast<std::size_t>(place), points.size() - 2);
    const double t = place - static_cast<double>(i);
    return (1 - t) * points[i] + t * points[i + 1];
  }
};

// Empty for a surface without creases and borders.
struct FeatureNet {
  std::vector<FeatureLine> lines;
  double tolerance = 0;  // how far chords between vertices may be from the line, model units
  // Per face of the surface, the patch of the scan that it stands for: the lines part patches from one another.
  std::vector<std::uint32_t> patch_of_face;

  bool empty() const { return lines.empty(); }
};

// Unit, along the segment that the place is on.
Vec3 direction_at(const FeatureLine& line, double place);

// The place that is `step` (a length, either way) along the line from another. Ends at the ends of an open line.
double advanced(const FeatureLine& line, double place, double step);

// The largest distance of the line's points between two places to the chord between them; from > to: over the end of a
// closed line.
double chord_deviation(const FeatureLine& line, double from, double to);

// Half-way along the line from one place to another; from > to: over the end of a closed line.
double middle_place(const FeatureLine& line, double from, double to);

// An edge of the surface that stands for a piece of a line.
struct LineEdge {
  std::uint32_t from, to;  // vertices of the surface, in the line's direction
  double from_place, to_place;
  std::uint32_t line;

  FeatureEdge edge() const { return feature_edge(from, to); }
};

// All of them, sorted by edge().
std::vector<LineEdge> line_edges(const FeatureNet& net);

// The same without their places.
std::vector<FeatureEdge> edges_of(const FeatureNet& net);

// Per vertex of a surface of so many, whether it lies on a line.
std::vector<bool> vertices_on_lines(const FeatureNet& net, std::size_t vertices);

// The same as constraints that hold vertices on lines where they are; none for an empty net.
VertexConstraints held_lines(const FeatureNet& net, std::size_t vertices);

// The same for borders alone.
VertexConstraints held_borders(const FeatureNet& net, std::size_t vertices);

}  // namespace scan2fea
