#include "preproc/surface/repair/solid_volume.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/repair/repair.hpp"

namespace scan2fea {

std::optional<double> volume_of_solid(const SurfaceMesh& scan, const Progress& progress) {
  try {
    SurfaceMesh solid = scan;
    const RepairResult result = repair(solid, {}, progress);
    return volume_of_solid(solid, result);
  } catch (const NotMeshable&) {
    return std::nullopt;
  }
}

double volume_of_solid(const SurfaceMesh& repaired, const RepairResult& result) {
  double volume = enclosed_volume(repaired);
  for (const RepairChange& change : result.changes)
    if (change.kind == RepairKind::DroppedSpeck)
      volume += change.volume;
    else if (change.kind == RepairKind::FilledCavity)
      volume -= change.volume;
  return volume;
}

}  // namespace scan2fea
