// A still picture of a surface, drawn without a graphics card, an X server or a display: the same bytes everywhere.
//
// The pictures of the report and those of the command are drawn by this. Debian's VTK 9.1 cannot draw without an X
// server, and what OpenGL draws depends on its driver.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "quality/picture/colour_maps.hpp"
#include "quality/picture/raster.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace scan2fea {

// The points p with normal.dot(p) <= offset stay.
struct Cut {
  Vec3 normal;    // unit
  double offset;  // model units

  bool keeps(const Vec3& p) const { return normal.dot(p) <= offset; }
};

// In parallel projection.
struct PictureView {
  Vec3 towards;   // unit, from the eye to the model
  Vec3 up;        // any that is not along it
  Vec3 centre;    // in the middle of the picture
  double height;  // of what is seen, model units, above 0
  // What is nearer to the eye than this before the centre is left out, so that it hides nothing; model units.
  std::optional<double> nearest = {};
  std::optional<Cut> cut = {};  // what it takes away is left out, and backs of triangles are seen
};

struct PictureOptions {
  std::uint32_t width = 640, height = 480;  // pixels
  bool edges = false;                       // of the triangles
  // Per triangle whether the side across from each corner is an edge; all are where this is empty.
  std::span<const std::array<bool, 3>> sides = {};
  std::optional<Vec3> ring = {};  // a place to be ringed
};

// All of the mesh, from this direction, with a little room around. `aspect`: width over height of the picture.
PictureView view_of_all(const SurfaceMesh& mesh, const Vec3& towards, const Vec3& up, double aspect = 4.0 / 3);

// On a transparent ground. `colours`: one per triangle. O(n + pixels).
Raster draw_raster(const SurfaceMesh& mesh, std::span<const Rgb> colours, const PictureView& view,
                   const PictureOptions& options = {});

// The same as a PNG.
std::string draw_picture(const SurfaceMesh& mesh, std::span<const Rgb> colours, const PictureView& view,
                         const PictureOptions& options = {});

}  // namespace scan2fea
