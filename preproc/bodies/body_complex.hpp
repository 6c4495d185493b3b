// Bodies that touch, as one set of triangles: where two of them meet they share the same ones.
#pragma once

#include "preproc/mesh/own_vertices.hpp"
#include "preproc/mesh/surface_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace scan2fea {

struct Body {
  std::string name;
  SurfaceMesh surface;  // closed, turned outwards, free of crossings
};

inline constexpr std::uint32_t no_body = std::numeric_limits<std::uint32_t>::max();

// The bodies on both sides of a triangle, by their numbers. Its normal points out of the one behind.
struct Sides {
  std::uint32_t behind = no_body;
  std::uint32_t front = no_body;
  bool operator==(const Sides&) const = default;
};

// Where two bodies touch.
struct Contact {
  std::uint32_t first = no_body, second = no_body;  // bodies, in their order
  std::size_t triangles = 0;                        // of the second, that gave way to those of the first
  double area = 0;                                  // of the first's surface
  double largest_gap = 0, largest_overlap = 0;      // that were closed, model units
  double tolerance = 0;                             // up to which they would have been
  Vec3 at = Vec3::Zero();                           // the place of the larger of them
};

// Where two bodies face one another without touching.
struct OpenGap {
  std::uint32_t first = no_body, second = no_body;
  double size = 0;       // where it is narrowest, model units
  double tolerance = 0;  // up to which it would have been closed
  Vec3 at = Vec3::Zero();
};

// Where two bodies have a line or a point in common but no area. They share nothing there.
struct Touch {
  std::uint32_t first = no_body, second = no_body;
  double length = 0;  // of the diagonal of its box; 0 of a point
  double moved = 0;   // how far the second, or else the first, was drawn back there
  Vec3 at = Vec3::Zero();
};

struct BodyComplex {
  SurfaceMesh mesh;
  std::vector<Sides> sides;  // per triangle
  std::vector<Contact> contacts;
  std::vector<OpenGap> gaps;
  std::vector<Touch> touches;
};

struct JoinOptions {
  // The distance of two surfaces, gap or overlap, up to which they touch; model units, above 0. Unset: as far as two
  // tessellations of one shape may be apart, see contact_tolerance.
  std::optional<double> tolerance;
};

// By no more of its volume may a body change where its contacts are closed.
inline constexpr double most_volume_change = 0.05;

// The first of two bodies gives the surface on which they meet. Bodies that do not touch stay as they are, wider gaps
// are told; one may lie within another's cavity. Those that touch along a line or at a point alone are drawn apart by
// about a millionth of the diagonal, and told. Throws NotMeshable with the place where bodies overlap by more than the
// tolerance or, where it was not given, face one another across a gap of up to ten times of it, where the border of a
// contact is not clear, and where a body's volume would change by more than the above. A tolerance that is advised was
// tried. O(n log n) and the product of the lengths of two borders that meet; an error costs several times as much.
BodyComplex join_bodies(std::span<const Body> bodies, const JoinOptions& options = {});

// The closed surface of one body, with its vertices as they are numbered in the complex, turned outwards.
std::vector<Triangle> triangles_of_body(const BodyComplex& complex, std::uint32_t body);

// The same with the vertices that it uses alone.
inline OwnVertices surface_of_body(const BodyComplex& complex, std::uint32_t body) {
  return own_vertices(complex.mesh.vertices, triangles_of_body(complex, body));
}

// How far two tessellations of one surface may be apart where these two surfaces face one another: by the sagittas of
// their triangles, and 0.00001 of the diagonal, which coordinates of six digits are apart.
double contact_tolerance(const SurfaceMesh& first, std::span<const std::uint32_t> of_first, const SurfaceMesh& second,
                         std::span<const std::uint32_t> of_second);

}  // namespace scan2fea
