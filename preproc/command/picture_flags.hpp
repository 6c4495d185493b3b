// How a picture looks at a mesh: flags of `picture`.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <CLI/App.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace scan2fea::command {

struct PictureSize {
  std::uint32_t width = 1280, height = 960;  // pixels, the legend included
};

// What the ends of the colour bar stand for.
struct ColourRange {
  double low, high;
};

struct CutFlag {
  Vec3 normal;                   // unit
  std::optional<double> offset;  // along it, model units; without it through the middle of the box
};

// From the mesh to the eye: "iso", "front", ... or "1,-2,0.5". Throws CLI::ValidationError.
Vec3 view_direction(const std::string& text);

void add_picture_flags(CLI::App& command, std::optional<ColourRange>& range, std::optional<CutFlag>& cut, Vec3& eye,
                       PictureSize& size);

}  // namespace scan2fea::command
