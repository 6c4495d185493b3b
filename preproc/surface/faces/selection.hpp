// What a user means by "fixed" or "loaded": an expression that selects part of a scan.
//
//   FACE_3                          a face by its name (see find_faces.hpp), or a set by the name it has in the file
//   plane(z<0.5mm)                  faces of a kind, all of them or those that meet every condition in the brackets:
//   cylinder(z, r=5+-0.2, hole)     plane, cylinder, cone, sphere, torus, free
//   largest(cylinder)               of the faces that an expression selects, the one with the largest area
//   nearest(1, 2, 3)                the face nearest to a point
//   z<0.5mm                         what lies there: the surface is cut at the limit
//   box(0,0,0, 10,5,2)              two opposite corners
//   ball(1, 2, 3, 0.5)              centre and radius
//   normal(0,0,1; 15deg)            where the surface faces that way
//   A and not (B or C)
//
// Conditions: a direction (x, y, z, -x, ..., three numbers, or axis=...; of a plane its outward normal, of the others
// the axis either way; 5 degrees, or what follows after a semicolon), r or tube (radius; = with +- or ±, without 2 %;
// < and >), x, y, z (all of the face but a twentieth lies there), area, hole, boss. Lengths are in model units or
// have a unit of their own. Words may be in upper or lower case.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scan2fea {

// value <= limit or value >= limit.
struct Limit {
  enum class Of { x, y, z, radius, tube, area };
  Of of = Of::x;
  bool above = false;
  double value = 0;
};

struct Direction {
  Vec3 vector = Vec3::UnitZ();  // unit
  double within_deg = 5;
};

struct Selection {
  enum class Kind { name, shape, largest, nearest, half_space, box, ball, normal, both, either, inverse };
  Kind kind = Kind::name;
  std::string text;                 // as it was given; of a name or a shape, that word in upper or lower case
  std::vector<Limit> limits;        // of a shape; of a half-space the only one
  std::optional<Direction> facing;  // of a shape, and of `normal`
  std::optional<bool> hollow;       // of a shape
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  // of a box; `low` is the centre of a ball, the point of `nearest`
  double radius = 0;                             // of a ball
  std::vector<Selection> operands;               // of both, either, inverse, largest

  bool is_of_whole_faces() const;
};

struct NamedSelection {
  std::string name;
  Selection selection;
};

// "fixed=plane(z<0.5mm)". `unit`: of the model, or empty. Throws WrongUsage with what is wrong, and where: a name that
// solvers do not take or that is taken already (NALL, EALL, SALL, FILLED, ENRICHED), an unknown word, a unit where the
// model has none.
NamedSelection parse_selection(std::string_view text, std::string_view unit);

}  // namespace scan2fea
