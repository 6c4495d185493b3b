#include "preproc/surface/simplification/voxel_options.hpp"

#include <variant>

namespace scan2fea {

std::string adapt_to_voxels(const std::optional<StairSteps>& stairs, SimplifyOptions& options) {
  if (!stairs || stairs->kind != StairSteps::Kind::voxels) return {};
  std::string changes;
  if (!options.given_features && options.features.angle_deg) {
    options.features.angle_deg.reset();
    changes = "their edges are not kept as creases";
  }
  auto* aim = std::get_if<LargestDeviation>(&options.size);
  if (aim != nullptr && !aim->required && aim->distance < stairs->largest()) {
    aim->distance = stairs->largest();
    changes += std::string(changes.empty() ? "" : ", and ") + "no deviation below their size is aimed at";
  }
  return changes.empty() ? changes : "the scan is made of voxels: " + changes;
}

}  // namespace scan2fea
