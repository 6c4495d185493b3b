// Several bodies, of files or of the groups of one.
#pragma once

#include "export/mesh_file.hpp"
#include "preproc/bodies/body_complex.hpp"
#include "preproc/mesh/named_sets.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace scan2fea::command {

// Names that every format takes, no two alike, of letters, digits and `_`; of the files' without folder and extension.
// What had to be changed is noted.
std::vector<std::string> body_names(const std::vector<std::filesystem::path>& files, Notes& changes);

// The same of sets: one body for each set of faces, where there are several, every triangle is in just one, and each of
// them is closed and faces outwards; none otherwise.
std::vector<Body> bodies_of_groups(const SurfaceMesh& surface, const std::vector<NamedSet>& sets, Notes& changes);

}  // namespace scan2fea::command
