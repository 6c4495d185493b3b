// A still picture of a surface, drawn without a graphics card: for print, and for readers without scripts.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "quality/report_page/colour_maps.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace scan2fea {

// In parallel projection.
struct PictureView {
  Vec3 towards;   // unit, from the eye to the model
  Vec3 up;        // any that is not along it
  Vec3 centre;    // in the middle of the picture
  double height;  // of what is seen, model units, above 0
  // What is nearer to the eye than this before the centre is left out, so that it hides nothing; model units.
  std::optional<double> nearest = {};
};

struct PictureOptions {
  std::uint32_t width = 640, height = 480;  // pixels
  bool edges = false;                       // of the triangles
  std::optional<Vec3> ring = {};            // a place to be ringed
};

// All of the mesh, from this direction, with a little room around.
PictureView view_of_all(const SurfaceMesh& mesh, const Vec3& towards, const Vec3& up);

// A PNG, on a transparent ground. `colours`: one per triangle. O(n + pixels).
std::string draw_picture(const SurfaceMesh& mesh, std::span<const Rgb> colours, const PictureView& view,
                         const PictureOptions& options = {});

}  // namespace scan2fea
