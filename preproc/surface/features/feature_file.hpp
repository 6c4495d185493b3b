// Feature edges as files: OBJ with `v` and `l` lines, which ParaView, MeshLab and Blender read and write.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace scan2fea {

// Straight pieces in space, of no mesh; see match_features.hpp.
struct FeatureLines {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 2>> segments;  // of points
};

// The places of edges of a mesh. Points are those that an edge uses, in the mesh's order.
FeatureLines lines_of(const SurfaceMesh& mesh, const std::vector<FeatureEdge>& edges);

// The text of such a file. Numbers round-trip.
std::string text_of(const FeatureLines& lines);

// Throws IoError; a file that stood there before is then untouched.
void write_feature_lines(const FeatureLines& lines, const std::filesystem::path& file);

// `l` lines of two points or more; faces and all else are passed over. A file without lines gives none: that is how to
// say that a scan has no features. Throws InvalidInput with file and line.
FeatureLines read_feature_lines(const std::filesystem::path& file);

}  // namespace scan2fea
