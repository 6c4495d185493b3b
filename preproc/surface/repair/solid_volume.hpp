// The volume of the solid that a scan shows, however its faces tell it.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/repair/repair_result.hpp"

#include <optional>

namespace scan2fea {

// Of the scan as the repair with its default options makes a solid of it, with all closed bodies that it drops: what a
// mesh made of the scan is to be compared with. The faces of an open or crossing scan, or of one with walls inside or
// doubled sheets, have no volume of their own, or another one. Nothing where repair makes no solid of it. Costs a
// repair of a copy.
std::optional<double> volume_of_solid(const SurfaceMesh& scan, const Progress& progress = {});

// The same, from what that repair made.
double volume_of_solid(const SurfaceMesh& repaired, const RepairResult& result);

}  // namespace scan2fea
