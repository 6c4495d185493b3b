// Bodies that touch, as one set of triangles: where two of them meet they share the same ones.
#pragma once

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

struct BodyComplex {
  SurfaceMesh mesh;
  std::vector<Sides> sides;  // per triangle
  std::vector<Contact> contacts;
};

struct JoinOptions {
  // The distance of two surfaces, gap or overlap, up to which they touch; model units, above 0. Unset: as far as two
  // tessellations of one shape may be apart, see contact_tolerance.
  std::optional<double> tolerance;
};

// The first of two bodies gives the surface on which they meet. Bodies that do not touch stay as they are; one may lie
// within another's cavity. Throws NotMeshable with the place where bodies overlap by more than the tolerance or, where
// it was not given, face one another across a gap of up to ten times of it, and where the border of a contact is not
// clear. O(n log n) and the product of the lengths of two borders that meet.
BodyComplex join_bodies(std::span<const Body> bodies, const JoinOptions& options = {});

// The closed surface of one body, with its vertices as they are numbered in the complex, turned outwards.
std::vector<Triangle> triangles_of_body(const BodyComplex& complex, std::uint32_t body);

// How far two tessellations of one surface may be apart where these two surfaces face one another: by the sagittas of
// their triangles, and 0.00001 of the diagonal, which coordinates of six digits are apart.
double contact_tolerance(const SurfaceMesh& first, std::span<const std::uint32_t> of_first, const SurfaceMesh& second,
                         std::span<const std::uint32_t> of_second);

}  // namespace scan2fea
