#include "preproc/command/input_warnings.hpp"

#include "export/units.hpp"
#include "preproc/mesh/coordinate_step.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh/stair_steps.hpp"

namespace scan2fea::command {
namespace {

std::string rounded(double value) {
  return error_text(value, 3);
}

void add_coarse_coordinates(const SurfaceMesh& scan, std::vector<std::string>& warnings) {
  const std::optional<CoordinateStep> step = visible_coordinate_step(scan);
  if (!step) return;
  const double largest = step->length.maxCoeff();
  const bool is_even = step->length.minCoeff() > 0.5 * largest;
  const std::string size = "steps of " + std::string(is_even ? "" : "up to ") + rounded(largest) +
                           " (mean edge: " + rounded(mean_edge_length(scan)) + ")";
  warnings.push_back(step->digits ? "the coordinates were written with " + std::to_string(*step->digits) +
                                        (*step->digits == 1 ? " digit and" : " digits and") + " have " + size +
                                        ": the surface is stepped; write more digits, or subtract an offset before"
                                  : "the coordinates are 32-bit floats, and so far from the origin they have " + size +
                                        ": the surface is stepped; subtract an offset before floats are written");
}

std::string describe(const StairSteps& steps) {
  if (steps.kind == StairSteps::Kind::slices) return "slices that are " + rounded(steps.largest()) + " high";
  return "faces of voxels of " + rounded(steps.size[0]) + " x " + rounded(steps.size[1]) + " x " +
         rounded(steps.size[2]);
}

void add_stairs(const StairSteps& steps, std::vector<std::string>& warnings) {
  const std::string step = rounded(steps.largest());
  const bool voxels = steps.kind == StairSteps::Kind::voxels;
  warnings.push_back(
      "the surface is made of " + describe(steps) +
      ": it has stairs where the part has slopes; smooth it where the image is at hand, or ask for no "
      "more than a step: " +
      (voxels ? "--deviation " + step + ", the default here, or more" : "--feature-angle off --deviation " + step));
}

void add_implausible_size(const std::vector<Vec3>& points, const std::string& unit,
                          std::vector<std::string>& warnings) {
  if (const auto doubt = implausible_size(bounding_box(points).diagonal(), unit)) warnings.push_back(*doubt);
}

}  // namespace

std::vector<std::string> input_warnings(const SurfaceMesh& scan, const std::optional<std::string>& unit) {
  std::vector<std::string> warnings;
  if (const std::optional<StairSteps> steps = find_stair_steps(scan))
    add_stairs(*steps, warnings);
  else
    add_coarse_coordinates(scan, warnings);
  if (unit) add_implausible_size(scan.vertices, *unit, warnings);
  return warnings;
}

std::vector<std::string> input_warnings(const PointCloud& cloud, const std::optional<std::string>& unit) {
  std::vector<std::string> warnings;
  if (unit) add_implausible_size(cloud.points, *unit, warnings);
  return warnings;
}

}  // namespace scan2fea::command
