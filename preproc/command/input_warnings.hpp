// What a person should know about a scan before hours go into it.
#pragma once

#include "preproc/mesh/point_cloud.hpp"
#include "preproc/mesh/surface_mesh.hpp"

#include <optional>
#include <string>
#include <vector>

namespace scan2fea::command {

// Sentences without a full stop; none where nothing stands out. `unit`: one of --unit's.
std::vector<std::string> input_warnings(const SurfaceMesh& scan, const std::optional<std::string>& unit);
std::vector<std::string> input_warnings(const PointCloud& cloud, const std::optional<std::string>& unit);

}  // namespace scan2fea::command
