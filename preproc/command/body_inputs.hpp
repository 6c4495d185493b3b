// Several bodies, of files or of the groups of one.
#pragma once

#include "preproc/bodies/body_complex.hpp"
#include "preproc/mesh/named_sets.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace scan2fea::command {

// Names that every format takes, no two alike: the files' without folder and extension, of letters, digits and `_`.
std::vector<std::string> body_names(std::vector<std::string> given);

// Of the files' names.
std::vector<std::string> body_names(const std::vector<std::filesystem::path>& files);

// One body for each set of faces, where there are several, every triangle is in just one, and each of them is closed
// and faces outwards; none otherwise.
std::vector<Body> bodies_of_groups(const SurfaceMesh& surface, const std::vector<NamedSet>& sets);

}  // namespace scan2fea::command
